"""Design of drawn pairs of surfaces and of beams, from which estimates are learnt and on which they are tested.

Both surfaces of a pair are drawn by the same law. It contains the four surfaces of the paper, self-affine surfaces as
papers describe them, and nearly Gaussian heights.
"""

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from stiction.config.reading import paper
from stiction.config.surfaces.described import complete
from stiction.config.units import to_si
from stiction.streams import stream
from stiction.surface.feasible import is_feasible

#: Ranges, logarithmic where the name says so: rms of beam and substrate [nm], corner and cut-off [rad/µm], fall of the
#: spectrum between them, skewness, kurtosis above 3 over its square, E t³ / h² of a beam [N m⁻¹], width [µm].
RANGES = {
    "ln_rms": (0.8, 8.0),
    "ln_rms_of_substrate": (0.1, 4.0),
    "ln_corner": (8.0, 65.0),
    "ln_cutoff": (100.0, 290.0),
    "ln_fall": (1e-5, 3e-2),
    "skewness": (-1.2, 0.0),
    "tailed": (1.0, 2.7),
    "ln_stiffness": (1500.0, 300_000.0),
    "ln_width": (8.0, 40.0),
}
#: Least and largest side of the patch of a stopper [µm].
SIDES = (1.0, 6.0)
#: Heights of the film of water [nm]. At 300 K and perfect wetting, these are relative humidities of 0.34 and 0.92.
FILMS = (0.96, 12.4)
#: Slopes of spectra between corner and cut-off.
_STEEPEST, _FLATTEST = {False: -9.5, True: -12.0}, -2.6
#: Largest cut-off on the grid of the contact [rad/µm].
_LARGEST = 310.0
#: Numbers of a row: rms, spectrum and form of both surfaces, stiffness and width of the beam.
_COLUMNS = 14
#: Largest factors of the numbers of a typical surface.
_AROUND = {"corner": 1.6, "cutoff": 1.15, "fall": 3.0}


@dataclass(frozen=True)
class Point:
    """Pair of drawn surfaces under a beam."""

    number: int
    sides: tuple[dict[str, Any], dict[str, Any]]  #: sections of beam and substrate in normal form
    stiffness: float  #: E t³ / h² [N m⁻¹]
    width: float  #: [µm]


class SurfaceLaw(StrEnum):
    """Law of the surfaces of a set."""

    ANY = "any"  #: all surfaces of the ranges
    TYPICAL = "typical"  #: such as are like the typical ones
    PAPER = "paper"  #: those of the paper


def points(number: int, seed: int, law: SurfaceLaw) -> list[Point]:
    """First feasible points of a Sobol sequence, or those of the paper."""
    if law is SurfaceLaw.PAPER:
        return _of_paper()[:number]
    feasible: list[Point] = []
    for row in _sobol(_COLUMNS, seed).random(1 << (3 * number).bit_length()):
        if (point := _point(len(feasible), row, law is SurfaceLaw.TYPICAL)) is not None:
            feasible.append(point)
        if len(feasible) == number:
            return feasible
    raise ValueError(f"only {len(feasible)} of {number} drawn surfaces are feasible")


def _of_paper():
    """Points of surfaces of the paper, and of a smoother one, under beams of 30 µm like the paper's [N m⁻¹]."""
    library = paper()["surfaces"]
    smoother = complete({"like": "B2", "rms_nm": 2}, library)
    surfaces = library | {"smoother": smoother}
    pairs = [("B1", "Sub1"), ("B2", "Sub1"), ("B1", "Sub2"), ("Sub2", "Sub1"), ("smoother", "Sub1"), ("B2", "B1")]
    return [Point(k, (surfaces[beam], surfaces[other]), 7200.0, 30.0) for k, (beam, other) in enumerate(pairs)]


def _point(number, row, typical):
    """Point of a row of uniform numbers, ``None`` if a surface is not feasible."""
    shares, sides, spectrum = dict(enumerate(row)), [], _like if typical else _spectrum
    for first, rms in ((0, "ln_rms"), (6, "ln_rms_of_substrate")):
        form = [_within(name, shares[first + k]) for k, name in ((4, "skewness"), (5, "tailed"))]
        sides.append(
            _section(_within(rms, shares[first]), spectrum(*row[first + 1 : first + 4]), *form, _STEEPEST[typical])
        )
    sizes = _within("ln_stiffness", shares[12]), round(_within("ln_width", shares[13]), 2)
    return None if None in sides else Point(number, tuple(sides), *sizes)


def _within(name, share):
    """Value at a share of a range."""
    is_logarithmic = name.startswith("ln_")
    low, high = map(math.log, RANGES[name]) if is_logarithmic else RANGES[name]
    value = low + float(share) * (high - low)
    return math.exp(value) if is_logarithmic else value


def _spectrum(*shares):
    """Corner, cut-off and fall of any spectrum."""
    return [_within(name, share) for name, share in zip(("ln_corner", "ln_cutoff", "ln_fall"), shares, strict=True)]


def _like(*shares):
    """Corner, cut-off and fall of a spectrum like that of a typical surface, which the first share chooses."""
    library = list(paper()["surfaces"].values())
    member, first = divmod(float(shares[0]) * len(library), 1)
    psd = library[int(member)]["published_psd"]
    numbers = [psd["corner_rad_per_um"], psd["cutoff_rad_per_um"], psd["floor_nm4"] / psd["plateau_nm4"]]
    around = zip(numbers, _AROUND.values(), (first, *shares[1:]), strict=True)
    return [value * most ** (2 * float(share) - 1) for value, most, share in around]


def _section(rms, spectrum, skewness, tailed, steepest):
    """Section of a surface, ``None`` if it is not feasible."""
    (corner, cutoff, fall), kurtosis = spectrum, 3 + tailed * skewness**2
    slope = math.log(fall) / math.log(cutoff / corner)
    if not (steepest <= slope <= _FLATTEST and cutoff <= _LARGEST and is_feasible(skewness, kurtosis)):
        return None
    numbers = {"rms_nm": rms, "hurst": -slope / 2 - 1, "corner_rad_per_um": corner, "cutoff_rad_per_um": cutoff}
    numbers |= {"skewness": skewness, "kurtosis": kurtosis}
    return complete({key: float(f"{value:.6g}") for key, value in numbers.items()}, paper()["surfaces"])


def states(number: int, point: int, seed: int) -> np.ndarray:
    """Height of the film [m] and mean cosine of both contact angles in some states of a point, (number, 2).

    Films are even in the logarithm of their height. ASSUME: both sides wet perfectly.
    """
    u = _sobol(1, stream(seed, "estimate", "states", point)).random(number)[:, 0]
    low, high = (math.log(to_si(end, "nm")) for end in FILMS)
    return np.column_stack([np.exp(low + (high - low) * u), np.ones(number)])


def _sobol(columns, seed):
    """Scrambled Sobol sequence."""
    from scipy.stats import qmc  # takes a second, and jobs of a run import this module

    return qmc.Sobol(columns, seed=seed)
