"""Stages of test beams: their evidence about a device, and the validity of the linear update."""
