"""Drawings of devices, of their places of adhesion, and of the method, as SVG."""
