"""Texts with tables of numbers, as people and programs write them."""
