"""Conditions of the life of devices, and the airs that stand for them."""
