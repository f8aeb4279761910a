"""SurfaceTopography, imported without its warning. Tests that import it from here are skipped where it is missing."""

import warnings

import pytest

with warnings.catch_warnings():
    warnings.simplefilter("ignore", ImportWarning)  # of NuMPI, without mpi4py
    SurfaceTopography = pytest.importorskip("SurfaceTopography")
