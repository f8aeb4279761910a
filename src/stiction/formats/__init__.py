"""Formats of files with heights that the library for such files does not read."""
