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


def meniscus_height(
    humidity: float | np.ndarray, temperature: float, contact_angles: tuple[float, float] = (0.0, 0.0)
) -> float | np.ndarray:
    r"""Widest gap bridged by water between two flats, :math:`h_C = |r_K| (\cos\theta_1 + \cos\theta_2)` [m].

    The pressure of the water depends on the humidity alone, so that the energy to separate flooded flats is
    :math:`|\Delta P| h_C = \gamma (\cos\theta_1 + \cos\theta_2)`. In the paper both solids
    are perfectly wetting, h_C = -2 r_K.

    Parameters
    ----------
    humidity, temperature
        As in `laplace_pressure`.
    contact_angles : tuple of 2 floats
        θ₁ and θ₂ of the two solids [rad].

    Raises
    ------
    ValueError
        If the cosines add up to zero or less, so that no water condenses.
    """
    wetting = np.cos(contact_angles[0]) + np.cos(contact_angles[1])
    if not wetting > 0:
        degrees = " and ".join(f"{np.degrees(angle):.3g}" for angle in contact_angles)
        raise ValueError(f"no water condenses between flats with contact angles of {degrees} degrees")
    return -wetting * kelvin_radius(humidity, temperature)
