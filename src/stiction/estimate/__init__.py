"""Estimates at once of the length or force to build, learnt from contacts of drawn surfaces."""
