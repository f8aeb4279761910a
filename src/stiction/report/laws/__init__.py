"""Figures of force laws (Sec. III)."""
