"""Contacts of a pair with one thing changed: a table, and a module for the computation of each change."""
