"""Command ``stiction``: start Snakemake, show the progress of a run, and say at the end where to look."""
