"""One module per dataset: settings, compute, layout, readers, declaration. Folders follow the paper."""
