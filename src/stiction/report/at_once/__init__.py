"""Estimates at once beside the lengths of a run, as table and section of a page."""
