"""Numbers of a few cheap points, by which a table and its points show that contacts are still those of the code.

The command writes them where they are missing or no longer agree, so that all points are computed again:

    python -m stiction.estimate.learning.jobs.control FILE
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from stiction.config.units import to_si
from stiction.estimate.learning import bridges, dry, dry_bridges, dry_patches, patches
from stiction.estimate.learning.design import FILMS
from stiction.estimate.learning.training import SETS, TrainingTips, air_of, base, full_contact_of, plan_of, water_of
from stiction.progress import without_progress
from stiction.run.atomic import save_text

#: Largest relative difference between machines, that of the tests of the table: what fails there is learnt again.
TOLERANCE = 0.0001


def _point():
    """Point of the numbers, its plan, and its film."""
    (point,) = SETS["control"].all
    return point, plan_of(point, base()), to_si(FILMS[0], "nm")


def slopes() -> list[float]:
    """Slopes of a few tips in humid air."""
    point, plan, height = _point()
    return TrainingTips.of(point, plan, SETS["control"].tips, SETS["control"].seed).slopes(height, 1.0).ravel().tolist()


def forces() -> list[float]:
    """Forces of one tip in full contact at three slopes."""
    point, plan, height = _point()
    humidity, _ = air_of(height, 1.0, water_of(plan).temperature)
    return full_contact_of(point, plan, humidity, SETS["control"])["full"].ravel().tolist()


def of_patches() -> list[float]:
    """Pull-off pressures of a few patches."""
    point, _, height = _point()
    effort = SETS["control"]
    plan = patches.plan_of(point, patches.sides_of(point, effort.seed, effort.law), patches.base())
    return patches.forces_of(point, plan, np.array([height]), effort.patches, effort.seed)[0].tolist()


def of_bridges() -> list[float]:
    """Lengths of a few bridges on few strips."""
    point, _, height = _point()
    effort, plan = SETS["control"], bridges.plan_of(point, bridges.base())
    strips = bridges.TrainingStrips.of(point, plan, 10 * effort.patches, effort.seed)
    return strips.lengths(height, bridges.sizes_of(point, "control")[0], effort.patches).tolist()


def numbers() -> dict[str, Any]:
    """All numbers, in humid and in dry air."""
    with without_progress():
        humid = {"slopes": slopes(), "forces": forces(), "patches": of_patches(), "bridges": of_bridges()}
        return {"humid": humid, "dry": dry.control() | dry_patches.control() | dry_bridges.control()}


def agree(first: dict[str, Any], second: dict[str, Any]) -> bool:
    """Whether numbers are those of the same contacts."""
    return all(
        first[air].keys() == second[air].keys()
        and all(_close(values, second[air][name]) for name, values in first[air].items())
        for air in ("humid", "dry")
    )


def _close(values, others):
    """Whether two lists have about the same numbers."""
    return len(values) == len(others) and np.allclose(values, others, rtol=TOLERANCE, atol=0, equal_nan=True)


def save(path: Path) -> None:
    """Write the numbers of the code to a file, unless those of the file agree with them."""
    found = numbers()
    if not (path.exists() and agree(json.loads(path.read_text(encoding="utf-8")), found)):
        path.parent.mkdir(parents=True, exist_ok=True)
        save_text(json.dumps(found), path)


if __name__ == "__main__":
    save(Path(sys.argv[1]))
