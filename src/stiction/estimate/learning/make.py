"""Table of the estimate from a trained design, and its errors on surfaces that were not learnt.

python -m stiction.estimate.learning.make FOLDER TABLE.json
"""

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from stiction.config.reading import paper
from stiction.config.units import to_si
from stiction.constants import WATER_MOLAR_VOLUME, WATER_SURFACE_ENERGY
from stiction.estimate import dry as of_dry_air
from stiction.estimate.answer import CHOSEN, OF_OTHER_SOLIDS
from stiction.estimate.bridge import COORDINATES as OF_BRIDGES
from stiction.estimate.dry_bridge import COORDINATES as OF_DRY_BRIDGES
from stiction.estimate.learning import dry, dry_rows
from stiction.estimate.learning.bridge_rows import rows_of_changes, rows_of_middles
from stiction.estimate.learning.bridges import EVERY
from stiction.estimate.learning.bridges import RANGES as RANGES_OF_BRIDGES
from stiction.estimate.learning.design import SIDES as SIDES_OF_PATCHES
from stiction.estimate.learning.design import SurfaceLaw
from stiction.estimate.learning.errors import (
    Tested,
    longest_tested,
    margins_of,
    rest_of,
    scores,
    tested,
    tested_bridges,
    tested_forces,
)
from stiction.estimate.learning.fit import Fitted, everywhere, fitted, group, rounded
from stiction.estimate.learning.other_solids import rows as of_solids
from stiction.estimate.learning.other_solids.ratios import ALL
from stiction.estimate.learning.other_solids.rows import RowsOfRatio
from stiction.estimate.learning.rows import (
    OF_FULL,
    OF_RATIO,
    rows_of_full,
    rows_of_patches,
    rows_of_ratios,
    rows_of_tips,
)
from stiction.estimate.learning.training import SETS
from stiction.estimate.length import normal_score
from stiction.estimate.state import COORDINATES, OF_PATCHES
from stiction.estimate.table import CHANGES, Surrogate, processes
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
        "sets": {name: vars(effort) for name, effort in SETS.items()},
        "coordinates": COORDINATES,
        "tips": tips.content,
        "full": full.content,
        **changes_of(of_solids.rows_of_tips, folder, modulus),
        "stoppers": stoppers_of(folder, modulus),
        "bridges": bridges_of(folder, modulus),
        "dry": in_dry_air(folder, modulus),
    }
    table |= errors_of(tested, folder, modulus, tips, full)
    for section, margins in margins_of_other_solids(folder, table).items():
        (table[section] if section else table)[OF_OTHER_SOLIDS] = margins
    return table | {"control": _control(folder, "humid")}


def _control(folder, air):
    """Numbers in an air by which a test sees that contacts are still those that were learnt."""
    return json.loads((folder / "control.json").read_text(encoding="utf-8"))[air]


def in_dry_air(folder: Path, modulus: float) -> dict[str, Any]:
    """Part of the table about dry air, as the whole one."""
    tips = fitted(dry_rows.rows_of_tips(folder, "learn", modulus), "at_2", range(len(of_dry_air.OF_TIPS)))
    full = fitted(dry_rows.rows_of_full(folder, "learn", modulus), "ratio", dry_rows.OF_FULL, 90)
    forces = fitted(dry_rows.rows_of_patches(folder, "learn", modulus), "at_2", range(len(of_dry_air.OF_PATCHES)))
    ratios = fitted(dry_rows.rows_of_ratios(folder, "learn", modulus), "ratio", dry_rows.OF_RATIO, 90)
    stoppers = {"sides": SIDES_OF_PATCHES, "coordinates": of_dry_air.OF_PATCHES}
    stoppers |= {"forces": forces.content, "full": ratios.content}
    stoppers |= errors_of(dry_rows.tested_forces, folder, modulus, forces, ratios)
    bridges = bridges_in_dry_air(folder, modulus, forces, ratios)
    section = {"sets": {name: vars(effort) for name, effort in dry.SETS.items()}, "tips": tips.content}
    section |= {
        "coordinates": of_dry_air.OF_TIPS,
        "full": full.content,
        "stoppers": stoppers,
        "bridges": bridges,
        "control": _control(folder, "dry"),
    }
    return section | errors_of(dry_rows.tested, folder, modulus, tips, full)


def bridges_in_dry_air(folder: Path, modulus: float, *of_patches: Fitted) -> dict[str, Any]:
    """Part of the table about bridges in dry air, beside processes of patches."""
    known_patches = [Surrogate(**each.content) for each in of_patches]
    rows = dry_rows.rows_of_middles(folder, "learn", modulus, *known_patches)
    middle = everywhere(fitted(rows, "at_2", range(len(OF_DRY_BRIDGES)), 90))
    section = {"coordinates": OF_DRY_BRIDGES, "middle": middle.content}
    return section | errors_of(dry_rows.tested_bridges, folder, modulus, middle, *of_patches)


def changes_of(rows_of: Callable[..., RowsOfRatio], folder: Path, modulus: float) -> dict[str, Any]:
    """Processes of the changes of lengths or forces by the ratios of other solids."""
    learnt = (rows_of(folder, modulus, ratio) for ratio in ALL)
    changes = (fitted(each.rows, "at_2", each.columns, 90).content for each in learnt)
    return dict(zip(CHANGES, changes, strict=True))


def stoppers_of(folder: Path, modulus: float) -> dict[str, Any]:
    """Part of the table about stoppers."""
    forces = fitted(rows_of_patches(folder, "learn", modulus), "at_2", range(len(OF_PATCHES)))
    full = fitted(rows_of_ratios(folder, "learn", modulus), "ratio", OF_RATIO, 90)
    section = {"sides": SIDES_OF_PATCHES, "coordinates": OF_PATCHES, "forces": forces.content, "full": full.content}
    section |= changes_of(of_solids.rows_of_patches, folder, modulus)
    return section | errors_of(tested_forces, folder, modulus, forces, full)


def bridges_of(folder: Path, modulus: float) -> dict[str, Any]:
    """Part of the table about bridges."""
    middle = fitted(rows_of_middles(folder, "learn", modulus), "at_2", range(len(OF_BRIDGES)))
    full = fitted(rows_of_changes(folder, "learn", modulus), "shift", OF_RATIO, 90)
    section = {
        "every": EVERY,
        "ranges": RANGES_OF_BRIDGES,
        "coordinates": OF_BRIDGES,
        "middle": middle.content,
        "full": full.content,
        "longest": longest_tested(folder, "decide", modulus, *(Surrogate(**each.content) for each in (middle, full))),
    }
    section |= changes_of(of_solids.rows_of_bridges, folder, modulus)
    return section | errors_of(tested_bridges, folder, modulus, middle, full)


#: Errors of all surfaces of some sets, as `stiction.estimate.learning.errors.tested`.
Test = Callable[..., Iterator[Tested]]


def errors_of(test: Test, folder: Path, modulus: float, first: Fitted, *others: Fitted) -> dict[str, Any]:
    """Numbers of the table about the errors of some processes, such as those on summits and in full contact."""
    processes, left_out = (first, *others), first.scatter
    for each in others:
        left_out = left_out | {name: scatter for name, scatter in each.scatter.items() if name not in left_out}
    of_rest = rest(test, folder, modulus, *processes)
    of_margins = margins(test, folder, modulus, of_rest, *(Surrogate(**each.content) for each in processes))
    section = {"tested_score": TESTED, "left_out": left_out}
    return section | {"rest": of_rest, "margins": of_margins}


def rest(test: Test, folder: Path, modulus: float, *processes: Fitted) -> float:
    """Rest of the difficulty from surfaces to learn from, each with the processes that have not learnt it."""

    def without(point):
        """Processes without a point."""
        return tuple(Surrogate(**each.without[group(point.number)]) for each in processes)

    return round(rest_of(list(test(folder, "learn", modulus, TESTED, without))), 4)


def margins(test: Test, folder: Path, modulus: float, of_rest: float, *processes: Surrogate) -> dict[str, float]:
    """Parts of the intervals of the logarithm of a length over its difficulty.

    As of `stiction.estimate.learning.errors.margins_of`, the widest of those of each law, so that an interval
    holds for surfaces of either.
    """
    by_law = [
        margins_of(scores(list(test(folder, f"decide_{law}", modulus, TESTED, lambda _: processes)), of_rest))
        for law in (SurfaceLaw.TYPICAL, SurfaceLaw.ANY)
    ]
    return {name: round(max(each[name] for each in by_law), 4) for name in by_law[0]}


def margins_of_other_solids(folder: Path, table: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Margins of other solids by section of the table, no less than those of polysilicon.

    From the errors of the sets that decide, both laws together. ASSUME: those of bridges grow as much as those of
    lengths that tips hold, or as those of forces.
    """
    growth = {
        "": _growth(of_solids.tested, folder, table, "tips"),
        "stoppers": _growth(of_solids.tested_forces, folder, table["stoppers"], "forces"),
    }
    growth["bridges"] = {name: max(each[name] for each in growth.values()) for name in growth[""]}
    margins = {section: (table[section] if section else table)["margins"] for section in growth}
    return {
        section: {name: round(margins[section][name] * factor, 4) for name, factor in factors.items()}
        for section, factors in growth.items()
    }


def _growth(test, folder, section, first):
    """Factors of the margins of a section of the table on other solids, by confidence."""
    learnt = processes(rounded(section), first, "full")
    sets = [f"decide_{law}" for law in (SurfaceLaw.TYPICAL, SurfaceLaw.ANY)]
    surfaces = [surface for name in sets for surface in test(folder, name, TESTED, learnt, as_polysilicon=False)]
    of_others, margins = margins_of(scores(surfaces, section["rest"])), section["margins"]
    return {name: max(1.0, of_others[name] / margin) for name, margin in margins.items()}


if __name__ == "__main__":
    with without_progress():
        content = table_of(Path(sys.argv[1]))
    save_text(json.dumps(rounded(content), separators=(",", ":")) + "\n", Path(sys.argv[2]))
