"""Full elastic contact of a rough strip, a second model (not in the paper)."""
