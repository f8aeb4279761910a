"""Stages of surfaces: heights, spectra and measured surfaces (Sec. II)."""
