"""Table and figure of the uncertainty of devices; those of stoppers."""
