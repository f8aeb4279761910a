"""Table and figures of processes."""
