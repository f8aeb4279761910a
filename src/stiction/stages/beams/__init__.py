"""Stages of beams: their release, under variants and on other meshes as well (Secs. III-C, IV, App. C)."""
