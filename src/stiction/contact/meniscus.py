"""Water condensed between perfectly wetting surfaces (Sec. III-A1, capillary forces)."""

import numpy as np

from stiction.constants import GAS_CONSTANT, WATER_MOLAR_VOLUME, WATER_SURFACE_ENERGY


def laplace_pressure(humidity: float | np.ndarray, temperature: float) -> float | np.ndarray:
    r"""Pressure of condensed water relative to the vapour, Eq. (8).

    .. math:: \Delta P = \mathcal{R} T \ln \mathrm{RH} \, / \, V_m

    Parameters
    ----------
    humidity : float or array, any shape
        Relative humidity RH, in (0, 1) [-].
    temperature : float
        Absolute temperature T [K].

    Returns
    -------
    float or array, shape of ``humidity``
        Negative: the meniscus pulls the surfaces together [Pa].

    Raises
    ------
    ValueError
        If RH is not in (0, 1); at RH = 1 the meniscus grows without bound.

    Examples
    --------
    >>> round(float(laplace_pressure(0.65, 300.0)) / 1e6, 1)  # MPa
    -59.7
    """
    humidity = np.asarray(humidity, float)
    if not np.all((humidity > 0) & (humidity < 1)):
        raise ValueError(f"relative humidity must be in (0, 1), got {humidity}")
    return GAS_CONSTANT * temperature * np.log(humidity) / WATER_MOLAR_VOLUME


def kelvin_radius(humidity: float | np.ndarray, temperature: float) -> float | np.ndarray:
    """Mean radius of curvature of the meniscus, Eq. (9); negative [m]."""
    return WATER_SURFACE_ENERGY / laplace_pressure(humidity, temperature)


def meniscus_height(humidity: float | np.ndarray, temperature: float) -> float | np.ndarray:
    """Widest gap bridged by water between perfectly wetting flats, h_C = -2 r_K [m]."""
    return -2 * kelvin_radius(humidity, temperature)
