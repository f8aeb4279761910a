"""Stages of roughness: devices over the roughness of a surface, and which roughness suffices."""
