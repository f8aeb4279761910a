"""Closed forms of the life of a device, beside what the estimate has learnt."""
