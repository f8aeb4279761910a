"""Force laws of the samples with labels, for users."""

import numpy as np
import xarray as xr

from stiction.contact.forcelaw import admissible, coefficients
from stiction.stages.laws.forces import vectors

#: Coefficients of a force law: name, unit and meaning.
_COEFFICIENTS = {
    "f_max": ("Pa", "largest attraction"),
    "d_max": ("m", "distance of the largest attraction"),
    "a_left": ("m-1", "steepness below this distance"),
    "a_right": ("m-1", "steepness above this distance"),
}


def laws(forces: xr.Dataset) -> xr.Dataset:
    """Coefficients of Eq. (12) of all lawful samples, from the dataset of stage forces.

    The coordinate ``sample`` is the number of the sample. With these columns in this order, `stiction.law_pressure` and
    `stiction.law_energy` evaluate the laws.
    """
    sampled, limit = vectors(forces)
    lawful = np.flatnonzero(admissible(sampled, limit))
    columns = coefficients(sampled[lawful], limit).T
    named = zip(_COEFFICIENTS.items(), columns, strict=True)
    return xr.Dataset(
        {name: ("strip", column, {"units": unit, "long_name": words}) for (name, (unit, words)), column in named},
        {"strip": lawful},
    )
