"""Stages of a device along an axis: the roughness of a surface, or the variable of a process."""
