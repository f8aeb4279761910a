"""The controls of a page begin with the number of its answer, whatever the device."""

import re

import numpy as np
import pytest
import xarray as xr
from test_pages import CANTILEVER, STOPPER, of_length, safe
from test_tables_budget import BUDGETS, budget_dataset, stopper_dataset

from stiction.devices.risk import SCORES
from stiction.report.devices import explorer, first_screen

BRIDGE = CANTILEVER | {"kind": "bridge", "residual_stress_MPa": 10}
SPRING = {key: value for key, value in STOPPER.items() if key != "restoring_force_uN"}
SPRING |= {"stiffness_N_per_m": 10, "gap_um": 2}
#: The most uncertain humidity is not the worst one.
OF_BEAMS = {(0.44,): budget_dataset(2.0), (0.67,): budget_dataset(0.5)}
OF_TIPS = {(*humidity, "tip"): budget for humidity, budget in OF_BEAMS.items()} | {(0.44,): budget_dataset(9.0)}


def charted(dataset):
    """Chart with the device itself and a thinner one."""
    sizes = {"thickness": [2e-6, 2.6e-6], "gap": [20e-6]}
    lengths = dataset.safe_length.expand_dims(sizes) * xr.DataArray([0.7, 1.0], dims="thickness")
    quantile = (*lengths.dims[:-1], "score"), np.full((*lengths.shape[:-1], len(SCORES)), np.nan)
    return xr.Dataset({"safe_length": lengths, "quantile": quantile, "beams": dataset.beams})


BEAMS = {
    "cantilever": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, OF_TIPS, False),
    "exact": (CANTILEVER, {0.67: safe()}, {}, False),
    "bridge": (BRIDGE, {0.44: safe("bridge"), 0.67: safe("bridge", 500e-6)}, OF_BEAMS, False),
    "length": (
        CANTILEVER | {"length_um": 600},
        {0.44: of_length(600e-6), 0.67: of_length(600e-6, longest=500e-6)},
        OF_TIPS,
        False,
    ),
    "chart": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, OF_TIPS, True),
}


@pytest.mark.parametrize("name", BEAMS)
def test_the_controls_of_a_beam_begin_with_its_length_to_build(name):
    section, lengths, budgets, has_chart = BEAMS[name]
    charts = {humidity: charted(one) for humidity, one in lengths.items()} if has_chart else {}
    view = explorer.of_beam("C1", section, lengths, charts, budgets)
    answer = first_screen.beam_screen(section, lengths, budgets, []).answer
    total = view.margin.total if view.margin else 0.0
    assert bool(total) == bool(budgets)
    build = view.grid.safe_size(view.grid.start) * np.exp(-2 * total)
    assert f"{build:.0f}" == re.match(r"Safe up to (\d+) µm", answer)[1]
    if total:
        assert (view.margin.low, view.margin.high) == (0.44, 0.67)


@pytest.mark.parametrize("budgets", [{}, {(0.67,): BUDGETS["S1", 0.67]}])
@pytest.mark.parametrize("peak", [0.7, 1.0])
@pytest.mark.parametrize(("section", "per"), [(STOPPER, 1.0), (SPRING, 2.0)])
def test_the_controls_of_a_stopper_begin_with_the_force_that_it_needs(section, per, peak, budgets):
    stopper = stopper_dataset(peak)
    view = explorer.of_stopper(section, stopper, budgets)
    screen = first_screen.stopper_screen(section, stopper, budgets, [])
    needed = re.match(r"At least (\S+) µN needed", screen.answer)[1]
    assert f"{per * view.grid.safe_size(view.grid.start):.3g}" == needed
    assert "build" not in view.words, "the answer has no margin either"
    assert "No margin for the measurements is added." in screen.basis
    assert bool(view.margin) == bool(budgets)
