"""Polynomial chaos model of the force laws (Sec. III-B2, App. B)."""
