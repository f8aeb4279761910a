"""Table and figure of the uncertainty of devices, and of stoppers."""
