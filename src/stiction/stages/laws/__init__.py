"""Stages of force laws: force curves, their chaos model, and studies of both (Sec. III-B, Apps. A, B)."""
