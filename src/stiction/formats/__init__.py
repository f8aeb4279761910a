"""Formats of files with heights, in addition to the formats of the library for such files."""
