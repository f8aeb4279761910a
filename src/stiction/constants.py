r"""Physical constants in SI units, each with unit and source. None is a tuning parameter.

ASSUME: the surface energy and the molar volume of water vary with temperature as measured, and are those of the paper
at its 300 K: a published correlation gives only their ratio to 300 K. The paper rounds both (72 mN/m, 18 cm³/mol; the
correlations give 71.7 and 18.08), and its numbers are to be reproduced.
"""

from collections.abc import Sequence

#: Molar gas constant [J mol⁻¹ K⁻¹], exact; SI of 2019.
GAS_CONSTANT = 8.31446261815324

#: Temperature of the paper [K]; below Eq. (8).
REFERENCE_TEMPERATURE = 300.0
#: Molar volume of liquid water, 300 K [m³ mol⁻¹]; paper, below Eq. (8).
WATER_MOLAR_VOLUME = 1.8e-5
#: Liquid-vapour surface energy γ_LG of water, 300 K [N m⁻¹]; paper, below Eq. (8).
WATER_SURFACE_ENERGY = 0.072
#: Diameter of a water molecule [m]; distance of neighbours in liquid water, X-ray diffraction (Narten and Levy, 1971).
WATER_MOLECULE = 2.8e-10

#: Hamaker constants of polysilicon through a medium [J]; paper, below Eq. (10).
HAMAKER_CONSTANT = {"water": 9.75e-20, "dry": 18.65e-20}
#: Distance at which the potential between two molecules is zero, r₀ [m]; paper, below Eq. (10).
MOLECULAR_DISTANCE = 2.09e-10

#: Young's modulus E of polysilicon [Pa]; paper, Table III.
YOUNG_MODULUS = 164e9
#: Poisson's ratio ν of polysilicon [-]. ASSUME: the paper gives none.
POISSON_RATIO = 0.23
#: Hardness σ_H of (poly)silicon [Pa]; paper, App. A.
HARDNESS = 12.8e9

#: Density of (poly)silicon [kg m⁻³]; crystal at 300 K, CRC Handbook of Chemistry and Physics.
DENSITY = 2330.0
#: Surface energies of liquids in which beams are released, against their vapour [N m⁻¹]. Water as above, isopropanol at
#: 293 K (Vázquez, Alvarez and Navaza, J. Chem. Eng. Data 40, 611, 1995).
LIQUIDS = {"water": WATER_SURFACE_ENERGY, "isopropanol": 0.0217}
#: Permittivity of vacuum ε₀ [F m⁻¹]; CODATA 2018.
VACUUM_PERMITTIVITY = 8.8541878128e-12
#: Standard acceleration of free fall g [m s⁻²], exact.
FREE_FALL = 9.80665

#: 0 °C [K], exact; SI.
ZERO_CELSIUS = 273.15
#: Critical temperature of water [K]; IAPWS R1-76(2014).
CRITICAL = 647.096
#: Density of water, Kell (1975), J. Chem. Eng. Data 20, 97: numerator and denominator, in powers of t [°C]; [kg m⁻³].
_MASS = (999.83952, 16.945176, -7.9870401e-3, -46.170461e-6, 105.56302e-9, -280.54253e-12)
_EXPANSION = (1.0, 16.879850e-3)


def tabulated_surface_tension(temperature: float) -> float:
    r"""Surface tension of water, IAPWS release R1-76(2014) [N m⁻¹]. Temperature [K].

    .. math:: \gamma = B \tau^\mu (1 + b \tau), \quad \tau = 1 - T / T_c

    Examples
    --------
    >>> round(1e3 * tabulated_surface_tension(298.15), 2)  # mN/m
    71.97
    """
    tau = 1 - temperature / CRITICAL
    return 0.2358 * tau**1.256 * (1 - 0.625 * tau)


def tabulated_density(temperature: float) -> float:
    """Density of air-free water at atmospheric pressure, Kell (1975), from 0 to 150 °C [kg m⁻³]. Temperature [K].

    Examples
    --------
    >>> round(tabulated_density(298.15), 1)
    997.0
    """
    celsius = temperature - ZERO_CELSIUS
    return _polynomial(_MASS, celsius) / _polynomial(_EXPANSION, celsius)


def _polynomial(factors: Sequence[float], x: float) -> float:
    """Sum of factors of increasing powers, by Horner's rule."""
    total = factors[-1]
    for factor in factors[-2::-1]:
        total = factor + total * x
    return total


def surface_energy(temperature: float) -> float:
    """Liquid-vapour surface energy γ_LG of water, at 300 K exactly the paper's [N m⁻¹]. Temperature [K]."""
    of_paper = tabulated_surface_tension(REFERENCE_TEMPERATURE)
    return WATER_SURFACE_ENERGY * (tabulated_surface_tension(temperature) / of_paper)


def molar_volume(temperature: float) -> float:
    """Molar volume V_m of liquid water, at 300 K exactly the paper's [m³ mol⁻¹]. Temperature [K]."""
    return WATER_MOLAR_VOLUME * (tabulated_density(REFERENCE_TEMPERATURE) / tabulated_density(temperature))
