"""Stage of the answer about a device, from the datasets of all others."""
