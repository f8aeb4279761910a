"""Stage scan: the map of heights in one file of a microscope."""

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from stiction.plan.stage import File, Stage
from stiction.scans import reading
from stiction.scans.reading import ScanFile, Source
from stiction.scans.scan import Scan


@dataclass(frozen=True)
class Settings:
    """Settings of a scan, without its file."""

    file: str  #: name of the file without folders
    sha256: str  #: of its content
    source: Source = Source()


def compute(file: str | Path, settings: Settings) -> xr.Dataset:
    """Read the heights of a file. A warning states the notes on its limits.

    Raises
    ------
    ScanError
        If the file has no usable map of heights.
    """
    heights = reading.read(file, settings.source)
    for note in heights.notes:
        warnings.warn(note, stacklevel=2)
    return layout(heights)


def layout(file: ScanFile) -> xr.Dataset:
    """Dataset of the heights of one scan, less their mean, in single precision. Undefined heights are NaN."""
    scan = file.scan
    fast, slow = (np.arange(n) * pixel for n, pixel in zip(scan.heights.shape, scan.frame.pixel, strict=True))
    elevation = np.asarray(scan.heights - np.nanmean(scan.heights), np.float32)
    return xr.Dataset(
        {
            "elevation": (("fast", "slow"), elevation),
            "size": ("axis", list(scan.size)),
            "file": ((), scan.name),
            "channel": ((), file.channel),
            "unit": ((), file.unit),
            "notes": ((), "\n".join(file.notes)),
        },
        coords={
            "fast": ("fast", fast),
            "slow": ("slow", slow),
            "axis": ["fast", "slow"],
        },
    )


def scan_of(dataset: xr.Dataset) -> Scan:
    """Scan, in double precision."""
    return Scan(
        dataset.elevation.values.astype(float), tuple(map(float, dataset["size"].values)), str(dataset.file.item())
    )


def notes(dataset: xr.Dataset) -> tuple[str, ...]:
    """Sentences on the choice of the channel and on levelling by the instrument."""
    return tuple(str(dataset.notes.item()).splitlines())


STAGES = (
    Stage.writing(
        "scan",
        "scan/{surface}_{number}",
        surfaces=lambda plan: plan.scans.surfaces,
        # The content of the file is among the settings; the folder of the file does not affect the result.
        inputs=lambda plan, at: {"file": File(plan.scans.path(at.surface, at.number))},
        settings=lambda plan, at: plan.scans.scan(at.surface, at.number),
        kind=Settings,
        compute=compute,
        libraries=("SurfaceTopography",),
        message="Read scan {number} of surface {surface}.",
    ),
)
