"""Drawing of the method: from scans of two surfaces to the risk of a stuck device."""

from collections.abc import Callable

import numpy as np

from stiction.report.drawings.canvas import MARGIN, Drawing, area, arrow, line, profile, shape, text

#: Width and height of a picture, distance of the pictures, and where texts begin [px].
_ACROSS, _TALL, _STEP, _BESIDE = 196.0, 88.0, 124.0, 250.0
_ALONG = np.linspace(0, 1, 80)


def _curve(top: float, heights: np.ndarray, look: str, along: np.ndarray = _ALONG) -> str:
    """Line in a picture: heights from 0 at its bottom to 1 at its top, over its width."""
    x, y = MARGIN + along * _ACROSS, top + (1 - heights) * _TALL
    return line(zip(x, y, strict=True), look)


def _axes(top: float) -> str:
    left, bottom = MARGIN, top + _TALL
    return line([(left, top), (left, bottom), (left + _ACROSS, bottom)], "measure")


def _rough(level: float, rms: float, start: float) -> np.ndarray:
    """Heights of a rough line in a picture."""
    return level + profile(_ALONG * _ACROSS * 1.6, rms, start)


def _scans(top: float) -> list[str]:
    """Lines of a scan, behind each other."""
    return [_curve(top, _rough(0.14 + 0.18 * k, 0.05, 1.7 * k), "curve" if k == 0 else "faint") for k in range(5)]


def _statistics(top: float) -> list[str]:
    """Skewed density of heights, and a spectrum with a plateau and a slope."""
    x = np.linspace(0, 0.44, 60)
    density = 0.9 * np.exp(-(((x - 0.27) / np.where(x < 0.27, 0.12, 0.06)) ** 2))
    spectrum = np.where(_ALONG < 0.35, 0.8, 0.8 - 1.1 * (_ALONG - 0.35))
    right = MARGIN + 0.56 * _ACROSS
    return [
        line([(MARGIN, top + _TALL), (MARGIN + 0.44 * _ACROSS, top + _TALL)], "measure"),
        _curve(top, density, "curve", x),
        line([(right, top), (right, top + _TALL), (MARGIN + _ACROSS, top + _TALL)], "measure"),
        _curve(top, spectrum, "curve", 0.58 + 0.42 * _ALONG),
    ]


def _surfaces(top: float) -> list[str]:
    """Two rough surfaces in contact."""
    x = MARGIN + _ALONG * _ACROSS
    lower = top + (1 - _rough(0.38, 0.02, 2.0)) * _TALL
    upper = top + (1 - _rough(0.66, 0.09, 2.6)) * _TALL
    upper += (lower - upper).min()
    return [
        area([(x[0], top), *zip(x, upper, strict=True), (x[-1], top)], "solid"),
        area([(x[0], top + _TALL), *zip(x, lower, strict=True), (x[-1], top + _TALL)], "ground"),
    ]


#: Height of no force in a picture of forces.
_ZERO = 0.62


def _law(top: float, depth: float, look: str, start: float = 0.0) -> str:
    """Force against distance: repulsion, attraction, nothing."""
    distance = 0.25 + (4 - start) * _ALONG
    force = depth * (0.9 * np.exp(-9 * (distance - 0.25)) - 0.8 * distance * np.exp(1 - 1.4 * distance))
    return _curve(top, _ZERO + force, look, (start + (4 - start) * _ALONG) / 4)


def _no_force(top: float) -> str:
    level = top + (1 - _ZERO) * _TALL
    return line([(MARGIN, level), (MARGIN + _ACROSS, level)], "measure")


def _forces(top: float) -> list[str]:
    """Force against distance in drier and in more humid air."""
    looks = ((0.35, "faint"), (0.65, "faint"), (0.98, "curve"))
    return [_no_force(top), *(_law(top, depth, look) for depth, look in looks)]


def _scatter(top: float) -> list[str]:
    """Force laws of many strips."""
    laws = ((0.98, 0.1), (0.9, 0.0), (0.82, 0.35), (0.74, 0.2), (0.66, 0.5), (0.58, 0.4))
    return [_no_force(top), *(_law(top, depth, "faint", start) for depth, start in laws)]


def _beams(top: float) -> list[str]:
    """Beams with cracks of several lengths."""
    parts, ground = [], top + _TALL - 10
    for crack in (0.5, 0.58, 0.64, 0.72):
        along = np.append(crack * _ALONG, 1)
        height = np.append(1 - 3 * _ALONG**2 + 2 * _ALONG**3, 0)
        parts.append(_curve(top, 10 / _TALL + 0.85 * height, "faint", along))
    base = area(
        [(MARGIN, ground), (MARGIN + _ACROSS, ground), (MARGIN + _ACROSS, ground + 10), (MARGIN, ground + 10)], "ground"
    )
    return [base, *parts]


def _risk(top: float) -> list[str]:
    """P(stuck) against length, and the safe length below it."""
    stuck = 1 / (1 + np.exp(-22 * (_ALONG - 0.62)))
    safe = MARGIN + 0.36 * _ACROSS
    return [
        _axes(top),
        _curve(top, stuck, "curve"),
        line([(safe, top + 18), (safe, top + _TALL)], "ghost"),
        text((safe - 8, top + 34), "safe", "mark", "end"),
    ]


def _budget(top: float) -> list[str]:
    """Uncertainty due to each measurement."""
    return [
        _axes(top),
        *(
            shape("rect", "bar", x=MARGIN + 1, y=top + 8 + 21 * k, width=share * _ACROSS, height=13)
            for k, share in enumerate((0.9, 0.55, 0.3, 0.12))
        ),
    ]


#: Pictures from top to bottom, each with its title and its text in two lines.
_STEPS: tuple[tuple[Callable[[float], list[str]], str, str, str], ...] = (
    (_scans, "1  Scans", "of both surfaces,", "or published numbers"),
    (_statistics, "2  Statistics", "density of the heights and", "spectrum, with their errors"),
    (_surfaces, "3  Random surfaces", "with these statistics, drawn", "thousands of times"),
    (_forces, "4  Forces", "elastic contact, water and", "attraction, at each humidity"),
    (_scatter, "5  Random force laws", "a stochastic model of how", "strips differ"),
    (_beams, "6  Many devices", "each on its own random ground,", "until it sticks or releases"),
    (_risk, "7  Risk", "probability of sticking, and", "the length to build"),
    (_budget, "8  Budget", "what is uncertain, and what to", "measure better"),
)


def method() -> Drawing:
    """Draw the method from scans to risk."""
    parts, middle = [], MARGIN + _ACROSS / 2
    for k, (picture, title, *said) in enumerate(_STEPS):
        top = MARGIN + k * _STEP
        parts += picture(top)
        parts += [text((_BESIDE, top + 24), title, "title")]
        parts += [text((_BESIDE, top + 52 + 26 * n), words, "quiet") for n, words in enumerate(said)]
        parts += [arrow((middle, top - 28), (middle, top - 8), "line")] * (k > 0)
    steps = "; ".join(f"{title.replace('  ', ': ')} {' '.join(said)}" for _, title, *said in _STEPS)
    height = 2 * MARGIN + (len(_STEPS) - 1) * _STEP + _TALL
    return Drawing("method", "From scans to risk", f"Steps from top to bottom. {steps}.", height, parts)
