"""Stage test_beams on budgets of analytic lengths: what a device shares with its test beams, known truth, tables."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import ndtr, ndtri
from vectors import sampled_vectors

from stiction.beam.energy import arrest_length
from stiction.beam.foundation import foundation_length
from stiction.contact import forcelaw
from stiction.contact.air import KINDS_OF_AIR
from stiction.contact.environment import Gaps, Water
from stiction.devices import arcs
from stiction.devices.inference import FACTOR, SCORES, SLOPE, DiscrepancyOfModel, expected_share, lognormal
from stiction.report import style
from stiction.report.devices import warnings_page
from stiction.report.limits import pages
from stiction.report.limits.words import texts
from stiction.report.style import on_a_page
from stiction.report.test_beams import figures as figures_test_beams
from stiction.report.test_beams import tables as tables_test_beams
from stiction.run import storage
from stiction.run.markdown import plain
from stiction.stages.contact import curves
from stiction.stages.devices import device_warnings
from stiction.stages.devices.opening import ARC, EITHER, FORCE, MIDDLE, S_SHAPE, DesignedBeam
from stiction.stages.test_beams import inference
from stiction.stages.test_beams.inference import CrackLengths, Settings, StuckCounts
from stiction.stages.test_beams.rerun import with_reruns

UM = 1e-6
DEVICE = DesignedBeam("cantilever", "b", 2.6 * UM, 20 * UM, 30 * UM, 164e9, 1.5 * UM)
ARRAY = replace(DEVICE, thickness=2 * UM, gap=15 * UM)
HUMIDITIES = (0.44, 0.67, 0.92)
#: Energies [J m⁻²], and standard deviations of ln of what they depend on: the rms of the surface and Young's modulus.
ENERGY = {0.44: 1.5e-3, 0.67: 7e-3, 0.92: 75e-3}
DEVIATIONS = {"rms of B2": 0.05, "Young's modulus": 0.03, "thickness": 0.02, "gap": 0.015}
#: d ln energy / d ln rms.
POWER = {0.44: -5.6, 0.67: -4.0, 0.92: -1.2}
STATED = DiscrepancyOfModel(0.1, 0.3, 0.05)
SCATTER, BEAMS = 0.05, 12


def length(beam, humidity, rms=0.0, modulus=0.0, thickness=0.0, gap=0.0):
    """Crack length of Eq. (13) for errors of logarithms of the inputs [m]."""
    changed = replace(
        beam,
        thickness=beam.thickness * np.exp(thickness),
        gap=beam.gap * np.exp(gap),
        young_modulus=beam.young_modulus * np.exp(modulus),
    )
    return float(arrest_length(ENERGY[humidity] * np.exp(POWER[humidity] * rms), changed.beam))


def budget(beam, humidity, response=S_SHAPE):
    """Dataset of stage budget of these lengths."""
    names = list(DEVIATIONS)
    slopes = [-POWER[humidity] / 4, 1 / 4, 3 / 4, 1 / 2]
    centre = length(beam, humidity) / (np.sqrt(2) if response == ARC else 1)
    return xr.Dataset(
        {
            "slope": ("input", slopes),
            "covariance": (("input", "other"), np.diag(list(DEVIATIONS.values())) ** 2),
            "centre": ((), centre, {"response": response, "share": 0.001, "units": "m"}),
            "scatter": ((), SCATTER),
        },
        coords={"input": names, "other": names},
    )


def budgets():
    """Datasets of the device and of its test beams."""
    of_device = {("C1", rh): budget(DEVICE, rh) for rh in HUMIDITIES}
    return of_device | {("C1", rh, "tip"): budget(DEVICE, rh, ARC) for rh in HUMIDITIES}


def safe_lengths():
    values = xr.DataArray([[600 * UM], [250 * UM]], coords={"shape": [S_SHAPE, EITHER], "share": [0.001]})
    axis = np.linspace(200, 900, 351) * UM
    stuck = [ndtr(np.log(axis / length) / SCATTER - 3.09) for length in (600 * UM, 250 * UM)]
    risk = xr.DataArray(stuck, coords={"shape": [S_SHAPE, EITHER], "length": axis})
    return dict.fromkeys(HUMIDITIES, xr.Dataset({"safe_length": values, "estimate": values, "stuck": risk}))


def computed(
    means, stds=None, beams=BEAMS, humidities=HUMIDITIES, stated=STATED, array=ARRAY, names=("arrayA",), stuck=None
):
    """Dataset of stage test_beams for measured means [m] at some humidities of the arrays, and counts."""
    stds = SCATTER * np.array(means) if stds is None else stds
    lengths = CrackLengths(1500 * UM, tuple(humidities), tuple(means), tuple(stds), (beams,) * len(means))
    slopes = {(name, rh): budget(array, rh) for name in names for rh in humidities}
    if stuck:
        slopes |= {(name, rh, "tip"): budget(array, rh, ARC) for name in names for rh in stuck.humidity}
    found = [dict.fromkeys(names, data) if data else {} for data in (lengths if len(means) else None, stuck)]
    settings = Settings(0, stated, dict.fromkeys(names, array), *found, DEVICE)
    contacts = {(name, kind): kind for name in names for kind in KINDS_OF_AIR}
    found = inference.compute(budgets(), slopes, safe_lengths(), contacts, contacts, settings)
    return with_reruns(found)


def as_computed(factor=1.0, humidities=HUMIDITIES):
    return [factor * length(ARRAY, rh) for rh in humidities]


def of(found, result):
    return found.sel(result=f"C1, RH {result}")


def test_measured_lengths_equal_to_the_computed_ones_move_nothing_and_narrow_the_length():
    found = computed(as_computed())
    assert_allclose(found["shift"], 0, atol=1e-12)
    assert_allclose(found.updated_safe, found.safe, rtol=1e-12)
    assert np.all(found.result_after < found.result_before)
    assert float(of(found, 0.67).result_after) < 0.6 * float(of(found, 0.67).result_before)
    assert float(found.p_value) > 0.99
    assert_allclose(found.datum_measured_error, SCATTER / np.sqrt(BEAMS), rtol=1e-12)


def test_dimensions_belong_to_device_and_array_and_all_other_inputs_are_shared():
    names = list(computed(as_computed()).input.values)
    sizes = ["thickness of arrayA", "gap of arrayA", "thickness of C1", "gap of C1"]
    assert sorted(names) == sorted([*sizes, "rms of B2", "Young's modulus", FACTOR, SLOPE])
    found = computed(as_computed(1.2)).sel(input=sizes)
    assert np.all(found["shift"][:2] > 0)
    assert_allclose(found["shift"][2:], 0, atol=1e-15)


def test_the_prior_of_the_length_is_that_of_its_budget_and_of_the_stated_discrepancy():
    found = of(computed(as_computed()), 0.67)
    slopes = np.array([-POWER[0.67] / 4, 1 / 4, 3 / 4, 1 / 2])
    alone = np.linalg.norm(slopes * list(DEVIATIONS.values()))
    assert_allclose(found.result_of_inputs, alone, rtol=1e-12)
    # u of a length of Eq. (13) is -1/4 of ln of the energy.
    reduced = (np.mean(np.log(list(ENERGY.values()))) - np.log(ENERGY[0.67])) / 4
    assert_allclose(found.result_before, np.sqrt(alone**2 + 0.1**2 + (0.3 * reduced) ** 2 + 0.05**2), rtol=1e-9)


@pytest.mark.usefixtures("shapes")
def test_tips_follow_the_inputs_and_are_uncertain_as_their_budget_says_and_by_what_the_model_errs_in_cracks():
    found = computed(as_computed(1.3))
    tip, crack = of(found, "0.67, arc"), of(found, 0.67)
    of_model = np.sqrt(crack.result_before**2 - crack.result_of_inputs**2)
    assert_allclose(tip.result_before, np.hypot(tip.result_of_inputs, 4 / 3 * of_model), rtol=1e-9)
    factors = (found.updated_safe / found.safe).sel(humidity=0.67, share=0.001)
    assert_allclose(factors.sel(shape=EITHER), np.exp(tip.result_shift), rtol=1e-12)
    assert_allclose(factors.sel(shape=S_SHAPE), np.exp(crack.result_shift), rtol=1e-12)
    assert 1 < float(factors.sel(shape=EITHER)) < float(factors.sel(shape=S_SHAPE))


def test_tips_adhere_as_much_more_as_cracks_show_that_no_input_explains():
    exact, adhesion = dict.fromkeys(DEVIATIONS, 0.0), 2.4
    model = DiscrepancyOfModel(10.0, 1e-6, 1e-6)
    with pytest.MonkeyPatch.context() as patch:
        for name, value in exact.items():
            patch.setitem(DEVIATIONS, name, value)
        more, less = (computed(as_computed(power**-0.25), stated=model) for power in (adhesion, 1 / adhesion))
    moved = (more.updated_safe / more.safe).isel(share=0)
    assert_allclose(moved.sel(shape=S_SHAPE), adhesion**-0.25, rtol=1e-4)
    assert_allclose(moved.sel(shape=EITHER), adhesion ** (-1 / 3), rtol=1e-4)
    assert_allclose((less.updated_safe / less.safe).sel(shape=EITHER), 1, rtol=1e-6)
    assert "up to 2.4 times the adhesion that the inputs explain: tips" in tables_test_beams.notes(more)
    assert "no more adhesion than the inputs explain" in tables_test_beams.notes(less)


def test_two_equal_arrays_that_share_their_dimensions_are_one_of_twice_as_many_beams():
    exact = {"thickness": 0.0, "gap": 0.0}
    with pytest.MonkeyPatch.context() as patch:
        for name, value in exact.items():
            patch.setitem(DEVIATIONS, name, value)
        stated = replace(STATED, rest=0.0)
        two = computed(as_computed(1.1), names=("arrayA", "arrayB"), stated=stated)
        one = computed(as_computed(1.1), beams=2 * BEAMS, stated=stated)
    for name in ("result_shift", "result_after"):
        assert_allclose(two[name], one[name], rtol=1e-9, atol=1e-15)


def test_neither_the_order_of_the_humidities_nor_that_of_the_arrays_matters():
    one, other = computed(as_computed(1.1)), computed(as_computed(1.1)[::-1], humidities=HUMIDITIES[::-1])
    for name in ("result_shift", "result_after", "p_value"):
        assert_allclose(one[name], other[name], rtol=1e-9, atol=1e-15)


def drawn_lengths(rng, beams, stated=STATED):
    """Crack lengths and lengths that tips hold of beams with drawn inputs and model, and true lengths of the device.

    All tips err by 4/3 of what the cracks of the same beams do.
    """
    common = {
        key: DEVIATIONS[name] * rng.normal() for key, name in (("rms", "rms of B2"), ("modulus", "Young's modulus"))
    }
    sizes = [{name: DEVIATIONS[name] * rng.normal() for name in ("thickness", "gap")} for _ in range(2)]
    factor, slope = stated.factor * rng.normal(), stated.slope * rng.normal()
    middle = np.mean(np.log(list(ENERGY.values())))

    def exact(beam, own):
        return np.array([length(beam, rh, **common, **own) for rh in HUMIDITIES])

    def true(beam, own):
        errors = [factor + slope * (middle - np.log(ENERGY[rh])) / 4 + stated.rest * rng.normal() for rh in HUMIDITIES]
        return exact(beam, own) * np.exp(errors)

    def tips_of(cracks, beam, own):
        return exact(beam, own) / np.sqrt(2) * (cracks / exact(beam, own)) ** (4 / 3)

    of_array, of_device = true(ARRAY, sizes[0]), true(DEVICE, sizes[1])
    cracks, tips = (
        lengths * np.exp(SCATTER * rng.normal(size=(beams, len(HUMIDITIES))))
        for lengths in (of_array, tips_of(of_array, ARRAY, sizes[0]))
    )
    return cracks, tips, np.concatenate([of_device, tips_of(of_device, DEVICE, sizes[1])])


def drawn(rng, stated=STATED):
    """Means and standard deviations of measured crack lengths, and the true mean crack lengths of the device."""
    cracks, _, truth = drawn_lengths(rng, BEAMS, stated)
    return cracks.mean(axis=0), cracks.std(axis=0, ddof=1), truth[: len(HUMIDITIES)]


def scores(stated, repeats=100):
    """Errors of the predicted lengths of the device, in their stated deviations."""
    found = []
    for k in range(repeats):
        means, stds, truth = drawn(np.random.default_rng(k))
        after = computed(means, stds, stated=stated).isel(result=slice(3))
        found.append((np.log(truth / after.centre.values) - after.result_shift.values) / after.result_after.values)
    return np.array(found)


@pytest.fixture
def mean_lengths_alone(monkeypatch):
    """Nothing is computed of safe lengths and of further beams."""
    monkeypatch.setattr(inference, "with_lengths", lambda found, _: found)
    monkeypatch.setattr(inference, "further_dataset", lambda *_: xr.Dataset())


@pytest.mark.slow
@pytest.mark.usefixtures("mean_lengths_alone")
def test_the_true_lengths_of_the_device_are_inside_the_stated_intervals():
    found = np.abs(scores(STATED))
    assert abs(np.mean(found < 1) - 0.68) <= 0.10
    assert abs(np.mean(found < 1.96) - 0.95) <= 0.04


@pytest.mark.usefixtures("mean_lengths_alone")
def test_without_a_discrepancy_of_the_model_they_are_not():
    found = np.abs(scores(DiscrepancyOfModel(0.0, 0.0, 0.0), repeats=30))
    assert np.mean(found < 1) < 0.4
    assert np.mean(found < 1.96) < 0.7


@pytest.mark.slow
@pytest.mark.usefixtures("mean_lengths_alone")
def test_the_true_lengths_that_tips_hold_are_inside_the_stated_intervals_or_longer():
    scores, adhere_more, of_inputs = [], [], []
    for k in range(200):
        cracks, _, truth = drawn_lengths(np.random.default_rng(k), BEAMS)
        tips = computed(cracks.mean(axis=0), cracks.std(axis=0, ddof=1)).isel(result=slice(3, None))
        off = np.log(truth[3:] / tips.centre.values) - tips.result_shift.values
        scores.append(off / tips.result_after.values)
        of_inputs.append(off / tips.result_of_inputs.values)
        adhere_more.append(tips.adhesion_of_tips.values > 1)
    scores, of_inputs, adhere_more = map(np.array, (scores, of_inputs, adhere_more))
    assert 0.3 < np.mean(adhere_more) < 0.7
    assert abs(np.mean(np.abs(scores[adhere_more]) < 1) - 0.68) <= 0.10
    assert abs(np.mean(np.abs(scores[adhere_more]) < 1.96) - 0.95) <= 0.04
    assert np.mean(scores < -1.96) <= 0.025 + 0.02
    assert np.mean(np.abs(of_inputs[adhere_more]) < 1.96) < 0.9  # control: even with those before the measurement


# Devices and test beams of which too few stick in the simulation


def unknown(dataset):
    """Budget of too few devices that stick."""
    return dataset.assign({name: dataset[name] * np.nan for name in ("slope", "scatter")}).assign(
        centre=dataset.centre.copy(data=np.nan)
    )


def only_known(monkeypatch, is_known):
    """Let budgets be known where ``is_known(beam, humidity, response)``."""
    whole = budget

    def of_some(beam, humidity, response=S_SHAPE):
        found = whole(beam, humidity, response)
        return found if is_known(beam, humidity, response) else unknown(found)

    monkeypatch.setitem(globals(), "budget", of_some)


RESULTS = ["result_shift", "result_after", "p_value", "updated_safe"]


def test_data_of_which_the_simulation_shows_nothing_are_left_out_and_named(monkeypatch):
    without = computed(as_computed(1.1)[1:], humidities=HUMIDITIES[1:])
    only_known(monkeypatch, lambda beam, humidity, _: (beam, humidity) != (ARRAY, 0.44))
    found = computed(as_computed(1.1))
    xr.testing.assert_allclose(found[RESULTS], without[RESULTS])
    assert "Left out are arrayA, RH 0.44: so few" in tables_test_beams.agreement(found)
    assert "Left out" not in tables_test_beams.agreement(without)


def test_data_of_which_all_are_left_out_leave_the_device_as_it_was(monkeypatch):
    only_known(monkeypatch, lambda beam, *_: beam is not ARRAY)
    found = computed(as_computed(1.1))
    assert_allclose(found.result_after, found.result_before, rtol=1e-12)
    assert_allclose(found.result_shift, 0)
    assert float(found.p_value) == 1
    assert "arrayA, RH 0.92" in tables_test_beams.agreement(found)
    assert "measured" not in tables_test_beams.test_beams({"C1": found}).cells
    assert figures_test_beams.test_beams(found).axes


def test_what_is_not_known_of_a_device_is_said_and_leaves_the_rest(monkeypatch):
    whole = computed(as_computed(1.02))
    only_known(monkeypatch, lambda beam, humidity, _: (beam, humidity) != (DEVICE, 0.44))
    found = computed(as_computed(1.02))
    known = found.humidity_of_result.values > 0.44
    assert_allclose(found.result_after[known], whole.result_after[known])
    assert np.isnan(found.result_after[~known]).all()
    assert "no length is stated: so few of the simulated devices stick" in tables_test_beams.notes(found)
    assert len(tables_test_beams.stuck_sentences(found)) == 2
    table = tables_test_beams.test_beams({"C1": found})
    assert "nan" not in f"{table.caption} {table.cells.to_string()}"
    assert figures_test_beams.test_beams(found).axes


# Bridges and stoppers

BRIDGE = replace(DEVICE, kind="bridge", residual_stress=50e6)
PULL_OFFS = 30e-6 * np.random.default_rng(5).lognormal(0, 0.1, 400)


def of_other(response, predicted, device, slopes):
    """Dataset of stage test_beams of a bridge or a stopper with an rms of B2 10 % of sigma wrong in the test beams."""
    names = ["rms of B2", "residual stress"]
    own = xr.Dataset(
        {
            "slope": ("input", slopes),
            "covariance": (("input", "other"), np.diag([DEVIATIONS["rms of B2"], 0.1]) ** 2),
            "centre": ((), 30e-6, {"response": response, "share": 0.0, "units": "N" if response == FORCE else "m"}),
            "scatter": ((), 0.1),
        },
        coords={"input": names, "other": names},
    )
    # Longer cracks where the rms matters most: rougher than stated.
    means = [length(ARRAY, rh, rms=0.08) for rh in HUMIDITIES]
    lengths = CrackLengths(1500 * UM, HUMIDITIES, tuple(means), tuple(SCATTER * np.array(means)), (2000,) * 3)
    settings = Settings(0, DiscrepancyOfModel(0.0, 0.0, 1e-3), {"arrayA": ARRAY}, {"arrayA": lengths}, {}, device)
    beams = {("arrayA", rh): budget(ARRAY, rh) for rh in HUMIDITIES}
    found = inference.compute({("R1", 0.67): own}, beams, predicted, {}, {}, settings)
    return with_reruns(found)


def of_bridge():
    axis = np.linspace(100, 300, 401) * UM
    stuck = xr.DataArray(
        [ndtr(np.log(axis / (200 * UM)) / SCATTER)], coords={"shape": [MIDDLE], "length": ("length", axis)}
    )
    safe = xr.DataArray([[160 * UM]], coords={"shape": [MIDDLE], "share": [0.001]})
    estimate = xr.full_like(safe, 200 * UM * np.exp(SCATTER * ndtri(0.001)))
    found = xr.Dataset({"safe_length": safe, "estimate": estimate, "stuck": stuck})
    return of_other(MIDDLE, {0.67: found}, BRIDGE, [1.0, 0.5])


def of_stopper():
    coords = {"humidity": [0.67], "share": [0.01, 0.001], "part": ["safe", "estimate", "error"]}
    safe = xr.DataArray(np.array([[[37e-6, 40e-6]]] * 3), coords=coords, dims=("part", "humidity", "share"))
    pull_off = (("humidity", "sample"), [PULL_OFFS])
    found = xr.Dataset({"safe_force": safe, "pull_off": pull_off, "restoring_force": 33e-6})
    return of_other(FORCE, found, None, [-2.0, 0.0])


@pytest.mark.parametrize("found", [of_bridge, of_stopper])
def test_bridges_and_stoppers_follow_the_inputs_alone(found):
    found = found()
    moved = float(found["shift"].sel(input="rms of B2"))
    assert_allclose(moved, 0.08, rtol=0.1)
    slope = 1.0 if MIDDLE in found.response else -2.0
    assert_allclose(found.result_shift, [slope * moved], rtol=1e-9)
    assert_allclose(found.updated_safe, found.safe * np.exp(slope * moved), rtol=1e-9)
    assert_allclose(found.result_before, found.result_of_inputs, rtol=1e-12)
    assert np.all(found.result_after < found.result_before)
    # No length of the test beams speaks about a stress that only the bridge has.
    stress = found.sel(input="residual stress")
    assert_allclose([stress["shift"], stress.deviation], [0, 0.1], atol=1e-9)


def test_the_expected_share_of_stuck_devices_is_that_of_drawn_inputs():
    for found, sticks in (
        (of_bridge(), lambda s, rng: rng.lognormal(np.log(200 * UM), SCATTER, len(s)) * np.exp(s) < 160 * UM),
        (of_stopper(), lambda s, rng: rng.choice(PULL_OFFS, len(s)) * np.exp(s) > 33e-6),
    ):
        rng, number = np.random.default_rng(6), 200_000
        for name, shift, deviation in (("expected", 0.0, "before"), ("updated", found.result_shift[0], "after")):
            shifts = rng.normal(float(shift), float(found[f"result_{deviation}"][0]), number)
            drawn = sticks(shifts, rng).mean()
            stated = float(found[f"{name}_stuck"].values.ravel()[0])
            assert abs(drawn - stated) < 4 * np.sqrt(stated * (1 - stated) / number) + 2e-4  # steps of the axis
    assert float(of_stopper().updated_stuck.max()) < float(of_stopper().expected_stuck.max())


def test_small_shares_are_those_of_the_fit_and_not_those_of_the_few_counted_beams():
    shares, axis = [1e-2, 1e-3, 1e-4], np.linspace(150, 300, 301) * UM
    estimate = 200 * UM * np.exp(SCATTER * ndtri(shares))
    for whole in (np.ceil, np.floor):  # where counts take over, they are above or below the fit
        counted = whole(420 * ndtr(np.log(axis / (200 * UM)) / SCATTER)) / 420
        found = xr.Dataset(
            {"estimate": ("share", estimate), "stuck": ("length", counted)}, coords={"share": shares, "length": axis}
        )
        lengths, stuck = inference.sticking(found)
        assert np.all(np.diff(lengths) > 0)
        assert np.all(np.diff(stuck) >= 0)
    margins = [np.log(estimate[1] / at) for at in (lengths, axis)]
    of_fit, of_counts = (
        expected_share(margin, np.diff(share, prepend=0.0), 0.02 * SCORES)
        for margin, share in zip(margins, (stuck, counted), strict=True)
    )
    exact = ndtr(np.log(estimate[1] / (200 * UM)) / np.hypot(SCATTER, 0.02))  # both are normal
    assert_allclose(of_fit, exact, rtol=0.1)
    assert of_counts < 0.6 * exact  # control


@pytest.mark.parametrize(
    ("found", "noted", "stuck", "rows"),
    [
        (of_bridge, "Cracks do not say how much the model errs at bridges.", "of 160 µm, the simulated limit,", 2),
        (of_stopper, "Cracks do not say how much the model errs at stoppers.", "at its restoring force", 3),
    ],
)
def test_pages_state_what_follows_for_bridges_and_stoppers(found, noted, stuck, rows):
    found = found()
    assert tables_test_beams.notes(found).endswith(noted)
    (sentence,) = tables_test_beams.stuck_sentences(found)
    assert sentence.startswith(f"At a relative humidity of {float(found.humidity[0]):g}, ")
    assert stuck in sentence
    (in_dry_air,) = tables_test_beams.stuck_sentences(found.assign_coords(humidity=[0.0]))
    assert in_dry_air.startswith("In dry air, ")
    frame = tables_test_beams.test_beams({"R1": found}).frame
    assert frame.part.str.contains("limit|stuck").sum() == rows
    assert figures_test_beams.test_beams(found).axes


# Counts


@pytest.fixture
def shapes(monkeypatch):
    """Cracks and arcs of the lengths of their budgets; the function makes all arcs so many times as long."""

    def longer(factor):
        def of_shapes(cracks, ground, tips, water):
            assert ground == tips == ("humid" if cracks.humidity else "dry")
            assert water.gaps.summits == ("water" if cracks.humidity else "dry")
            crack = float(cracks.budget.centre)
            arc = factor * float(budget(cracks.beam, cracks.humidity, ARC).centre)
            return np.zeros(2), [lognormal(crack, SCATTER), lognormal(arc, SCATTER)]

        monkeypatch.setattr(inference, "lengths_and_scores", of_shapes)

    longer(1.0)
    return longer


def counts(lengths, stuck, of, humidities=HUMIDITIES):
    return StuckCounts(
        Water(300.0, gaps=Gaps({}, "water")), tuple(humidities), tuple(lengths), tuple(stuck), (of,) * len(stuck)
    )


@pytest.mark.usefixtures("shapes")
def test_counts_that_say_nothing_lengthen_no_tip():
    shorter, sure = as_computed(0.8), counts(as_computed(3.0), [10] * 3, 10)  # all of these beams stick in any case
    alone, counted = computed(shorter), computed(shorter, stuck=sure)
    assert np.all(alone.adhesion_of_tips[3:] > 1.5)
    assert_allclose(counted.adhesion_of_tips, alone.adhesion_of_tips, rtol=0.02)
    assert_allclose(counted.result_shift, alone.result_shift, atol=0.01)
    assert "times the adhesion that the inputs explain" in tables_test_beams.notes(counted)
    nothing_measured = computed([], stuck=sure)
    assert "Cracks" not in tables_test_beams.notes(nothing_measured)
    assert_allclose(nothing_measured.result_shift, 0, atol=0.01)


def test_counts_say_about_the_device_what_the_crack_lengths_of_the_same_beams_say(shapes):
    shapes(10.0)  # no tip holds
    rng, number, centres = np.random.default_rng(2), 4000, np.array(as_computed())
    single = 1.03 * centres * np.exp(SCATTER * rng.normal(size=(number, 3)))
    measured = computed(single.mean(axis=0), single.std(axis=0), beams=number)
    counted = computed([], stuck=counts(1.03 * centres, (single < 1.03 * centres).sum(axis=0), number))
    difference = (counted.result_shift - measured.result_shift)[:3]
    # The rest of the model is the same in both; what differs is the error of √(π/2) s/√N of a count.
    assert np.all(np.abs(difference) < 4 * np.sqrt(np.pi / 2) * SCATTER / np.sqrt(number))
    assert_allclose(counted.result_after[:3], measured.result_after[:3], rtol=1e-2)
    other = computed([], stuck=counts(1.1 * centres, (single < 1.03 * centres).sum(axis=0), number))
    assert np.all(np.abs(other.result_shift - measured.result_shift)[:3] > 0.01)  # control


@pytest.mark.parametrize(("stuck", "sign"), [(2, 1), (10, 0), (18, -1)])
def test_more_stuck_beams_in_dry_air_than_expected_mean_more_adhesion_in_any_air(shapes, monkeypatch, stuck, sign):
    shapes(10.0)  # no tip holds
    monkeypatch.setitem(ENERGY, 0.0, 0.2e-3)
    monkeypatch.setitem(POWER, 0.0, -3.0)
    found = computed([], humidities=(0.0,), stuck=counts([length(ARRAY, 0.0)], [stuck], 20, (0.0,)))
    assert_array_equal(np.sign(found.result_shift.values.round(9)), sign)  # of crack lengths, and of tips by the inputs
    assert_allclose(found.stuck_before, 0.5, atol=1e-9)
    assert np.all(found.result_after < found.result_before)
    of_rms = float(found["shift"].sel(input="rms of B2"))
    assert np.sign(round(of_rms, 9)) == sign  # rougher surfaces adhere less


@pytest.mark.usefixtures("shapes")
def test_counts_of_beams_that_tips_hold_say_how_much_the_model_errs_at_cracks_as_well():
    halves = np.array(as_computed()) / np.sqrt(2)
    found = computed([], stuck=counts(halves, [10] * 3, 20))
    gains = (found.result_after / found.result_before).values
    assert gains.max() < 0.8
    assert_allclose(found.stuck_before, 0.5, atol=1e-6)
    assert np.all(np.abs(found.result_shift) < 0.1 * found.result_before)  # half of the beams are free, as computed
    assert_allclose(found.stuck_after, 0.5, atol=0.05)


@pytest.mark.usefixtures("shapes")
def test_quantiles_are_normal_after_crack_lengths_and_not_where_all_counted_beams_stick():
    measured = computed(as_computed(1.1))
    normal = measured.result_shift + measured.result_after * measured.score
    assert_allclose(measured.result_quantile, normal, rtol=1e-12)
    assert_allclose(measured.datum_quantile, measured.datum_shift + measured.datum_after * measured.score, rtol=1e-12)
    all_stuck = computed([], stuck=counts(as_computed(0.7), [40] * 3, 40)).isel(result=slice(3, None))
    low, high = (np.abs(all_stuck.result_quantile.sel(score=z) - all_stuck.result_shift) for z in (-2, 2))
    assert float((low / high).max()) > 1.1  # the counts exclude longer lengths, and no shorter ones


@pytest.mark.nightly
@pytest.mark.usefixtures("shapes", "mean_lengths_alone")
def test_the_true_lengths_of_the_device_are_inside_the_stated_intervals_of_counts():
    scores = []
    for k in range(60):
        rng = np.random.default_rng(k)
        cracks, tips, truth = drawn_lengths(rng, 20)
        lengths = np.array(as_computed()) * rng.uniform(0.7, 1.05, 3)
        stuck = (np.minimum(cracks, tips) < lengths).sum(axis=0)
        after = computed([], stuck=counts(lengths, stuck, 20))
        scores.append((np.log(truth / after.centre.values) - after.result_shift.values) / after.result_after.values)
    assert abs(np.mean(np.abs(scores) < 1) - 0.68) <= 0.10
    assert abs(np.mean(np.abs(scores) < 1.96) - 0.95) <= 0.04


def test_cracks_and_arcs_hold_beams_of_the_lengths_of_the_model(monkeypatch):
    laws, slopes = sampled_vectors(400, spread=0.2), np.geomspace(0.01, 1, 30)
    monkeypatch.setattr(curves, "vectors", lambda *_: (laws, 1.1 * laws[:, 1].max()))
    monkeypatch.setattr(curves, "tip_forces", lambda *_: (slopes, laws[:, :1] / slopes))
    one = inference.Result("arrayA", 0.67, budget(ARRAY, 0.67), ARRAY)
    behind, (crack, tip) = inference.lengths_and_scores(one, None, None, None)
    strips = forcelaw.coefficients(laws, 1.1 * laws[:, 1].max())
    assert_allclose(behind, [2 * foundation_length(ARRAY.beam, strips), 0])
    assert_allclose(crack(np.log(float(one.budget.centre) * np.exp([0, SCATTER]))), [0, 1], atol=1e-9)
    held = arcs.longest_free(slopes, laws[:, :1] / slopes, ARRAY.beam)
    assert_allclose(np.mean(ndtr(tip(np.log(held)))), 0.5, atol=0.02)


def test_further_beams_like_the_device_help_more_where_the_device_is_known_least():
    found = computed(as_computed())
    left = found.result_after_further
    assert np.all(left <= found.result_after + 1e-12)
    assert np.all(left.sel(beams=100) <= left.sel(beams=10))
    assert_array_equal(left.further, [*(f"arrayA, RH {rh:g}" for rh in HUMIDITIES), *found.result.values[:3]])
    # A new array at its own humidity has dimensions and a rest of its own, which no number of beams averages out.
    wanted = of(left, 0.67).sel(further="C1, RH 0.67", beams=100)
    assert 0.05 < float(wanted) < float(of(found, 0.67).result_after)


@pytest.mark.usefixtures("shapes")
def test_the_dataset_is_stored_and_read_unchanged(tmp_path):
    found = computed(as_computed(1.1), stuck=counts(as_computed(0.7), [3, 4, 5], 20))
    storage.save(found, tmp_path / "C1.nc", "test_beams_rerun", {})
    xr.testing.assert_allclose(storage.load(tmp_path / "C1.nc", "test_beams_rerun"), found)


# Sentences


def said(update):
    """Sentences on the limits by test beams."""
    return texts(tables_test_beams.warnings(update))


def of_page(update):
    """Lines of the page of limits of a device without other limits."""
    return pages.as_markdown(warnings_page.together(NO_LIMITS, {"C1": update}), {}).splitlines()


def test_data_that_the_inputs_explain_give_no_warning():
    assert said(computed(as_computed(1.01))) == []
    assert tables_test_beams.agreement(computed(as_computed(1.01))).startswith("The test beams are as computed, ")
    assert tables_test_beams.agreement(computed(as_computed(1.3))).startswith("Differences from the computed ")


def test_data_that_only_the_model_explains_say_so_with_its_factor():
    (sentence, *_) = said(computed(as_computed(1.3)))
    assert sentence.startswith("The errors of the inputs, as stated, do not explain the test beams (p = ")
    assert "times as large as computed" in sentence


def test_data_that_nothing_explains_are_refused_in_words():
    zigzag = np.array(as_computed()) * [1.3, 0.7, 1.3]
    sentences = said(computed(zigzag))
    assert "rely neither on the update" in sentences[0]
    assert any(sentence.startswith("arrayA, RH 0.67: -") for sentence in sentences)


def contradicted(found, p_value=2e-6):
    return found.assign(p_value=((), p_value))


@pytest.mark.parametrize("found", [lambda: computed(as_computed()), of_bridge, of_stopper])
def test_an_update_that_nothing_explains_recommends_nothing_and_its_warning_counts(found):
    reliable, refused = found(), contradicted(found())
    words, refusal = tables_test_beams.notes(reliable), tables_test_beams.notes(refused)
    assert words != refusal
    assert not re.search(r"\d (µm|µN)", refusal)
    assert "(p = 2e-06)" in refusal
    assert refusal.endswith("rely neither on the update nor on what is stated without it.")
    assert tables_test_beams.stuck_sentences(reliable)
    assert tables_test_beams.stuck_sentences(refused) == []
    safe, others = (of_safe_sizes(each) for each in (reliable, refused))
    assert safe.after.notnull().all()
    assert others.after.isnull().all()
    assert_array_equal(safe.before, others.before)
    (warned,) = [line for line in of_page(refused) if "rely" in line]
    assert plain(warned) == f"- C1, test beams: {refusal.partition('. ')[2]}"
    assert not any("rely" in line for line in of_page(reliable))


#: Devices without other warnings.
NO_LIMITS = device_warnings.OfDevices({}, {}, {})


def of_safe_sizes(found):
    """Rows of the table with safe lengths or forces, and the shares that stick at them."""
    frame = tables_test_beams.test_beams({"C1": found}).frame
    return frame[frame.part.str.contains("safe|stuck at")]


def test_humidities_and_dimensions_beyond_those_of_the_test_beams_are_extrapolations():
    dry = said(computed(as_computed(humidities=(0.67,)), humidities=(0.67,)))
    assert dry[:1] == [
        "Test beams were measured from RH 0.67 to 0.67: the prediction at relative humidities of 0.44, 0.92 is an "
        "extrapolation."
    ]
    # Lengths of equal beams are as the energy to the power of -1/4.
    longer, shorter = (ENERGY[0.67] / ENERGY[0.44]) ** 0.25 - 1, 1 - (ENERGY[0.67] / ENERGY[0.92]) ** 0.25
    assert dry[1].startswith(
        f"C1, RH 0.44: cracks of equal beams would be {100 * longer:.0f} % longer than the longest"
    )
    assert dry[2].startswith(f"C1, RH 0.92: cracks of equal beams would be {100 * shorter:.0f} % shorter than")
    assert len(dry) == 3
    thin = replace(ARRAY, thickness=1.2 * UM)
    found = computed([length(thin, rh) for rh in HUMIDITIES], array=thin)
    assert said(found)[0].startswith("The thickness of the device, 2.6 µm, differs by more than a")


def test_computed_cracks_that_are_longer_than_the_beams_are_named():
    long = replace(ARRAY, thickness=6 * UM, gap=40 * UM)
    found = computed([length(long, rh) for rh in HUMIDITIES], array=long)
    assert any(sentence.startswith("arrayA, RH 0.44: computed cracks of") for sentence in said(found))


def test_the_combination_that_one_length_determines_names_its_inputs():
    found = computed(as_computed(humidities=(0.67,)), humidities=(0.67,))
    (sentence,) = tables_test_beams.combinations(found)
    assert f"more {FACTOR}" in sentence
    assert "more rms of B2" in sentence
    assert "thickness of C1" not in sentence
    assert "They do not tell these apart" in sentence
    largest = abs(found.correlation).max("input")
    (single,) = tables_test_beams.combinations(
        found.assign(correlation=found.correlation.where(abs(found.correlation) == largest, 0.0))
    )
    assert "It is mostly this input" in single
    assert "apart" not in single


def test_the_table_has_data_lengths_safe_lengths_and_inputs():
    table = tables_test_beams.test_beams({"C1": computed(as_computed(1.1))})
    assert len(table.frame) == 3 + 6 + 12 + 8
    results = table.frame[table.frame.part.str.contains("tip|length") & (table.frame.name == "C1")]
    assert set(results.device) == {"C1"}
    assert set(results.relative_humidity) == set(HUMIDITIES)
    cells = table.cells.set_index("what").before
    assert cells["C1: simulated limit, beam or tip, p = 0.001 [µm]"].iloc[0] == "250.0"
    assert "C1: stuck at the simulated limit, beam or tip, p = 0.001, of column before [%]" in cells
    assert [tables_test_beams._number(share, np.nan) for share in (19.46, 0.0134)] == ["19.5", "0.013"]
    assert "Further test beams would help most with the dimensions and in the air of " in table.caption


@pytest.mark.usefixtures("shapes")
def test_the_table_has_counts_beside_the_expected_ones():
    found = computed([], stuck=counts(as_computed(0.7), [3, 4, 5], 20))
    frame = tables_test_beams.test_beams({"C1": found}).frame
    rows = frame[frame.part.str.startswith("stuck of 20")]
    assert rows.measured.tolist() == [3, 4, 5]
    assert_allclose(rows.after, 20 * found.stuck_after)
    assert frame[frame.part == "crack length [µm]"].measured.isna().all()


@pytest.mark.usefixtures("shapes")
def test_the_figure_shows_counts_at_the_lengths_of_their_beams():
    figure = figures_test_beams.test_beams(computed([], stuck=counts(as_computed(0.7), [3, 4, 5], 20)))
    assert [text.get_text() for text in figure.axes[0].texts[:3]] == ["3 of 20", "4 of 20", "5 of 20"]
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "measured, 95 %" not in labels
    assert labels[-1].startswith("length of counted beams")
    single = figures_test_beams.test_beams(computed([], stuck=counts(as_computed(0.7)[:1], [3], 20, HUMIDITIES[:1])))
    assert single.legends[0].get_texts()[-1].get_text() == labels[-1]


def test_every_panel_of_a_page_has_its_own_legend_below_it_and_bands_have_patches():
    with on_a_page():
        figure = figures_test_beams.test_beams(computed(as_computed(1.1)))
    lengths, inputs = ([text.get_text() for text in panel.get_legend().get_texts()] for panel in figure.axes)
    assert not figure.legends
    assert {"before, 95 %", "after, 95 %", "measured, 95 %"} <= set(lengths)
    assert not set(lengths) & set(inputs)


def test_counts_in_dry_air_are_beside_the_axis(shapes, monkeypatch):
    shapes(10.0)
    monkeypatch.setitem(ENERGY, 0.0, 0.2e-3)
    monkeypatch.setitem(POWER, 0.0, -3.0)
    both = (0.0, 0.67)
    found = computed([], humidities=both, stuck=counts(as_computed(0.7, both), [3, 4], 20, both))
    panel = figures_test_beams.test_beams(found).axes[0]
    at = {int(text.get_text()[0]): text.xy[0] for text in panel.texts if "of 20" in text.get_text()}
    assert at == {3: style.places(list(both))[0.0], 4: 0.67}
    assert 0 < at[3] < 0.67


@pytest.mark.parametrize("humid", [(), (0.67,), (0.44, 0.67, 0.92)])
@pytest.mark.parametrize("names", [("arrayA",), ("arrayA", "arrayB")])
def test_numbers_of_counts_cross_neither_the_line_of_dry_air_nor_the_frame(shapes, monkeypatch, humid, names):
    shapes(10.0)
    monkeypatch.setitem(ENERGY, 0.0, 0.2e-3)
    monkeypatch.setitem(POWER, 0.0, -3.0)
    both = (0.0, *humid)
    stuck = counts(as_computed(0.7, both), [100] * len(both), 120, both)
    figure = figures_test_beams.test_beams(computed([], humidities=both, names=names, stuck=stuck))
    figure.draw_without_rendering()
    panel = figure.axes[0]
    boxes = [text.get_window_extent() for text in panel.texts]
    assert len(boxes) == len(both)
    lines = [line.get_xdata()[0] for line in panel.lines if line.get_linestyle() == ":"]
    assert len(lines) == bool(humid)
    for at in [panel.transData.transform((place, 0))[0] for place in lines] + [panel.bbox.x0, panel.bbox.x1]:
        assert not [box for box in boxes if box.x0 < at < box.x1]
        assert not [one for one in panel.collections if _crosses(one, panel, at)]


def test_the_number_of_the_longest_counted_beams_is_below_the_frame(shapes):
    shapes(10.0)
    found = computed([], stuck=counts(as_computed(0.7)[:1], [20], 20, HUMIDITIES[:1]))
    figure = figures_test_beams.test_beams(found.assign(length_of_count=("count", [1.8e-3])))
    figure.draw_without_rendering()
    panel = figure.axes[0]
    assert max(text.get_window_extent().y1 for text in panel.texts) < panel.bbox.y1


def _crosses(band, panel, at):
    """Whether a band is on both sides of a place [pixels]."""
    along = panel.transData.transform(band.get_paths()[0].vertices)[:, 0]
    return along.min() < at - 1 < at + 1 < along.max()


def test_bands_at_one_humidity_have_a_width():
    for humidities in ((0.67,), (0.44, 0.67)):
        panel = figures_test_beams.test_beams(computed(as_computed(1.1, humidities), humidities=humidities)).axes[0]
        for band in panel.collections[:2]:
            assert np.ptp(band.get_paths()[0].vertices[:, 0]) >= 0.019


def test_no_bar_of_the_inputs_touches_the_frame():
    panel = figures_test_beams.test_beams(computed(as_computed(1.1))).axes[-1]
    left, right = panel.get_xlim()
    assert all(left < bar.get_x() and bar.get_x() + bar.get_width() < right for bar in panel.patches)


def test_the_figure_has_a_panel_for_every_array_and_one_for_the_inputs():
    figure = figures_test_beams.test_beams(computed(as_computed(1.1), names=("arrayA", "arrayB")))
    assert "inputs" in [panel.get_title(loc="left") for panel in figure.axes][-1]
    assert len(figure.axes) == 3
