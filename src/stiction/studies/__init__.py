"""One module per dataset of the studies: compute, layout, reader (Figs. 4, 5, 13 and 15, App. A–C)."""
