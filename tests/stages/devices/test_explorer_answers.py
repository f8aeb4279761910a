"""The controls of a page are its answer in its own airs, whatever the device."""

from dataclasses import replace

import answered
import numpy as np
import pytest
import xarray as xr
from answers import C1, CANTILEVER, STOPPER, of_length, safe, stopper_dataset
from scipy.special import ndtri
from test_stage_stoppers import SETTINGS

from stiction.answer.data import Probability
from stiction.beam.cantilever import Beam
from stiction.contact.voltage import Capacitor, Dielectric
from stiction.devices.risk import SCORES, quantiles
from stiction.life import holding
from stiction.report.answer import words
from stiction.report.devices import explorer, voltage_views
from stiction.report.devices.levels import SHOWN
from stiction.report.format import safe_size
from stiction.stages.devices import stoppers
from stiction.stages.devices.chart import largest_error_between
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.life.answers import Name
from stiction.stages.life.beams import beam_at_voltage, least_safe
from stiction.stages.life.inputs import BeamErrors, BeamKeys

BRIDGE = CANTILEVER | {"kind": "bridge", "residual_stress_MPa": 10}
SPRING = {key: value for key, value in STOPPER.items() if key != "restoring_force_uN"}
SPRING |= {"stiffness_N_per_m": 10, "gap_um": 2}


def charted(dataset, own=2.6e-6):
    """Chart with the device itself, or a thicker one, and a thinner one."""
    sizes = {"thickness": [2e-6, own], "gap": [20e-6]}
    lengths = dataset.safe_length.expand_dims(sizes) * xr.DataArray([0.7, 1.0], dims="thickness")
    quantile = (*lengths.dims[:-1], "score"), np.full((*lengths.shape[:-1], len(SCORES)), np.nan)
    return xr.Dataset({"safe_length": lengths, "quantile": quantile, "beams": dataset.beams})


BEAMS = {
    "cantilever": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, None),
    "one air": (CANTILEVER, {0.67: safe()}, None),
    "bridge": (BRIDGE, {0.44: safe("bridge"), 0.67: safe("bridge", 500e-6)}, None),
    "length": (
        CANTILEVER | {"length_um": 600},
        {0.44: of_length(600e-6), 0.67: of_length(600e-6, longest=500e-6)},
        None,
    ),
    "chart": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, charted),
    "other sizes": (CANTILEVER, {0.44: safe(), 0.67: safe(longest=500e-6)}, lambda one: charted(one, 4e-6)),
    "dry worst": (CANTILEVER, {0.0: safe(longest=400e-6), 0.44: safe(), 0.67: safe(longest=500e-6)}, charted),
}


def faces(grid, answer, per):
    """P(stuck) with its band at every size of an answer, in each of its airs: on the controls, and in the answer.

    Sizes at which an end of the band has no level on the controls are left out: there the band is the wider one.
    """
    for air in (answer.together if one.humidity == answer.together.humidity else one for one in answer.airs):
        for k, size in enumerate(answer.sizes):
            found = replace(grid, first=None).stuck(grid.start | {"humidity": air.humidity, grid.size.key: size / per})
            ended = found.low == 0 < air.curve[1, k] or found.high == 1 > air.curve[2, k]
            assert not ended or air.curve[1, k] < 0.01 or air.curve[2, k] > 0.99
            if not found.beyond and not ended and 1e-6 < air.curve[0, k] < 1 - 1e-6:
                yield (found.share, found.low, found.high), air.curve[:, k]


def deviations(pairs):
    """Largest deviations of normal scores of fractions, those of all three layers within what is shown."""
    scores = np.clip(ndtri(np.array(list(pairs))), -5, 5)
    return np.abs(scores[:, 0] - scores[:, 1]).max(axis=0)


@pytest.mark.parametrize("name", BEAMS)
def test_the_controls_of_a_beam_are_its_answer_in_its_own_airs(name):
    section, lengths, chart = BEAMS[name]
    charts = {humidity: chart(one) for humidity, one in lengths.items() if humidity} if chart else {}
    length = 1e-6 * section.get("length_um", np.nan)
    answer = answered.of_beam(lengths, length, kind=section["kind"])
    view, *others = explorer.views_of_beam("C1", section, lengths, charts, answer)
    assert len(others) == (name in ("other sizes", "dry worst"))
    grid = view.grid
    assert grid.safe_size(grid.start) == pytest.approx(1e6 * answer.build, rel=1e-6)
    for one in answer.airs if answer.together.humidity else ():
        if one.humidity not in (0, answer.together.humidity):
            build = grid.safe_size(grid.start | {"humidity": one.humidity})
            assert build == pytest.approx(1e6 * one.build, rel=1e-6)
    assert deviations(faces(grid, answer, 1e-6)).max() < np.diff(SHOWN).max()
    if name == "length":
        assert says(grid.stuck(grid.start)) == words.stuck_in_words(answer.stuck)
    else:
        assert grid.start["length_um"] == float(words.to_build_beside(answer, []).removesuffix(" µm"))


def says(stuck):
    """P(stuck) of the controls in the words of an answer."""
    return words.stuck_in_words(Probability(stuck.share, stuck.low, stuck.high, none_seen=stuck.beyond < 0))


@pytest.mark.parametrize("touchdowns", [1, 300])
@pytest.mark.parametrize("length", [250e-6, 278e-6, 281e-6, 300e-6, 350e-6, 415e-6])
def test_the_controls_begin_with_the_words_of_the_answer(length, touchdowns):
    lengths = {0.44: safe(), 0.67: of_length(length)}  # they stick from 280 µm on
    answer = answered.of_beam(lengths, length, touchdowns)
    grid = explorer.views_of_beam("C1", CANTILEVER | {"length_um": 1e6 * length}, lengths, {}, answer)[0].grid
    assert says(grid.stuck(grid.start)) == words.stuck_in_words(answer.stuck)
    assert answer.stuck.none_seen == (length < 280e-6)


@pytest.mark.parametrize("touchdowns", [1, 300])
@pytest.mark.parametrize("name", ["cantilever", "one air", "bridge"])
def test_at_the_size_to_build_the_controls_say_the_allowed_fraction(name, touchdowns):
    section, lengths, _ = BEAMS[name]
    answer = answered.of_beam(lengths, touchdowns=touchdowns)
    grid = explorer.views_of_beam("C1", section, lengths, {}, answer)[0].grid
    at, longer = (grid.stuck(grid.start | {"length_um": factor * 1e6 * answer.build}) for factor in (1, 1.02))
    assert at.beyond == -1
    assert at.high == pytest.approx(answer.share, rel=1e-6)
    assert says(at).startswith(f"at most {words.percent(answer.share)}")
    assert longer.high > 1.01 * answer.share  # control


def test_at_other_sizes_the_levels_keep_their_ratio_to_the_simulated_ones():
    lengths = {0.67: safe()}
    answer = answered.of_beam(lengths, touchdowns=100)
    chart = charted(lengths[0.67])
    scored = quantiles(lengths[0.67].sticking_length.isel(shape=-1).values)
    thinner = xr.DataArray([0.5, 1.0], dims="thickness") * xr.DataArray(scored, dims="score")
    chart["quantile"] = (0 * chart["quantile"].fillna(0) + thinner).transpose(*chart["quantile"].dims)
    grid = explorer.beam_view("C1", CANTILEVER, lengths, {0.67: chart}, answer).grid
    for length in (250.0, 290.0, 330.0):
        own = replace(grid, first=None).stuck(grid.start | {"length_um": length})
        thin = replace(grid, first=None).stuck(grid.start | {"length_um": length / 2, "thickness_um": 2.0})
        assert (thin.share, thin.low, thin.high) == pytest.approx((own.share, own.low, own.high), rel=1e-6)


@pytest.mark.parametrize("peak", [0.7, 1.0])
@pytest.mark.parametrize(("section", "per"), [(STOPPER, 1e-6), (SPRING, 2e-6)])
def test_the_controls_of_a_stopper_are_its_answer_in_its_own_airs(section, per, peak):
    stopper = stopper_dataset(peak)
    answer = answered.of_stopper(stopper)
    view, *others = explorer.views_of_stopper(section, stopper, answer)
    assert not others
    assert view.grid.safe_size(view.grid.start) == pytest.approx(answer.build / per, rel=1e-6)
    assert says(view.grid.stuck(view.grid.start)) == words.stuck_in_words(answer.stuck)
    assert deviations(faces(view.grid, answer, per)).max() < np.diff(SHOWN).max()


@pytest.mark.parametrize("restoring", [3e-6, 5e-6, 9e-6])
def test_the_controls_begin_with_the_words_of_the_answer_where_no_device_begins_to_stick(restoring):
    forces = 1e-6 * np.append([2, 4], np.linspace(10, 90, 78))  # none is between 4 and 10 µN
    settings = replace(SETTINGS, restoring_force=restoring, humidities=(0.67,))
    stopper = stoppers.layout(settings, forces[None], np.array([0.67]), forces[None])
    answer = answered.of_stopper(stopper)
    grid = explorer.views_of_stopper(STOPPER | {"restoring_force_uN": 1e6 * restoring}, stopper, answer)[0].grid
    assert np.isnan(answer.build)
    assert says(grid.stuck(grid.start)) == words.stuck_in_words(answer.stuck)


def test_the_controls_of_a_stopper_whose_worst_air_is_dry_begin_there():
    forces = 1e-6 * np.exp(0.2 * np.random.default_rng(4).normal(size=4000))
    settings = replace(SETTINGS, restoring_force=1e-6, humidities=(0.67, 0.0, 0.88))
    axis, chosen = np.linspace(0.5, 0.9, 5), np.stack([2 * forces, 3 * forces, forces])
    stopper = stoppers.layout(settings, chosen, np.append(0.0, axis), np.append(3, 2.5 - axis)[:, None] * forces)
    section = STOPPER | {"humidities": [0.67, 0.0, 0.88], "restoring_force_uN": 1}
    answer = answered.of_stopper(stopper)
    alone, over = explorer.views_of_stopper(section, stopper, answer)
    assert alone.grid.safe_size(alone.grid.start) == pytest.approx(1e6 * answer.build, rel=1e-6)
    assert says(alone.grid.stuck(alone.grid.start)) == words.stuck_in_words(answer.stuck)
    assert (alone.grid.start["humidity"], over.grid.axes[0].values[0]) == (0.0, 0.5)
    assert over.grid.safe_size(over.grid.start) < 0.9e6 * answer.build


def ragged():
    """Charts of a device at nine humidities, whose lengths scatter by a percent."""
    factors = 1 + 0.01 * np.random.default_rng(6).normal(size=9)
    return {round(0.4 + 0.05 * k, 2): charted(safe(longest=600e-6 * one)) for k, one in enumerate(factors)}


def test_the_band_of_a_small_chart_is_that_of_the_figure():
    charts, answer = ragged(), answered.of_beam({0.6: safe()})
    grid = explorer.beam_view("C1", CANTILEVER, {0.6: safe()}, charts, answer).grid
    of_axis = xr.concat([one.assign_coords(relative_humidity=rh) for rh, one in charts.items()], "relative_humidity")
    for thickness in (2.0, 2.6):
        for share in grid.share.values:
            one = of_axis.isel(shape=[-1]).sel(share=[share], thickness=[1e-6 * thickness], method="nearest")
            found = grid.noise_at(grid.start | {"thickness_um": thickness, "share": share})
            assert found == pytest.approx(largest_error_between(one), rel=1e-9)
            assert 0.002 < found < 0.05
    few = explorer.beam_view(
        "C1", CANTILEVER, {0.6: safe()}, dict(list(charts.items())[:4]), answered.of_beam({0.6: safe()})
    ).grid
    assert np.isnan(few.noise_at(few.start))


def test_a_cantilever_at_a_voltage_has_the_closed_form_of_flats_and_its_bound_of_life():
    section = CANTILEVER | {"voltage_V": 5, "offset_V": -0.5, "dielectric": {"thickness_nm": 100, "permittivity": 4.0}}
    lengths = {0.44: safe(), 0.67: safe(longest=500e-6)}
    grid = voltage_views.beam_view("C1", section | {"young_modulus_GPa": 164}, lengths).grid
    beam, oxide = Beam(1e-3, 30e-6, 2.6e-6, 164e9, 20e-6, 1), Dielectric(100e-9, 4.0)
    rng = np.random.default_rng(8)
    for volts, humidity, rank in zip(
        rng.uniform(0, 99.5, 50), [0.44, 0.67] * 25, rng.uniform(0.01, 0.99, 50), strict=True
    ):
        energy = holding.energy_of_voltage(Capacitor(oxide, volts, 0.5), 20e-6)
        state = grid.start | {"voltage_V": volts, "humidity": humidity}
        least = float(lengths[humidity].safe_length.sel(share=chosen_share(lengths[humidity])).min())
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
    of = BeamKeys(
        device=C1, density=2330.0, liquids={}, uncertainty=BeamErrors(), voltage=5.0, offset=-0.5, dielectric=oxide
    )
    answers = {one.name: one for one in beam_at_voltage(of, min(map(least_of, lengths.values())), None)}
    assert grid.safe_size(grid.start) == pytest.approx(1e6 * answers[Name.AT_VOLTAGE].low, rel=1e-3)


def least_of(dataset):
    """Safe length of the middle one of the shares, as in stage life."""
    return least_safe(dataset, chosen_share(dataset))


def test_a_view_of_the_simulation_alone_names_the_size_to_build_beside_its_limits():
    section = CANTILEVER | {"voltage_V": 5, "dielectric": {"thickness_nm": 100, "permittivity": 4.0}}
    lengths = {0.67: safe()}
    view = voltage_views.beam_view("C1", section | {"young_modulus_GPa": 164}, lengths)
    answer = answered.of_beam(lengths, touchdowns=100)
    beside = explorer.beside(view, answer)
    assert view.words["safe"] in beside.words["safe"]
    assert safe_size(answer.build, answer.sought) in beside.words["safe"]
    assert beside.grid is view.grid
    assert explorer.beside(view, replace(answer, forbidden=("x",))) is view
