"""The chart of P(stuck) shows what its answers say: a band at every size, and the dot of a state inside of it."""

import re
from dataclasses import replace

import numpy as np
import pytest
from browser import missing
from drawn_curves import BEAM

from stiction.devices.risk import SCORES
from stiction.report.devices import explorer
from stiction.report.devices.grid import Grid, GridAxis
from stiction.report.devices.levels import SHOWN, counted
from stiction.report.page import Page

pytestmark = [
    pytest.mark.slow,
    pytest.mark.browser,
    pytest.mark.skipif(bool(missing()), reason=missing()),
]

SHARE = GridAxis("share", "fraction", "", "score", (1e-4, 1e-2), 1e-3, True, "it was not computed")
LENGTH = GridAxis("length_um", "length", "µm", "linear", (40.0, 250.0), 100.0, True, "it was not computed")
AIR = GridAxis("humidity", "humidity", "", "linear", (0.4, 0.9), 0.5, True, "it was not computed")
#: Dot, corners of the band, ticks of 100 % and 0.001 % and caption of the first chart.
CHART = """
const svg = document.querySelector('.charts svg'), dot = svg.querySelector('.here');
const rules = [...svg.querySelectorAll('.rule')].map(one => Number(one.getAttribute('y1')));
return [[Number(dot.getAttribute('cx')), Number(dot.getAttribute('cy'))], svg.querySelector('.band').getAttribute('d'),
  rules, svg.parentElement.querySelector('figcaption').textContent];
"""


def grid_of(kind, falls):
    """Grid whose band is that of counted devices, or as answers have it.

    Those know no lower end below a size, have one upper end where nothing sticks, and a mean above their band.
    """
    sign = -1 if falls else 1
    medians = np.array([[120.0], [100.0]])
    safe = medians * np.exp(0.1 * sign * SHARE.coordinates)
    grid = Grid((AIR,), SHARE, LENGTH, safe, counted(medians * np.exp(0.1 * sign * SCORES), 3000), 3000, falls)
    if kind == "counted":
        return grid
    levels, first = grid.levels.copy(), medians * np.exp(-0.1 * sign)
    levels[2] = np.where(SHOWN < -3.1, np.nan, medians * np.exp(0.1 * sign * (np.maximum(SHOWN, -3.1) - 0.1)))
    levels[0] = medians * np.exp(0.1 * sign * np.where(SHOWN < -2, SHOWN - 0.6, SHOWN))
    return replace(grid, levels=levels, first=first)


def opened(browser, path, grid):
    words = {"safe": "Length to build", "stick": "Devices that stick", "bound": "to build"}
    content = explorer.content("D", BEAM, [explorer.View("air", grid, words)]) | {"study": {}}
    path.write_text(Page("D", {}, ["Yes."], explorer=content).html, encoding="utf-8")
    browser.open(path)


def chart_at(browser, state):
    """Dot, band (corners, 2) below and above, height of a fraction, and caption at a state."""
    address = "&".join(f"{key}={value}" for key, value in state.items())
    browser.run("location.hash = arguments[0]; dispatchEvent(new HashChangeEvent('hashchange'))", address)
    dot, band, rules, caption = browser.run(CHART)
    corners = np.array([corner.split() for corner in re.split("[ML]", band)[1:]], float)
    low, high = corners[: len(corners) // 2], corners[len(corners) // 2 :][::-1]
    decade = (rules[5] - rules[0]) / 5
    return (
        dot,
        low,
        high,
        lambda share: rules[0] - decade * max(np.log10(share), -6) if share else rules[0] + 6 * decade,
        caption,
    )


@pytest.mark.parametrize("falls", [False, True])
@pytest.mark.parametrize("kind", ["counted", "answered"])
def test_the_dot_of_any_state_is_in_the_band_and_as_python_has_it(browser, tmp_path, kind, falls):
    grid, rng, above = grid_of(kind, falls), np.random.default_rng(5), 0
    opened(browser, tmp_path / "D.html", grid)
    for _ in range(60):
        state = {"humidity": rng.uniform(0.4, 0.9), "length_um": rng.uniform(60, 200), "share": 1e-3}
        state = {key: float(f"{value:.4g}") for key, value in state.items()}
        stuck = grid.stuck(state)
        (x, y), low, high, height, caption = chart_at(browser, state)
        named = stuck.high if stuck.beyond < 0 else np.clip(stuck.share, stuck.low, stuck.high)
        assert y == pytest.approx(height(named), abs=0.5)
        assert low[0, 0] <= x <= low[-1, 0], "there is a band at every size"
        k = np.clip(np.searchsorted(low[:, 0], x), 1, len(low) - 1)
        assert high[k - 1 : k + 1, 1].min() - 0.5 <= y <= low[k - 1 : k + 1, 1].max() + 0.5
        above += stuck.share > 1.01 * stuck.high
        assert ("above its band" in caption) == (kind == "answered")
    assert (above > 0) == (kind == "answered"), "means above a band are among the states"


def test_the_band_is_what_the_answer_says(browser, tmp_path):
    grid = grid_of("answered", falls=False)
    opened(browser, tmp_path / "D.html", grid)
    state = grid.start
    _, low, high, height, _ = chart_at(browser, state)
    (x, _), *_ = chart_at(browser, state)
    (other, _), *_ = chart_at(browser, state | {"length_um": 110.0})
    lengths = 100 + (low[:, 0] - x) / (other - x) * 10  # the range of the chart is that of its levels
    for length, (_, lower), (_, upper) in zip(lengths[::9], low[::9], high[::9], strict=True):
        stuck = [grid.stuck(state | {"length_um": length * factor}) for factor in (1 - 1e-3, 1 + 1e-3)]
        for end, found in (("low", lower), ("high", upper)):
            ends = sorted(height(getattr(one, end)) for one in stuck)
            assert ends[0] - 0.5 <= found <= ends[1] + 0.5
