"""Descriptions of surfaces in a configuration."""
