"""Numbers of beams and of samples that a pilot decides, as a plan takes them."""

from dataclasses import asdict, dataclass
from typing import Any

from stiction.config.cases import Case
from stiction.config.merging import merged
from stiction.contact.air import Air


@dataclass(frozen=True)
class Numbers:
    """Numbers of beams and of samples, and the errors to be expected of them."""

    accuracy: float | None  #: relative standard error that is asked for, if any [-]
    beams: int  #: of every device and humidity; as many tips
    samples: dict[str, int]  #: of the grounds of beams, by the name of the patch; none if they are stated
    errors: dict[Case, float]  #: largest of the lengths of each case [-]

    @classmethod
    def from_plain(cls, plain: dict[str, Any] | None) -> "Numbers | None":
        """Numbers from their plain form, as JSON gives it back."""
        return plain and cls(**plain | {"errors": {Case(case): error for case, error in plain["errors"].items()}})

    @property
    def plain(self) -> dict[str, Any]:
        """Plain numbers, strings and dicts, to be kept."""
        return asdict(self)

    def within(self, config: dict) -> dict:
        """Configuration with these numbers, as all plans take them."""
        return merged(config, {"design": {"beams": self.beams, "samples_of_patches": self.samples}})

    def __str__(self):
        grounds = "".join(f", {number} samples of {name}" for name, number in self.samples.items())
        if self.accuracy is None:
            return f"Devices take {self.beams} beams{grounds}."
        words = f"An accuracy of {self.accuracy:.2g} takes {self.beams} beams{grounds}"
        worst = max(self.errors, key=self.errors.get, default=None)
        if worst is None or self.errors[worst] <= self.accuracy:
            return f"{words}."
        missed = f"{self.errors[worst]:.2g} for {worst.device} {Air(worst.humidity).where}"
        return f"{words}; it is missed: with these numbers, the error is about {missed}."
