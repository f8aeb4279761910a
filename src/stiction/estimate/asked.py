"""What all questions to the estimate have in common. Plain Python, SI units."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from stiction.constants import REFERENCE_TEMPERATURE
from stiction.contact.air import is_humid
from stiction.estimate.closed import flats
from stiction.estimate.closed.flats import FlatBound, FlatPull
from stiction.estimate.closed.life import Surroundings
from stiction.estimate.length import Lengths, most_after
from stiction.estimate.solids import SolidPair
from stiction.estimate.state import film
from stiction.estimate.statistics import Heights


@dataclass(frozen=True)
class Asked:
    """Question about a device on two surfaces. A kind has its sizes, and says how they stick."""

    name: str
    surfaces: tuple[Heights, Heights]  #: as stated
    members: tuple[dict[str, Heights], dict[str, Heights]]  #: typical surfaces in place of each that is partly assumed
    humidities: tuple[float, ...]  #: [-]
    touchdowns: int = field(default=1, kw_only=True)
    left_out: tuple[str, ...] = field(default=(), kw_only=True)  #: keys that a run would read as well
    #: Whether the length is the mean over typical surfaces, not that on the stated one.
    averaged: bool = field(default=False, kw_only=True)
    solids: SolidPair = field(default=SolidPair(), kw_only=True)
    surroundings: Surroundings = field(default=Surroundings(), kw_only=True)
    temperature: float = field(default=REFERENCE_TEMPERATURE, kw_only=True)  #: of the water [K]
    added: float = field(default=0.0, kw_only=True)  #: that a voltage adds: energy [J m⁻²], of a stopper force [N]
    unit: ClassVar[str] = "um"  #: of its size, a length

    @property
    def size(self) -> float | None:
        """Size to which it is built [SI], none if it is not stated."""
        raise NotImplementedError

    @property
    def stated(self) -> float | None:
        """Its size as a length."""
        return self.size

    @property
    def is_driven(self) -> bool:
        """Whether a voltage holds it as well."""
        return self.added > 0

    @property
    def closed(self) -> Any:
        """Closed form of its lengths from the bare ones, without voltage or stress."""
        raise NotImplementedError

    def closed_on(self, _found: Mapping[Heights, Lengths], _air: float, _table: Mapping[str, Any]) -> Any:
        """Closed form in one air, from the bare lengths on the sums of two surfaces that can be meant."""
        return self.closed

    @property
    def most(self) -> float:
        """Largest fraction that is known after all touchdowns [-]."""
        return most_after(self.touchdowns)

    @property
    def is_of_polysilicon(self) -> bool:
        """Whether solids and water are those of most surfaces that were learnt."""
        return self.solids == SolidPair() and self.temperature == REFERENCE_TEMPERATURE

    def is_dry(self, air: float) -> bool:
        """Whether no water condenses between its surfaces at a humidity [-]."""
        return not (is_humid(air) and self.solids.is_wetted)

    def attractions(self, air: float) -> tuple[FlatPull, ...]:
        """Attractions of flat surfaces in contact at a humidity [-]."""
        water = None if self.is_dry(air) else film(air, self.temperature, self.solids.wetting)
        return flats.attractions(water, self.solids)

    def on_flats(self, attracted: Sequence[FlatPull]) -> FlatBound:
        """Size that flat surfaces hold by their attractions."""
        raise NotImplementedError
