"""The controls of a page begin with the number of its answer, whatever the device."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from answers import (
    BUDGETS,
    C1,
    CANTILEVER,
    STOPPER,
    beam_answer,
    budget_dataset,
    of_length,
    safe,
    screen_of,
    stopper_answer,
    stopper_dataset,
)
from test_stage_stoppers import SETTINGS

from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.devices.risk import SCORES
from stiction.life import holding
from stiction.report.devices import explorer, sentences, voltage_views
from stiction.report.format import fraction_with_band
from stiction.stages.devices import stoppers
from stiction.stages.devices.chart import largest_error_between
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import AT_VOLTAGE
from stiction.stages.life.inputs import Errors, OfBeam
from stiction.stages.life.lengths import least_safe
from stiction.stages.life.voltage import beam_at_voltage

BRIDGE = CANTILEVER | {"kind": "bridge", "residual_stress_MPa": 10}
SPRING = {key: value for key, value in STOPPER.items() if key != "restoring_force_uN"}
SPRING |= {"stiffness_N_per_m": 10, "gap_um": 2}
#: The most uncertain humidity is not the worst one.
OF_BEAMS = {(0.44,): budget_dataset(2.0), (0.67,): budget_dataset(0.5)}
OF_TIPS = {(*humidity, "tip"): budget for humidity, budget in OF_BEAMS.items()} | {(0.44,): budget_dataset(9.0)}


def charted(dataset, own=2.6e-6):
    """Chart with the device itself, or a thicker one, and a thinner one."""
    sizes = {"thickness": [2e-6, own], "gap": [20e-6]}
    lengths = dataset.safe_length.expand_dims(sizes) * xr.DataArray([0.7, 1.0], dims="thickness")
    quantile = (*lengths.dims[:-1], "score"), np.full((*lengths.shape[:-1], len(SCORES)), np.nan)
    return xr.Dataset({"safe_length": lengths, "quantile": quantile, "beams": dataset.beams})


BEAMS = {
    "cantilever": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, OF_TIPS, None),
    "exact": (CANTILEVER, {0.67: safe()}, {}, None),
    "bridge": (BRIDGE, {0.44: safe("bridge"), 0.67: safe("bridge", 500e-6)}, OF_BEAMS, None),
    "length": (
        CANTILEVER | {"length_um": 600},
        {0.44: of_length(600e-6), 0.67: of_length(600e-6, longest=500e-6)},
        OF_TIPS,
        None,
    ),
    "chart": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, OF_TIPS, charted),
    "other sizes": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, OF_TIPS, lambda one: charted(one, 4e-6)),
    "dry worst": (CANTILEVER, {0.0: safe(longest=400e-6), 0.44: safe(), 0.67: safe(longest=500e-6)}, OF_TIPS, charted),
}


def stated(answer):
    """P(stuck) with its band in an answer, as text."""
    return re.findall(r"(\S+ % \(.* %\)|at (?:most|least) \S+ %) stick", answer)


def shown(grid):
    """P(stuck) with its band at the beginning of the controls, as text."""
    stuck = grid.stuck(grid.start)
    return [fraction_with_band(stuck.share, stuck.low, stuck.high, " %")]


@pytest.mark.parametrize("name", BEAMS)
def test_the_controls_of_a_beam_begin_with_its_length_to_build(name):
    section, lengths, budgets, chart = BEAMS[name]
    charts = {humidity: chart(one) for humidity, one in lengths.items() if humidity} if chart else {}
    view, *others = explorer.views_of_beam("C1", section, lengths, charts, budgets)
    assert len(others) == (name in ("other sizes", "dry worst"))
    answer = screen_of(beam_answer(section, lengths, budgets), section).answer
    total = view.margin.total if view.margin else 0.0
    assert bool(total) == bool(budgets)
    build = view.grid.safe_size(view.grid.start) * np.exp(-2 * total)
    assert total <= view.words["largest"] == sentences.LARGEST
    assert f"{build:.0f}" == re.match(r"Safe up to (\d+) µm", answer)[1]
    assert stated(answer) == ([] if name != "length" else shown(view.grid))
    if total:
        assert (view.margin.low, view.margin.high) == (0.44, 0.67)


@pytest.mark.parametrize("budgets", [{}, {(0.67,): BUDGETS["S1", 0.67]}])
@pytest.mark.parametrize("peak", [0.7, 1.0])
@pytest.mark.parametrize(("section", "per"), [(STOPPER, 1.0), (SPRING, 2.0)])
def test_the_controls_of_a_stopper_begin_with_the_force_that_it_needs(section, per, peak, budgets):
    stopper = stopper_dataset(peak)
    view, *others = explorer.views_of_stopper(section, stopper, budgets)
    assert not others
    screen = screen_of(stopper_answer(stopper, budgets), section)
    needed = re.match(r"At least (\S+) µN needed", screen.answer)[1]
    added = np.exp(2 * view.margin.total) if budgets else 1.0
    assert f"{added * per * view.grid.safe_size(view.grid.start):.3g}" == needed
    assert stated(screen.answer) == shown(view.grid)
    assert view.words["build"] == "at least", "the answer has the same margin"
    assert any("dded for the measurements" in text for text in screen.basis)
    assert bool(view.margin) == bool(budgets)


def test_the_controls_of_a_stopper_whose_worst_air_is_dry_begin_there():
    forces = 1e-6 * np.exp(0.2 * np.random.default_rng(4).normal(size=4000))
    settings = replace(SETTINGS, restoring_force=1e-6, humidities=(0.67, 0.0, 0.88))
    axis, chosen = np.linspace(0.5, 0.9, 5), np.stack([2 * forces, 3 * forces, forces])
    stopper = stoppers.layout(settings, chosen, np.append(0.0, axis), np.append(3, 2.5 - axis)[:, None] * forces)
    section = STOPPER | {"humidities": [0.67, 0.0, 0.88]}
    alone, over = explorer.views_of_stopper(section, stopper, {})
    needed = re.match(r"At least (\S+) µN needed", screen_of(stopper_answer(stopper, {}), section).answer)[1]
    assert f"{alone.grid.safe_size(alone.grid.start):.3g}" == needed
    assert stated(screen_of(stopper_answer(stopper, {}), section).answer) == shown(alone.grid)
    assert (alone.grid.start["humidity"], over.grid.axes[0].values[0]) == (0.0, 0.5)
    assert f"{over.grid.safe_size(over.grid.start):.3g}" != needed


def ragged():
    """Charts of a device at nine humidities, whose lengths scatter by a percent."""
    factors = 1 + 0.01 * np.random.default_rng(6).normal(size=9)
    return {round(0.4 + 0.05 * k, 2): charted(safe(longest=600e-6 * one)) for k, one in enumerate(factors)}


def test_the_band_of_a_small_chart_is_that_of_the_figure():
    charts = ragged()
    grid = explorer.beam_view("C1", CANTILEVER, {0.6: safe()}, charts, {}).grid
    of_axis = xr.concat([one.assign_coords(relative_humidity=rh) for rh, one in charts.items()], "relative_humidity")
    for thickness in (2.0, 2.6):
        for share in grid.share.values:
            one = of_axis.isel(shape=[-1]).sel(share=[share], thickness=[1e-6 * thickness], method="nearest")
            found = grid.noise_at(grid.start | {"thickness_um": thickness, "share": share})
            assert found == pytest.approx(largest_error_between(one), rel=1e-9)
            assert 0.002 < found < 0.05
    few = explorer.beam_view("C1", CANTILEVER, {0.6: safe()}, dict(list(charts.items())[:4]), {}).grid
    assert np.isnan(few.noise_at(few.start))


def test_a_cantilever_at_a_voltage_has_the_closed_form_of_flats_and_its_bound_of_life():
    section = CANTILEVER | {"voltage_V": 5, "offset_V": -0.5, "dielectric": {"thickness_nm": 100, "permittivity": 4.0}}
    lengths = {0.44: safe(), 0.67: safe(longest=500e-6)}
    grid = voltage_views.beam_view("C1", section | {"young_modulus_GPa": 164}, lengths, {}).grid
    beam, oxide = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1), Dielectric(100e-9, 4.0)
    rng = np.random.default_rng(8)
    for volts, humidity, rank in zip(
        rng.uniform(0, 99.5, 50), [0.44, 0.67] * 25, rng.uniform(0.01, 0.99, 50), strict=True
    ):
        energy = holding.energy_of_voltage(Capacitor(oxide, volts, 0.5), 20e-6)
        state = grid.start | {"voltage_V": volts, "humidity": humidity}
        least = float(sentences.safe_lengths_of(lengths[humidity]).min())
        expected = holding.tip_length_at_voltage(least, beam, energy)
        assert grid.safe_size(state) == pytest.approx(1e6 * expected, rel=1e-3)
        sticks = 0.7 * np.linspace(2 / 3, 1, 400) * (600e-6 if humidity == 0.44 else 500e-6)
        shorter = holding.tip_length_at_voltage(sticks, beam, energy)
        length = np.quantile(shorter, rank)
        assert grid.stuck(state | {"length_um": 1e6 * length}).share == pytest.approx(
            np.mean(shorter < length), abs=0.02
        )
    with pytest.raises(ValueError, match="beyond 99.5 V the dielectric breaks down"):
        grid.safe_size(grid.start | {"voltage_V": 100.0})
    of = OfBeam(device=C1, density=2330.0, liquids={}, uncertainty=Errors(), voltage=5.0, offset=-0.5, dielectric=oxide)
    answers = {one.name: one for one in beam_at_voltage(of, min(map(least_of, lengths.values())), None)}
    assert grid.safe_size(grid.start) == pytest.approx(1e6 * answers[AT_VOLTAGE].low, rel=1e-3)


def least_of(dataset):
    """Safe length of the middle one of the shares, as in stage life."""
    return least_safe(dataset, chosen_share(dataset))
