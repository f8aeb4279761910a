"""From surfaces to a safe design: beams, bridges and stoppers that must come free, and what to measure better."""
