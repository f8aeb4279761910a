"""Estimates at once of the length to build, learnt from contacts of drawn surfaces."""
