"""Files of the points from which the estimate is learnt: one per point, in the folder of its chunk."""

from pathlib import Path
from typing import Any

import numpy as np

#: Points of a chunk, which one job computes.
CHUNK = 16


def path_of(folder: Path, number: int) -> Path:
    """File of a point of a set, in the folder of its chunk."""
    return folder / f"{number // CHUNK * CHUNK:04}" / f"{number:04}.npz"


def save(folder: Path, number: int, numbers: dict[str, Any]) -> None:
    """Write the numbers of a point of a set."""
    path = path_of(folder, number)
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez(path, **numbers)


def numbers_of(folder: Path, number: int) -> dict[str, Any]:
    """Numbers of a point of a set."""
    with np.load(path_of(folder, number)) as file:
        return dict(file)
