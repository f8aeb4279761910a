"""Surfaces measured along lines, by a stylus or in a section."""
