"""Numbers sought for devices: the largest length, or the smallest restoring force, of which few enough stick."""

from dataclasses import dataclass

from stiction.rounding import rounded

#: Significant digits of sizes.
DIGITS = 3


@dataclass(frozen=True, kw_only=True)
class Sought:
    """Number by which devices differ in whether they stick, and its words."""

    name: str
    unit: str  #: in datasets
    shown: str  #: unit for readers
    digits: str  #: format for readers
    more_is_better: bool  #: whether devices with more of it stick less often
    label: str  #: what a device has, in words
    required: str  #: what a device has to have, in words
    response: str  #: number with the allowed fraction stuck, in words
    devices: str  #: devices with such a number
    bound: str  #: how a number that is safe bounds all safe ones
    fraction: str = "P(stuck)"  #: fraction that the number decides about, in short
    scale: float = 1e-6  #: unit for readers in that of datasets

    @property
    def sign(self) -> float:
        """Sign of the logarithm of the number in v, which increases with the fraction stuck."""
        return -1.0 if self.more_is_better else 1.0

    @property
    def ratio(self) -> str:
        """Ratio above one if the requirement is met, in words."""
        of_device = self.required, self.response
        return " / ".join(of_device if self.more_is_better else reversed(of_device))

    def safe(self, size: float) -> float:
        """Size in the unit for readers, rounded to its safe side: lengths down, forces up.

        Examples
        --------
        >>> LENGTH.safe(200.66e-6), FORCE.safe(12.341e-6)
        (200.0, 12.4)
        """
        return float(rounded(size / self.scale, DIGITS, self.more_is_better))

    def is_stricter(self, size: float, other: float) -> bool:
        """Whether a size allows less than another one as readers see both.

        Examples
        --------
        >>> LENGTH.is_stricter(199.9e-6, 200.66e-6), LENGTH.is_stricter(200.1e-6, 200.66e-6)
        (True, False)
        """
        return self.sign * self.safe(size) < self.sign * self.safe(other)

    def in_words(self, number: float) -> str:
        """Number in the unit for readers.

        Examples
        --------
        >>> LENGTH.in_words(113.4e-6), FORCE.in_words(12.345e-6)
        ('113 µm', '12.3 µN')
        """
        return f"{number / self.scale:{self.digits}} {self.shown}"


LENGTH = Sought(
    name="length", unit="m", shown="µm", digits=".0f", more_is_better=False, label="length", required="required length",
    response="length", devices="devices", bound="No longer than",
)  # fmt: skip
FORCE = Sought(
    name="force", unit="N", shown="µN", digits=".3g", more_is_better=True, label="restoring force",
    required="restoring force", response="force needed", devices="stoppers", bound="At least",
)  # fmt: skip
PULL_OFF = Sought(
    name="pull_off", unit="N", shown="nN", digits=".4g", more_is_better=True, label="pull-off force",
    required="measured force", response="pull-off force", devices="places", bound="At most", fraction="P(more)",
    scale=1e-9,
)  # fmt: skip
#: What is sought of devices to build, by its unit in datasets.
SOUGHT = {sought.unit: sought for sought in (LENGTH, FORCE)}
