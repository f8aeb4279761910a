"""The four parameters of Eq. (7) as variables of a dataset; stages identification and spectrum share them.

A separate module, so that a change of the identification does not rerun published spectra.
"""

import xarray as xr

from stiction.surface.spectrum import CutoffSelfAffine

_UNITS = {"plateau": "m4", "floor": "m4", "corner": "rad m-1", "cutoff": "rad m-1"}


def variables(spectrum: CutoffSelfAffine) -> xr.Dataset:
    """Dataset of the four parameters."""
    return xr.Dataset({name: ((), getattr(spectrum, name), {"units": unit}) for name, unit in _UNITS.items()})


def spectrum_of(dataset: xr.Dataset) -> CutoffSelfAffine:
    """Eq. (7) from the dataset of stage identification or spectrum."""
    return CutoffSelfAffine(**{name: float(dataset[name]) for name in _UNITS})
