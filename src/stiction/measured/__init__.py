"""Stages of measured surfaces: from the files of a microscope to heights and spectrum."""
