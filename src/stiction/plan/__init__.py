"""Jobs of a configuration: the declarations of all stages, and the plan of their jobs."""
