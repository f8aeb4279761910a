"""Table of the estimate from a trained design, and its errors on surfaces that were not learnt.

python -m stiction.estimate.make FOLDER
"""

import json
import sys
from pathlib import Path
from typing import Any

from stiction.config.reading import paper
from stiction.config.units import to_si
from stiction.constants import WATER_MOLAR_VOLUME, WATER_SURFACE_ENERGY
from stiction.estimate.answer import CHOSEN, CONFIDENCES
from stiction.estimate.design import FILMS, SurfaceLaw
from stiction.estimate.errors import conformal, rest_of, scores, tested
from stiction.estimate.fit import Fitted, fitted, group, rounded
from stiction.estimate.length import normal_score
from stiction.estimate.rows import OF_FULL, rows_of_full, rows_of_tips
from stiction.estimate.state import COORDINATES
from stiction.estimate.table import FILE, Surrogate
from stiction.estimate.training import SETS, TrainingTips, base, full_contact_of, plan_of
from stiction.models import SIDES
from stiction.progress import without_progress
from stiction.run.atomic import save_text

#: Temperature of the design [K].
_TEMPERATURE = 300.0
#: Normal score at which errors are known.
TESTED = round(normal_score(CHOSEN), 6)
#: Keys of the library that the estimate reads.
_OF_LIBRARY = ("rms_nm", "skewness", "kurtosis", "psd", "published_psd")


def table_of(folder: Path) -> dict[str, Any]:
    """Content of the table."""
    modulus = to_si(paper()["solid"]["young_modulus_GPa"], "GPa")
    tips = fitted(rows_of_tips(folder, "learn", modulus), "at_2", range(len(COORDINATES)))
    full = fitted(rows_of_full(folder, "learn", modulus), "ratio", OF_FULL, 90)
    library = {name: {key: entry[key] for key in _OF_LIBRARY} for name, entry in paper()["surfaces"].items()}
    table = {
        "modulus": modulus,
        "temperature": _TEMPERATURE,
        "water": [WATER_SURFACE_ENERGY, WATER_MOLAR_VOLUME],
        "library": library,
        "pairs": {name: {side: pair[side] for side in SIDES} for name, pair in paper()["pairs"].items()},
        "tested_score": TESTED,
        "sets": {name: vars(effort) for name, effort in SETS.items()},
        "coordinates": COORDINATES,
        "left_out": tips.scatter | full.scatter,
        "rest": rest(folder, modulus, tips, full),
        "tips": tips.content,
        "full": full.content,
    }
    return table | {
        "margins": margins(folder, table),
        "control": {"slopes": control_of_slopes(), "forces": control_of_forces()},
    }


def _control_point():
    """Point of the control numbers, its plan, and its film."""
    (point,) = SETS["control"].all
    return point, plan_of(point, base()), to_si(FILMS[0], "nm")


def control_of_slopes() -> list[float]:
    """Slopes of a few tips, by which a test sees that contacts are still those that were learnt."""
    point, plan, height = _control_point()
    return TrainingTips.of(point, plan, SETS["control"].tips, SETS["control"].seed).slopes(height, 1.0).ravel().tolist()


def control_of_forces() -> list[float]:
    """Forces of one tip in full contact at three slopes, as `control_of_slopes`."""
    point, plan, height = _control_point()
    return full_contact_of(point, plan, height, "control")["full"].ravel().tolist()


def rest(folder: Path, modulus: float, tips: Fitted, full: Fitted) -> float:
    """Rest of the difficulty from surfaces to learn from, each with the processes that have not learnt it."""

    def without(point):
        """Processes without a point."""
        return tuple(Surrogate(**each.without[group(point.number)]) for each in (tips, full))

    return round(rest_of(list(tested(folder, "learn", modulus, TESTED, without))), 4)


def margins(folder: Path, table: dict[str, Any]) -> dict[str, float]:
    """Half of the intervals of the logarithm of a length over its difficulty, by confidence.

    The widest of those of each law, so that an interval holds for surfaces of either.
    """
    processes = Surrogate(**table["tips"]), Surrogate(**table["full"])
    found = [
        scores(list(tested(folder, f"decide_{law}", table["modulus"], TESTED, lambda _: processes)), table["rest"])
        for law in (SurfaceLaw.TYPICAL, SurfaceLaw.ANY)
    ]
    return {name: round(max(conformal(errors, int(name) / 100) for errors in found), 4) for name in CONFIDENCES}


if __name__ == "__main__":
    with without_progress():
        content = table_of(Path(sys.argv[1]))
    save_text(json.dumps(rounded(content), separators=(",", ":")) + "\n", FILE)
