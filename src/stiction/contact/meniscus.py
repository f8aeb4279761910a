r"""Water condensed between perfectly wetting surfaces (Sec. III-A1, capillary forces).

ASSUME: the surface energy and the molar volume of water vary with temperature as measured, and are those of the paper
at its 300 K: a published correlation gives only their ratio to 300 K. The paper rounds both (72 mN/m, 18 cm³/mol; the
correlations give 71.7 and 18.08), and its numbers are to be reproduced.
"""

import numpy as np

from stiction.constants import GAS_CONSTANT, WATER_MOLAR_VOLUME, WATER_SURFACE_ENERGY

#: Temperature of the paper [K].
_REFERENCE = 300.0
#: Critical temperature of water [K]; IAPWS R1-76(2014).
_CRITICAL = 647.096
#: Density of water, Kell (1975), J. Chem. Eng. Data 20, 97: numerator and denominator, in powers of t [°C]; [kg m⁻³].
_MASS = (999.83952, 16.945176, -7.9870401e-3, -46.170461e-6, 105.56302e-9, -280.54253e-12)
_EXPANSION = (1.0, 16.879850e-3)


def tabulated_surface_tension(temperature: float) -> float:
    r"""Surface tension of water, IAPWS release R1-76(2014) [N m⁻¹]; temperature [K].

    .. math:: \gamma = B \tau^\mu (1 + b \tau), \quad \tau = 1 - T / T_c

    Examples
    --------
    >>> round(1e3 * tabulated_surface_tension(298.15), 2)  # mN/m
    71.97
    """
    tau = 1 - temperature / _CRITICAL
    return 0.2358 * tau**1.256 * (1 - 0.625 * tau)


def tabulated_density(temperature: float) -> float:
    """Density of air-free water at atmospheric pressure, Kell (1975), from 0 to 150 °C [kg m⁻³]; temperature [K].

    Examples
    --------
    >>> round(tabulated_density(298.15), 1)
    997.0
    """
    celsius = temperature - 273.15
    mass, expansion = (np.polynomial.polynomial.polyval(celsius, powers) for powers in (_MASS, _EXPANSION))
    return float(mass / expansion)


def surface_energy(temperature: float) -> float:
    """Liquid-vapour surface energy γ_LG of water; at 300 K exactly that of the paper [N m⁻¹]; temperature [K]."""
    return WATER_SURFACE_ENERGY * (tabulated_surface_tension(temperature) / tabulated_surface_tension(_REFERENCE))


def molar_volume(temperature: float) -> float:
    """Molar volume V_m of liquid water; at 300 K exactly that of the paper [m³ mol⁻¹]; temperature [K]."""
    return WATER_MOLAR_VOLUME * (tabulated_density(_REFERENCE) / tabulated_density(temperature))


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
    return GAS_CONSTANT * temperature * np.log(humidity) / molar_volume(temperature)


def kelvin_radius(humidity: float | np.ndarray, temperature: float) -> float | np.ndarray:
    """Mean radius of curvature of the meniscus, Eq. (9); negative [m]."""
    return surface_energy(temperature) / laplace_pressure(humidity, temperature)


def meniscus_height(humidity: float | np.ndarray, temperature: float) -> float | np.ndarray:
    """Widest gap bridged by water between perfectly wetting flats, h_C = -2 r_K [m]."""
    return -2 * kelvin_radius(humidity, temperature)
