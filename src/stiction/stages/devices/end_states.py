"""End states of devices in words, for their warnings, tables, figures and pages."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from stiction.stages.devices.opening import ARC, EITHER, FORCE, MIDDLE, S_SHAPE


@dataclass(frozen=True, kw_only=True)
class StuckState:
    """Final state of a stuck device."""

    by: str  #: what holds it, in tables
    legend: str = ""  #: the same in legends
    only_if: str = ""  #: what has to be so for it to decide, where a stricter end state stands beside it
    lines: tuple[str, str] = ("", "")  #: styles of the lengths and of their bound in figures
    budget: str = ""  #: what the inputs of a budget move
    result: str = ""  #: the same beside test beams, with its unit
    safe: str = ""  #: what is safe against it
    terms: Mapping[str, str] = field(default_factory=dict)  #: terms that a page explains

    @property
    def title(self) -> str:
        """What holds a device, in titles of panels."""
        return f"{self.by}, {self.only_if}" if self.only_if else self.by


#: End states by their name in datasets; of those of one device, the longest devices are in the first.
END_STATES = {
    S_SHAPE: StuckState(
        by="beam",
        legend="held by the beam",
        only_if="only if its tip cannot touch",
        lines=("--", ":"),
        budget="mean length at which beams stick (S-shape)",
        result="crack length [µm]",
        safe="simulated limit, beam",
        terms={"Held by the beam": "The beam touches down behind an open crack and stays flat there (S-shape)."},
    ),
    EITHER: StuckState(
        by="beam or tip",
        legend="held by beam or tip",
        lines=("-", "-."),
        safe="simulated limit, beam or tip",
        terms={
            "Held by the tip": (
                "Only the free end touches and holds the beam (arc). Shorter beams can be held in this way."
            )
        },
    ),
    ARC: StuckState(by="tip", budget="length that 1 in {} tips hold (arc)", result="length held by few tips [µm]"),
    MIDDLE: StuckState(
        by="middle",
        legend="held by the middle",
        lines=("-", ":"),
        budget="mean length at which the middle of bridges holds",
        result="length that the middle holds [µm]",
        safe="simulated limit, middle",
        terms={
            "Held by the middle": (
                "Both cracks of a bridge have met, and a few micrometres of its middle hold it, where it has no slope. "
                "Bridges much shorter than two cracks are held in this way."
            )
        },
    ),
    FORCE: StuckState(
        by="whole area", budget="mean pull-off force", result="mean pull-off force [µN]", safe="simulated limit"
    ),
}
