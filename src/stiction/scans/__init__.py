"""Measured surfaces: files of microscopes, levelling, moments and spectrum with their errors, fitness of the model."""
