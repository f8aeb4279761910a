"""Safe lengths of a beam as the answers need them: the least, and its standard error."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.inputs import OfBeam


def length_of(lengths: Mapping[float, xr.Dataset], of: OfBeam) -> float:
    """Length of a beam for voltage and shock [m]: the given one, or its least safe length."""
    return of.length or min(least_safe(dataset, chosen_share(dataset))[0] for dataset in lengths.values())


def least_safe(dataset: xr.Dataset, share: float) -> tuple[float, float, str]:
    """Least safe length of all end states [m], the standard error of its estimate, and its basis."""
    one = dataset.sel(share=share)
    one = one.isel(shape=int(one.safe_length.argmin("shape")))
    return *length_and_error(one), str(one.basis.values)


def length_and_error(one: xr.Dataset) -> tuple[float, float]:
    """Safe length of one end state [m], and the standard error of its estimate; NaN if none is known."""
    errors = [float(one[name]) for name in ("beams_error", "surfaces_error")]
    return float(one.safe_length), float(np.sqrt(np.nansum(np.square(errors)))) or np.nan
