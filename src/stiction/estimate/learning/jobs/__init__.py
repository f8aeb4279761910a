"""Points of the estimate as jobs of a workflow of their own."""
