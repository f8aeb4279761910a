"""Stages of test beams: what they say about a device, and whether the linear update holds."""
