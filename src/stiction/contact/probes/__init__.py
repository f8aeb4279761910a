"""Contact under a probe: its shape, and two surfaces below it."""
