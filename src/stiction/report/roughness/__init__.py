"""Table and figures of roughness."""
