"""Safe design from surfaces: beams, bridges and stoppers, and advice on measurements."""
