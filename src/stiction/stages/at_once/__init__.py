"""Estimates at once beside the lengths of a run, as data."""
