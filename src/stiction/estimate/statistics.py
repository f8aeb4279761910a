r"""Statistics of the sum of two independent rough surfaces, from those of both sides. Plain Python, SI units.

Contact depends on the sum of the heights alone. Cumulants of independent heights add, and so do their spectra. Of a
spectrum s the estimate knows the moments

.. math:: m_n = 2 \pi \int_0^{\zeta_1} s(\zeta) \, \zeta^{n+1} \, d\zeta , \quad n = -1, 0, 2, 4 .
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from stiction.config.units import to_si

#: Orders of the moments beside the variance.
ORDERS = (-1, 2, 4)


@dataclass(frozen=True)
class Heights:
    """Statistics of heights."""

    rms: float  #: [m]
    skewness: float  #: [-]
    kurtosis: float  #: 3 for Gaussian heights [-]
    moments: tuple[float, ...]  #: of the spectrum by `ORDERS`, over the variance [rad m⁻¹, to their order]

    @property
    def slope(self) -> float:
        """Root mean square of the slope [-]."""
        return self.rms * math.sqrt(self.moments[1])

    def __add__(self, other: "Heights") -> "Heights":
        """Statistics of the sum of independent heights."""
        rms, both = math.hypot(self.rms, other.rms), (self, other)
        second, third, fourth = ([(each.rms / rms) ** power for each in both] for power in (2, 3, 4))
        return Heights(
            rms,
            _weighted(third, (each.skewness for each in both)),
            3 + _weighted(fourth, (each.kurtosis - 3 for each in both)),
            tuple(_weighted(second, values) for values in zip(*(each.moments for each in both), strict=True)),
        )


def _weighted(weights, values):
    """Weighted sum."""
    return sum(weight * value for weight, value in zip(weights, values, strict=True))


def slope_of(psd: Mapping[str, float]) -> float:
    """Exponent of the power law of a section ``published_psd`` [-]."""
    falls = math.log(psd["floor_nm4"] / psd["plateau_nm4"])
    return falls / math.log(psd["cutoff_rad_per_um"] / psd["corner_rad_per_um"])


def moments_of(corner: float, cutoff: float, slope: float) -> tuple[float, ...]:
    """Moments of a spectrum of Eq. (7) by `ORDERS`, over its variance. Corner and cut-off [rad/m], slope [-].

    Examples
    --------
    >>> [round(value, 6) for value in moments_of(30.0, 30.0, -4.0)]  # plateau alone: 2 / (n + 2) of the cut-off
    [0.066667, 450.0, 270000.0]
    """

    def moment(order):
        """Integral over plateau and power law, for a plateau of 1 / 2π."""
        power = order + 2 + slope
        beyond = math.log(cutoff / corner) if abs(power) < 1e-9 else ((cutoff / corner) ** power - 1) / power
        return corner ** (order + 2) * (1 / (order + 2) + beyond)

    return tuple(moment(order) / moment(0) for order in ORDERS)


def heights_of(entry: Mapping) -> Heights:
    """Statistics of a surface from its section in normal form: moments and ``published_psd``."""
    psd = entry["published_psd"]
    ends = (to_si(psd[f"{name}_rad_per_um"], "rad_per_um") for name in ("corner", "cutoff"))
    moments = moments_of(*ends, slope_of(psd))
    return Heights(to_si(entry["rms_nm"], "nm"), entry["skewness"], entry["kurtosis"], moments)


def of_pair(sides: Iterable[Mapping]) -> Heights:
    """Statistics of the sum of both surfaces of a pair, from their sections in normal form."""
    beam, substrate = map(heights_of, sides)
    return beam + substrate
