"""Air around two surfaces: its relative humidity, and all that depends on whether it is dry or humid.

Dry air has the humidity 0 in the code. It has no water at all, which is not a film that becomes thinner and thinner. No
other module compares a humidity with 0, which a test of the architecture makes sure of.
"""

from collections.abc import Collection
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    import numpy as np  # a command that checks its files first must not import it

T = TypeVar("T")
#: Word for the humidity of dry air in configurations, and the medium of attraction in it.
DRY = "dry"
#: ASSUME: fewest molecules across a film that is a liquid: one adsorbed on each solid, and one between them. On silica
#: the first three layers, which grow up to RH 0.3, are ordered as in ice, and only those beyond are liquid (Asay and
#: Kim, J. Phys. Chem. B 109, 16760, 2005); on mica, water is solid-like between RH 0.2 and 0.4 (Hu, Xiao, Ogletree and
#: Salmeron, Surf. Sci. 344, 221, 1995). Eqs. (8) and (9) give thinner films a tension that grows without limit.
MOLECULES = 3
#: Rounding of the sum of two cosines that are opposite to each other.
ROUNDING = 1e-9
#: Both kinds of air. A pair has one contact in all air of a kind.
KINDS_OF_AIR = ("humid", DRY)


def is_possible(humidity: Any) -> bool:
    """Whether air can have a relative humidity. Saturated air has none of the films of this package."""
    return isinstance(humidity, Real) and 0 <= humidity < 1


def is_humid(humidity: "float | np.ndarray") -> "bool | np.ndarray":
    """Whether air of each humidity [-] has water, in the shape of the humidity."""
    return humidity > 0


def humid(humidities: float | Collection[float]) -> list[float]:
    """Humidities, of one or several, without that of dry air, in their order [-]."""
    return [float(humidity) for humidity in _listed(humidities) if is_humid(humidity)]


def has_dry(humidities: float | Collection[float]) -> bool:
    """Whether dry air is among humidities, one or several [-]."""
    return 0 in _listed(humidities)


def _listed(humidities):
    """Humidities as a list, one or several."""
    return [humidities] if isinstance(humidities, Real) else list(humidities)


@dataclass(frozen=True)
class Air:
    """Air of a relative humidity, in words and in names of files.

    Examples
    --------
    >>> humid, dry = Air(0.67), Air(0.0)
    >>> humid.name, humid.words, humid.where, humid.ending
    ('0.67', 'RH 0.67', 'at RH 0.67', '_rh067')
    >>> dry.name, dry.words, dry.where, dry.ending
    ('dry', 'dry', 'in dry air', '_dry')
    >>> humid.kind, dry.kind, dry.choose("its own contact", None)
    ('humid', 'dry', 'its own contact')
    """

    humidity: float  #: 0 in dry air [-]

    @property
    def is_dry(self) -> bool:
        """Whether it has no water."""
        return self.humidity == 0

    @property
    def kind(self) -> str:
        """One of `KINDS_OF_AIR`."""
        return KINDS_OF_AIR[self.is_dry]

    def choose(self, in_humid_air: T, in_dry_air: T | None) -> T:
        """Choose what holds in this air. Without anything of its own, dry air has that of humid air."""
        return in_dry_air if self.is_dry and in_dry_air is not None else in_humid_air

    @property
    def name(self) -> str:
        """Humidity as configurations state it."""
        return self.choose(f"{self.humidity:g}", DRY)

    @property
    def words(self) -> str:
        """Name in figures and tables, and before a comma."""
        return self.choose(f"RH {self.name}", DRY)

    @property
    def where(self) -> str:
        """Place in this air, as a part of a sentence."""
        return self.choose(f"at {self.words}", "in dry air")

    @property
    def ending(self) -> str | None:
        """End of the names of cases in it, with two to four decimals. ``None`` if four are not exact."""
        if self.is_dry:
            return f"_{DRY}"
        texts = (f"{self.humidity:.{decimals}f}" for decimals in (2, 3, 4))
        return next((f"_rh{text.replace('.', '')}" for text in texts if float(text) == self.humidity), None)


#: Dry air, whose contacts have names of their own.
DRY_AIR = Air(0.0)
