"""Limits of results in words, and pages of them."""
