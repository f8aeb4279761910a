"""Drawings of devices, of what holds them, and of the method, as SVG."""
