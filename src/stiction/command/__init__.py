"""The command ``stiction``: it starts Snakemake, shows how far a run is, and says at the end where to look."""
