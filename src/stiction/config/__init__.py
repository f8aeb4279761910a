"""Configuration: files, schema, checks, units, and the settings of every job."""
