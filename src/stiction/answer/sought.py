"""Numbers sought for devices: the largest length, or the smallest restoring force, of which few enough stick."""

from dataclasses import dataclass


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
    required="measured force", response="pull-off force", devices="places", bound="At most", scale=1e-9,
)  # fmt: skip
#: What is sought of devices to build, by its unit in datasets.
SOUGHT = {sought.unit: sought for sought in (LENGTH, FORCE)}
