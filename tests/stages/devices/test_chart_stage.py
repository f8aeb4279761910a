from dataclasses import replace
from functools import partial
from itertools import product
from unittest.mock import patch

import numpy as np
import pytest
import xarray as xr
from beams import E_BAR, PAPER
from ground import C1, R1, RMS, UM, VECTORS, WATER, ground_dataset, settings, smooth_tips
from numpy.testing import assert_allclose

from stiction import load
from stiction.beam.energy import apparent_adhesion_energy, arrest_length
from stiction.beam.foundation import foundation_length
from stiction.chaos.model import Truncation, draw_laws
from stiction.constants import WATER_SURFACE_ENERGY
from stiction.contact import forcelaw
from stiction.contact.meniscus import meniscus_height
from stiction.devices import arcs
from stiction.devices.chart import ALLOWED
from stiction.devices.sampling import sampled_surfaces
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import curves
from stiction.stages.devices import chart, opening, sticking

THICKNESSES, GAPS = (2e-6, 2.6e-6, 3e-6, 4e-6), (10e-6, 20e-6, 30e-6, 40e-6)
#: Numbers of thicknesses and of gaps.
GRIDS = [(2, 3), (3, 2), (3, 3), (4, 3), (3, 4), (4, 4), (1, 4), (4, 1)]


def axes(count):
    """Axes with these numbers of thicknesses and gaps."""
    return THICKNESSES[: count[0]], GAPS[: count[1]]


def eq_13(thickness, gap):
    return np.array([[arrest_length(E_BAR, replace(PAPER, thickness=thickness, gap=gap))]])


def filled(count, lengths):
    """Sizes, those that were asked for, and what `chart.filled` made of them."""
    asked = []
    sizes = list(product(*axes(count)))
    found = chart.filled(*axes(count), lambda *size: asked.append(size) or lengths(*size))
    assert len(asked) == len(set(asked))
    return sizes, asked, found


@pytest.mark.parametrize("count", GRIDS)
def test_where_lengths_are_a_power_law_only_corners_and_middles_are_computed(count):
    sizes, asked, found = filled(count, eq_13)
    assert len(asked) == found.by_elements.sum() <= 7
    assert_allclose(found.lengths, [eq_13(*size) for size in sizes], rtol=1e-9)
    assert found.lengths.shape == (len(sizes), 1, 1)
    assert found.error < 1e-9


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("count", GRIDS)
def test_where_a_power_law_errs_along_an_axis_all_beams_are_computed(count, axis):
    ends = axes(count)[axis][0], axes(count)[axis][-1]

    def bent(*size):
        return eq_13(*size) * (1 + 0.04 * (ends[0] < size[axis] < ends[1]))

    sizes, _, found = filled(count, bent)
    assert_allclose(found.lengths, [bent(*size) for size in sizes], rtol=1e-9)
    assert found.by_elements.all() or count[axis] < 3
    assert found.error < 1e-9


def test_bends_along_both_axes_that_cancel_in_the_middle_are_seen():
    def bent(thickness, gap):
        return eq_13(thickness, gap) * (1 + 0.04 * (2e-6 < thickness < 4e-6)) * (1 - 0.04 * (10e-6 < gap < 40e-6))

    sizes, _, found = filled((4, 4), bent)
    assert found.by_elements.all()
    assert_allclose(found.lengths, [bent(*size) for size in sizes], rtol=1e-12)


@pytest.mark.parametrize("count", [(1, 1), (2, 1), (1, 2), (2, 2), (1, 3), (3, 1), *GRIDS])
def test_no_corner_tests_a_power_law_and_all_corners_determine_it(count):
    corner, test = (mask.reshape(count) for mask in chart.corners_and_tests(*count))
    assert (
        corner.sum()
        == min(count[0], 2) * min(count[1], 2)
        == corner[:: max(count[0] - 1, 1), :: max(count[1] - 1, 1)].sum()
    )
    assert not np.any(corner & test)
    for axis, number in enumerate(count):
        inside = np.flatnonzero(test.any(axis=1 - axis))
        assert np.any((inside > 0) & (inside < number - 1)) == (number > 2)


def test_a_power_law_that_is_used_errs_by_the_largest_of_all_shapes_and_shares():
    def nearly(thickness, gap):
        off = 2e-6 < thickness < 4e-6
        return np.hstack([eq_13(thickness, gap), eq_13(thickness, gap) * (1 + 0.005 * off)])

    sizes, asked, found = filled((4, 3), nearly)
    assert len(asked) == found.by_elements.sum() == 7
    assert found.error == pytest.approx(0.005, rel=0.02)
    assert found.error <= ALLOWED
    known = [nearly(*size) for size, computed in zip(sizes, found.by_elements, strict=True) if computed]
    assert_allclose(found.lengths[found.by_elements], known, rtol=1e-12)


@pytest.mark.parametrize("count", [(1, 1), (2, 1), (3, 1), (2, 2)])
def test_few_sizes_are_all_computed(count):
    sizes, asked, found = filled(count, eq_13)
    assert found.by_elements.all()
    assert sorted(asked) == sizes
    assert_allclose(found.lengths, [eq_13(*size) for size in sizes], rtol=1e-12)


# Stage


def computed(device, thicknesses, gaps, tips=None, shares=(1e-2,)):
    wanted = chart.Settings(2021, WATER, 0.67, device, 200, shares, thicknesses, gaps, 0.0)
    with patch.object(curves, "tip_forces", lambda *_: smooth_tips(tips)):
        return chart.compute(ground_dataset(device), wanted, None if tips is None else xr.Dataset()), wanted


def alone(device, wanted, tips=None):
    """Safe lengths of a device by shape and share, as in the stages cracks and safe_lengths."""
    model = opening.fit_chaos(VECTORS, 1.2 * VECTORS[:, 1].max(), Truncation(6, 0.001))
    address = opening.addresses(settings())
    laws = draw_laws(model, opening.LAWS, address("mesh"))
    ground = device.opening.resolved(device, laws)
    held = None if tips is None else arcs.arc_length(tips, device.beam)
    lengths = opening.arrests(device, ground, partial(draw_laws, model), wanted.beams, address)
    sampled = forcelaw.coefficients(VECTORS, 1.2 * VECTORS[:, 1].max())
    opens, on_mean = device.opening, partial(device.opening.length_on_mean, beam=device.beam)
    surfaces = sampled_surfaces(sampled, opens.contribution, on_mean, opens.uniform(ground[0], sampled))
    beams = sticking.Released(device, lengths, np.inf, foundation_length(ground[0], laws), surfaces, held)
    known = sticking.lengths_without_samples(device, *wanted.flats, np.inf)
    found = sticking.by_shape(beams, wanted, known)
    return [[one.length for one in row] for row in found.values()]


@pytest.mark.slow
def test_a_chart_has_the_safe_lengths_of_its_device_and_longer_ones_for_thicker_beams():
    found, wanted = computed(R1, (1.6 * UM, 2 * UM), (2 * UM,))
    ((expected,),) = alone(R1, wanted)
    thin, thick = found.safe_length.values[:, 0, 0, 0]
    assert thick == expected
    assert thin < thick
    assert list(found["shape"]) == [opening.MIDDLE]
    assert found.by_elements.values.tolist() == [[1], [1]]
    assert float(found.power_law_error) == 0


@pytest.mark.slow
def test_tips_of_a_chart_hold_as_those_of_the_device():
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(200))
    found, wanted = computed(C1, (2 * UM, C1.thickness), (C1.gap,), tips, (1e-2, 1e-3))
    assert_allclose(found.safe_length[1, 0], alone(C1, wanted, tips), rtol=1e-12)


@pytest.mark.slow
def test_limits_of_saturated_air_are_those_of_flooded_flats_by_shape():
    tips = np.full(200, 2e-3)
    found, _ = computed(replace(C1, gap=10 * UM), (2 * UM,), (10 * UM, 20 * UM), tips)
    beam = replace(C1.beam, thickness=2 * UM)
    flat = apparent_adhesion_energy(float(found.flooded_length.sel(gap=20 * UM, shape=opening.S_SHAPE)[0]), beam)
    assert_allclose(flat, 2 * WATER_SURFACE_ENERGY, rtol=1e-12)
    tip, whole = (found.flooded_length.sel(shape=shape) for shape in (opening.EITHER, opening.S_SHAPE))
    assert_allclose(tip / whole, np.sqrt(0.5), rtol=1e-12)  # the peel number
    bridge, asked = computed(R1, (2 * UM,), (2 * UM,))
    assert_allclose(bridge.flooded_length[0, 0], sticking.flooded_lengths(R1, *asked.flats), rtol=1e-12)


def test_a_chart_states_its_humidity_film_and_roughness():
    found, _ = computed(R1, (2 * UM,), (2 * UM,))
    assert float(found.humidity) == 0.67
    assert_allclose(found.film, meniscus_height(0.67, 300.0), rtol=1e-12)
    assert_allclose(found.rms, RMS, rtol=1e-3)


# Sizes between humidities

NODES = 0.44, 0.67, 0.95
WANTED = chart.Settings(2021, WATER, 0.55, C1, 1000, (1e-2, 1e-3), (2e-6, 2.6e-6, 4e-6), (20e-6,), 0.0)


def drawn(asked, power, here, device, ground, wanted):
    """Released beams whose lengths have a power of the thickness by humidity. Thicker beams scatter less.

    Between, the scatter is ``here`` times as large.
    """
    asked.append((device.thickness, device.gap))
    thicker = device.thickness / 2.6e-6
    median = 7e-4 * (1 - wanted.humidity) ** 0.25 * thicker ** power(wanted.humidity) * (device.gap / 2e-5) ** 0.5
    scores = 0.04 * thicker**-0.3 * np.random.default_rng(5).standard_normal(wanted.beams)
    lengths = median * np.exp(scores if wanted.humidity != WANTED.humidity else here * scores)
    return sticking.released(device, ground, lengths, np.inf)


def between(power, device=C1, here=1.0, error=0.0):
    """Chart at the humidity between, that of all sizes by finite elements, and the sizes that the first asked for.

    The power laws of the charts at other humidities have an error.
    """
    tips = 2e-3 * np.exp(0.4 * np.random.default_rng(9).standard_normal(WANTED.beams))
    asked, ground, wanted = [], ground_dataset(device), replace(WANTED, device=device)
    contact = xr.Dataset() if device.opening.has_tip else None
    with (
        patch.object(curves, "tip_forces", lambda *_: smooth_tips(tips)),
        patch.object(sticking, "release_beams", partial(drawn, asked, power, here)),
    ):
        nodes = [chart.compute(ground, replace(wanted, humidity=humidity), contact) for humidity in NODES]
        nodes = [node.assign(power_law_error=error) for node in nodes]
        true = chart.compute(ground, wanted, contact)
        asked.clear()
        return chart.compute(ground, wanted, contact, nodes), true, asked


@pytest.mark.parametrize("device", [C1, pytest.param(R1, marks=pytest.mark.slow)], ids=lambda device: device.kind)
def test_between_humidities_one_size_is_released_and_the_others_follow_within_the_stated_error(device):
    found, true, asked = between(lambda humidity: 0.81 - 0.05 * (humidity - 0.44), device)
    assert asked == [(2.6e-6, 20e-6)]
    assert found.by_elements.sum() == 1
    assert float(found.power_law_error) < ALLOWED
    for name in ("safe_length", "quantile"):
        assert_allclose(found[name], true[name], rtol=float(found.power_law_error) + 1e-3)
        assert_allclose(found[name][1], true[name][1], rtol=1e-12)


def test_the_error_between_humidities_contains_that_of_the_power_laws_at_them():
    errors = [float(between(lambda _: 0.8, error=error)[0].power_law_error) for error in (0.0, 0.003)]
    assert errors[1] - errors[0] == pytest.approx(0.003)


@pytest.mark.parametrize(("jump", "scatter"), [(0.1, 1.0), (0.0, 0.0)])
def test_all_sizes_are_released_where_their_ratios_jump_or_all_beams_stick_at_one_length(jump, scatter):
    found, true, asked = between(lambda humidity: 0.75 + jump * (humidity > 0.6), here=scatter)
    assert {thickness for thickness, _ in asked} == {*WANTED.thicknesses}
    assert found.by_elements.all()
    assert_allclose(found.safe_length, true.safe_length, rtol=1e-12)


def test_charts_between_humidities_read_those_of_all_sizes_and_dry_air_none():
    device = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    device |= {"chart": {"thicknesses_um": [2, 4], "humidities": [0.44, 0.95]}, "humidities": ["dry", 0.67]}
    plan = Plan(load({"devices": {"C1": device}}))
    nodes = [f"devices/chart/C1_rh{end}" for end in ("044", "067", "095")]
    cases = plan.devices.chart_cases("C1")
    read = {case: chart.STAGES[0].inputs(plan, At(case=case)).get("all_sizes") for case in cases}
    assert [case for case, names in read.items() if names is None] == ["C1_dry", "C1_rh044", "C1_rh067", "C1_rh095"]
    assert all(names == nodes for names in read.values() if names)
