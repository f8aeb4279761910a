"""One module per dataset of the main line: compute, layout, reader (Secs. II to IV)."""
