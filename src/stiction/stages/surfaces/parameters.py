"""Spectrum of a surface in a dataset, as parameters of Eq. (7) or as a table, and conditions on its use.

Published, identified and measured spectra share it.
"""

from collections.abc import Mapping

import xarray as xr

from stiction.config.units import from_si
from stiction.surface.spectrum import CutoffSelfAffine, Spectrum, TabulatedSpectrum, correlation_length

#: Parameters of Eq. (7).
_PARAMETERS = ("plateau", "floor", "corner", "cutoff")


def variables(spectrum: Spectrum) -> xr.Dataset:
    """Dataset of the four parameters of Eq. (7), or of a table and its cut-off."""
    if isinstance(spectrum, CutoffSelfAffine):
        return xr.Dataset({name: ((), getattr(spectrum, name)) for name in _PARAMETERS})
    return xr.Dataset(
        {
            "table_wavenumber": ("node", spectrum.wavenumber),
            "table_density": ("node", spectrum.density),
            "cutoff": ((), spectrum.cutoff),
        }
    )


def spectrum_of(dataset: xr.Dataset) -> Spectrum:
    """Spectrum of Eq. (7) from the dataset of stage identification, or as tabulated from stage spectrum."""
    if "node" in dataset.dims:
        return TabulatedSpectrum(dataset.table_wavenumber.values, dataset.table_density.values, float(dataset.cutoff))
    return CutoffSelfAffine(**{name: float(dataset[name]) for name in _PARAMETERS})


def refuse_long_correlation(surface: str, spectrum: Spectrum, lengths: Mapping[str, float]) -> None:
    """Raise a ValueError if the heights are correlated over any of the lengths, by key of the configuration [m].

    The same condition as for published spectra, see `stiction.config.relations.lengths_exceed_the_correlation`.
    """
    bound = correlation_length(spectrum)
    for key, length in lengths.items():
        if length <= bound:
            raise ValueError(
                f"{key} is {from_si(length, 'um'):.4g}, must be above the correlation length of surface {surface}, "
                f"{from_si(bound, 'um'):.3g} µm for the spectrum identified from its summits"
            )


def misfits(identification: xr.Dataset) -> dict[str, tuple[float, float]]:
    """Radius and density of the summits of the identified spectrum relative to the measured ones.

    Returns
    -------
    dict
        ``radius`` and ``density``: the relative deviation and its standard error [%].
    """
    by_quantity = {}
    for word, name in (("radius", "mean_radius"), ("density", "summit_density")):
        value, error, target = (float(identification[key]) for key in (name, f"{name}_error", f"target_{name}"))
        by_quantity[word] = 100 * (value / target - 1), 100 * error / target
    return by_quantity
