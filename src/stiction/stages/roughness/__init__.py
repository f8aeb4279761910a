"""Stages of roughness: devices along the roughness of a surface, and sufficient roughnesses."""
