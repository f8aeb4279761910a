"""CSV files that a configuration names."""
