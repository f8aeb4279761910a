r"""Water condensed between two surfaces (Sec. III-A1, capillary forces). The paper's wet perfectly."""

from dataclasses import dataclass

import numpy as np

from stiction.constants import CRITICAL, GAS_CONSTANT, WATER_MOLECULE, molar_volume, surface_energy
from stiction.contact.air import MOLECULES, ROUNDING, is_humid, is_possible

#: ASSUME: fewest molecules across a meniscus. Water that is thinner bridges no gap.
BRIDGE = 1
#: ASSUME: largest tension of films that are no liquid [Pa], above the 140 MPa that water in quartz bore (Zheng et al.,
#: Science 254, 829, 1991). Films of three molecules have less from 0 °C on.
STRENGTH = 180e6
#: Critical pressure of water [Pa], factors and powers of its vapour pressure; W. Wagner and A. Pruss, J. Phys. Chem.
#: Ref. Data 22, 783 (1993).
_CRITICAL_PRESSURE = 22.064e6
_VAPOUR = np.array([-7.85951783, 1.84408259, -11.7866497, 22.6807411, -15.9618719, 1.80122502])
_POWERS = np.array([1, 1.5, 3, 3.5, 4, 7.5])


@dataclass(frozen=True)
class Isotherm:
    r"""Film adsorbed on each of two equal solids, of a thickness t measured at some humidities.

    ASSUME: t is linear in the humidity between these, 0 in dry air, and beyond the wettest as there, where films grow
    without limit: heights in wetter air are too small, which warns. In drier air the heights miss less. If films of van
    der Waals forces go on from the wettest air, t at p, it is t p over the tension there.
    """

    humidities: tuple[float, ...]  #: increasing [-]
    thickness: tuple[float, ...]  #: [m]

    def height(self, humidity: float) -> float:
        r"""Height that both films add to water between the solids [m], see `stiction.contact.environment`.

        With the tension :math:`p \propto \ln(1 / \mathrm{RH})` it is

        .. math:: \frac{1}{p} \int_0^p 2 t \, dp' = \frac{2}{\ln(1 / \mathrm{RH})} \int_\mathrm{RH}^1 t \, \frac{dx}{x}

        Examples
        --------
        >>> round(1e9 * Isotherm((0.3,), (0.5e-9,)).height(0.6), 12)  # layers of a fixed thickness
        1.0
        """
        wetter = [each for each in self.humidities if each > humidity]
        x = np.array([humidity, *wetter, 1.0])
        t = np.interp(x, (0.0, *self.humidities), (0.0, *self.thickness))
        slope = np.diff(t) / np.diff(x)
        segments = (t[:-1] - slope * x[:-1]) * np.log(x[1:] / x[:-1]) + np.diff(t)
        return float(2 * segments.sum() / -np.log(humidity))


def vapour_pressure(temperature: float) -> float:
    r"""Saturation pressure of the vapour over water, Wagner and Pruss (1993) [Pa]. Temperature [K].

    .. math:: \ln(p / p_c) = (T_c / T) \sum_k a_k \tau^{n_k}, \quad \tau = 1 - T / T_c

    Below 0 °C it is that over supercooled water, by which dew points are defined.

    Examples
    --------
    >>> round(vapour_pressure(293.15))
    2339
    """
    tau = 1 - temperature / CRITICAL
    return float(_CRITICAL_PRESSURE * np.exp(CRITICAL / temperature * (_VAPOUR @ tau**_POWERS)))


def humidity_at(temperature: float, dew_point: float) -> float:
    """Relative humidity of air at a temperature from its dew point [-]. Both in K. At least 1 where water condenses."""
    return vapour_pressure(dew_point) / vapour_pressure(temperature)


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
    if not np.all(is_humid(humidity) & (humidity < 1)):
        raise ValueError(f"relative humidity must be in (0, 1), got {humidity}")
    return GAS_CONSTANT * temperature * np.log(humidity) / molar_volume(temperature)


def kelvin_radius(humidity: float | np.ndarray, temperature: float) -> float | np.ndarray:
    """Mean radius of curvature of the meniscus, Eq. (9), negative [m]."""
    return surface_energy(temperature) / laplace_pressure(humidity, temperature)


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
    return -_wetting(contact_angles) * kelvin_radius(humidity, temperature)


def least_humidity(
    temperature: float, contact_angles: tuple[float, float] = (0.0, 0.0), molecules: int = MOLECULES
) -> float:
    r"""Humidity of a film n molecules thick between two flats [-]. Below ``MOLECULES``, it is no liquid.

    .. math:: \mathrm{RH} = \exp \Bigl( -\frac{\gamma V_m (\cos\theta_1 + \cos\theta_2)}
        {\mathcal{R} T \, n \, d_{H_2 O}} \Bigr)

    Parameters as in `meniscus_height`, which raises an error where no water condenses.

    Examples
    --------
    >>> round(least_humidity(300.0), 3)
    0.29
    """
    height = float(meniscus_height(np.exp(-1), temperature, contact_angles))  # it is inverse to -ln RH
    return float(np.exp(-height / (molecules * WATER_MOLECULE)))


#: Why films of fewer molecules are refused, and what to write.
_TOO_THIN = {
    MOLECULES: "which are no liquid; only the humidities of a device can be lower: leave its pair out of run.pairs",
    BRIDGE: "which bridges no gap; write dry",
}


def dry_air(
    humidity: float, temperature: float, contact_angles: tuple[float, float] = (0.0, 0.0), molecules: int = MOLECULES
) -> str | None:
    """Refusal of a humidity below the `least_humidity`, as the end of a sentence, otherwise ``None``."""
    least = least_humidity(temperature, contact_angles, molecules)
    if humidity >= least:
        return None
    degrees = " and ".join(f"{np.degrees(angle):.3g}" for angle in contact_angles)
    number = f"{molecules} molecule{'s' * (molecules > 1)}"
    return (
        f"must be at least {np.ceil(1e4 * least) / 1e4:.4g}: in drier air, at {temperature:g} K and contact angles of "
        f"{degrees} degrees, the film between the surfaces is thinner than {number}, "
        f"{1e9 * molecules * WATER_MOLECULE:.2g} nm, {_TOO_THIN[molecules]}"
    )


def require_humidity(humidity: float) -> None:
    """Refuse a relative humidity impossible in air [-]."""
    if not is_possible(humidity):
        raise ValueError(f"relative humidity must be 0, in dry air, or above 0 and below 1, got {humidity}")


def film(
    humidity: float, temperature: float, contact_angles: tuple[float, float] = (0.0, 0.0), fewest: int = BRIDGE
) -> tuple[float, float]:
    """Height h_C [m] and tension -ΔP [Pa] of the water at one humidity, see `meniscus_height`.

    Both are zero in dry air, whose humidity is 0, and at any humidity between surfaces that are not `is_wetted`. Films
    below ``MOLECULES`` count as a liquid with at most the tension `STRENGTH` and the same work between flats; what
    bounds them is in `stiction.config.mission.airs`.

    Raises
    ------
    ValueError
        If no air has this humidity, or if it is not dry, and too dry for a film of the ``fewest`` molecules.
    """
    require_humidity(humidity)
    if not (is_humid(humidity) and is_wetted(contact_angles)):
        return 0.0, 0.0
    if refusal := dry_air(humidity, temperature, contact_angles, fewest):
        raise ValueError(f"a relative humidity of {humidity:g} {refusal}")
    height = float(meniscus_height(humidity, temperature, contact_angles))
    tension = -float(laplace_pressure(humidity, temperature))
    work, thinnest = height * tension, MOLECULES * WATER_MOLECULE
    if height >= thinnest or tension <= (most := max(STRENGTH, work / thinnest)):
        return height, tension
    return work / most, most


def flooded_energy(temperature: float, contact_angles: tuple[float, float] = (0.0, 0.0)) -> float:
    """Adhesion energy of flats in saturated air, γ (cos θ₁ + cos θ₂) [J m⁻²]. Temperature [K], angles [rad].

    It is tension times height of the water at any humidity, and the limit of wet rough surfaces.
    """
    return float(surface_energy(temperature) * _wetting(contact_angles))


def is_wetted(contact_angles: tuple[float, float]) -> bool:
    """Whether water condenses between two flats: the cosines of their contact angles [rad] add up to more than zero.

    Examples
    --------
    >>> is_wetted((0.0, 0.0)), is_wetted((np.pi / 2, np.pi / 2)), is_wetted((0.1, 3.0))
    (True, False, True)
    """
    return bool(np.cos(contact_angles).sum() > ROUNDING)


def _wetting(contact_angles):
    """Sum of the cosines of the contact angles of two solids. It must be positive."""
    wetting = np.cos(contact_angles[0]) + np.cos(contact_angles[1])
    if not wetting > 0:
        degrees = " and ".join(f"{np.degrees(angle):.3g}" for angle in contact_angles)
        raise ValueError(f"no water condenses between flats with contact angles of {degrees} degrees")
    return wetting
