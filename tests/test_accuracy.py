"""Numbers of beams and of samples follow from the asked accuracy before any job, by a pilot of their own."""

import functools

import numpy as np
import pytest
import yaml
from configurations import PAPER, configured
from configurations import problems as invalid

import stiction
from stiction import accuracy
from stiction.config.cases import case_id
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.devices.numbers import MOST_BEAMS, Spread
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.run.disk_cache import DiskCache
from stiction.stages.contact import curves

C1 = "kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 10, width_um: 4, humidities: [0.88]"
R1 = "kind: bridge, pair: b, thickness_um: 2, gap_um: 2, width_um: 4, residual_stress_MPa: 50, humidities: [0.88]"
S1 = "kind: stopper, pair: b, contact_um: [3, 3], restoring_force_uN: 1, humidities: [0.5]"
SMALL = f"chaos: {{order: 2}}\ndesign: {{accuracy: {{length: 0.03}}}}\ndevices: {{C1: {{{C1}}}, S1: {{{S1}}}}}"
PLAIN = f"chaos: {{order: 2}}\ndevices: {{C1: {{{C1}}}, S1: {{{S1}}}}}"
SPREADS = {case_id("C1", 0.88): [Spread(0.03, 0.6), Spread(0.06, 0.1)]}


@pytest.fixture
def of_pilot(monkeypatch):
    """Set the spreads that a pilot would show."""
    return lambda spreads: monkeypatch.setattr(accuracy, "_spreads", lambda *_: spreads)


def settings(config, file):
    """Settings of the job for a dataset."""
    return Graph(Plan(config)).job(file).settings


@pytest.mark.parametrize("overlay", ["contact: {samples: 400}", f"devices: {{S1: {{{S1}}}}}", "{}"])
def test_a_configuration_with_nothing_to_decide_is_as_it_is(overlay):
    devices = f"devices: {{C1: {{{C1}}}}}" if "samples" in overlay else "{}"
    config = configured("chaos: {order: 2}", devices, overlay)
    assert accuracy.decided(config) is config
    assert accuracy.numbers(config, {}) is None


def test_without_beams_numbers_are_those_of_the_configuration():
    config = accuracy.decided(configured(f"design: {{accuracy: {{length: 0.03}}}}\ndevices: {{S1: {{{S1}}}}}"))
    assert config["design"]["beams"] == PAPER["design"]["beams"]
    assert settings(config, "devices/contact/b_3000x3000")["contact"]["samples"] == PAPER["contact"]["samples"]


def test_numbers_that_are_not_decided_yet_are_not_those_of_the_configuration():
    results = Results.of(configured(SMALL))
    for file in ("devices/contact/b_1500x4000", "devices/cracks/C1_rh088"):
        with pytest.raises(ValueError, match="decided no numbers: use stiction.accuracy.decided"):
            results[file]


def test_jobs_of_devices_have_the_numbers_and_all_others_those_of_the_configuration(of_pilot):
    of_pilot(SPREADS)
    config = configured(SMALL)
    found = accuracy.numbers(config, {})
    decided, ground = found.within(config), "b_1500x4000"
    assert found.beams % 200 == 0
    assert found.samples[ground] % 100 == 0
    assert settings(decided, "devices/cracks/C1_rh088")["beams"] == found.beams != config["design"]["beams"]
    plan = Plan(decided)
    tips = plan.devices.tips("C1").name
    assert settings(decided, f"devices/contact/tips/{tips}")["contact"]["samples"] == found.beams
    assert settings(decided, f"devices/contact/{ground}")["contact"]["samples"] == found.samples[ground] != 5000
    plain = configured(SMALL.replace("design: {accuracy: {length: 0.03}}", ""))
    for file in ("devices/contact/b_3000x3000", "contact/b_NG"):
        assert settings(decided, file) == settings(plain, file)


def test_devices_have_strips_of_their_own_if_an_accuracy_decides_their_number(of_pilot):
    of_pilot(SPREADS)
    config = configured(SMALL, "beam: {width_um: 4}")
    assert not Plan(accuracy.decided(config)).devices.has_strips_of_pair("C1")
    assert Plan(accuracy.decided(merged(config, {"contact": {"samples": 400}}))).devices.has_strips_of_pair("C1")


def test_a_stated_number_remains_and_the_other_one_follows(of_pilot):
    of_pilot(SPREADS)
    free, beams, samples = (
        accuracy.numbers(configured(SMALL, more), {})
        for more in ("{}", "design: {beams: 3000}", "contact: {samples: 700}")
    )
    assert beams.beams == 3000
    assert beams.samples["b_1500x4000"] < free.samples["b_1500x4000"], "beams leave more"
    assert samples.samples == {}
    assert samples.beams == free.beams


def test_an_accuracy_with_nothing_to_decide_is_refused():
    config = functools.reduce(
        merged, map(yaml.safe_load, (SMALL, "design: {beams: 400}\ncontact: {samples: 400}")), PAPER
    )
    (line,) = map(str, invalid(config))
    assert line.startswith("design.accuracy is {'length': 0.03}, must have a number to decide: leave out design.beams")


def test_what_the_pilot_expects_to_miss_is_said(of_pilot):
    of_pilot(SPREADS)
    assert "missed" not in str(accuracy.numbers(configured(SMALL), {}))
    of_pilot({case_id("C1", 0.88): [Spread(0.5, 0.0)]})
    missed = accuracy.numbers(configured(SMALL), {})
    assert missed.beams == MOST_BEAMS
    assert str(missed).endswith(f"the error is about {0.5 * 9.375 / MOST_BEAMS**0.5:.2g} for C1 at RH 0.88.")


def test_without_an_error_of_the_pilot_numbers_are_those_of_the_configuration(of_pilot):
    of_pilot({})
    assert accuracy.decided(configured(SMALL))["design"]["beams"] == PAPER["design"]["beams"]


# Samples without an accuracy


@pytest.fixture
def with_error(monkeypatch):
    """Numbers, and configuration with them, where a pilot shows an error of the mean length on one strip."""

    def decide(error, *overlays):
        monkeypatch.setattr(accuracy, "_mean_errors", lambda plan, *_: dict.fromkeys(plan.devices.cases, error))
        config = configured(PLAIN, *overlays)
        numbers = accuracy.numbers(config, {})
        return numbers.samples, numbers.within(config)

    return decide


def test_without_an_accuracy_the_samples_of_grounds_follow_from_the_errors_of_mean_lengths(with_error):
    samples, decided = with_error([0.08])
    assert samples == {"b_1500x4000": 1000}
    assert settings(decided, "devices/contact/b_1500x4000")["contact"]["samples"] == 1000
    assert accuracy.decided(decided) is decided
    plain, tips = configured(PLAIN), Plan(decided).devices.tips("C1").name
    for file in ("devices/contact/b_3000x3000", "contact/b_NG", f"devices/contact/tips/{tips}"):
        assert settings(decided, file) == settings(plain, file)


@pytest.mark.parametrize("error", [[], [1.0]])
def test_grounds_without_an_error_or_with_a_large_one_are_as_they_are(with_error, error):
    samples, decided = with_error(error, "beam: {width_um: 4}")
    assert samples == {}
    assert Plan(decided).devices.has_strips_of_pair("C1")
    assert not Plan(with_error([0.08], "beam: {width_um: 4}")[1]).devices.has_strips_of_pair("C1")  # control


def test_ground_that_a_stopper_touches_as_well_is_as_it_is(with_error):
    assert with_error([0.08], "devices: {S1: {contact_um: [1.5, 4]}}")[0] == {}


def test_there_are_at_least_as_many_samples_as_changed_ones(with_error):
    assert with_error([0.0], "chaos: {order: 12}")[0] == {"b_1500x4000": 500}
    assert with_error([0.0], "studies: {slopes: {samples: 700}}")[0] == {"b_1500x4000": 1000}


@pytest.mark.slow
def test_the_error_of_the_mean_length_is_a_quarter_of_the_scatter_of_energies():
    pilot = accuracy._Pilot.from_plan(Plan(configured(PLAIN)))
    (case,) = pilot.plan.devices.cases
    ((error,), again) = pilot.mean_error(case), accuracy._Pilot.from_plan(Plan(configured(PLAIN))).mean_error(case)
    contact = pilot._contact(*pilot._patches(case)[0])
    energies = curves.energies(contact, case.humidity, in_si(accuracy._Settings, pilot._beam_settings(case)).water)
    assert np.isclose(error, 0.25 * energies.std(ddof=1) / energies.mean(), rtol=0.02)
    assert again == [error]


# By a pilot


@pytest.fixture(scope="module")
def small():
    return configured(SMALL, "design: {accuracy: {length: 0.01}}")


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """File that keeps what the pilot showed."""
    return tmp_path_factory.mktemp("kept") / "accuracy.json"


@pytest.fixture(scope="module")
def found(small, kept):
    known = DiskCache(kept)
    numbers = accuracy.numbers(small, {}, "code", known)
    known.save()
    return numbers


@pytest.mark.slow
def test_numbers_are_again_the_same_and_those_of_a_device_do_not_depend_on_others(small, monkeypatch):
    monkeypatch.setattr(accuracy, "PILOT", 40)
    alone, again = (accuracy.numbers(small, {}) for _ in range(2))
    assert alone == again
    other = small["devices"]["C1"] | {"width_um": 3, "thickness_um": 3}
    together = accuracy.numbers(merged(small, {"devices": {"A1": other}}), {})
    (case,) = alone.errors
    assert together.samples.keys() == {"b_1500x3000", "b_1500x4000"}
    assert together.beams >= alone.beams
    assert together.errors[case] <= alone.errors[case] * (1 + 1e-9) or together.beams > alone.beams


@pytest.mark.slow
def test_what_a_pilot_showed_is_remembered_until_something_changes_on_which_it_depends(small, found, kept, monkeypatch):
    monkeypatch.setattr(accuracy, "compute", None)
    coarser = merged(small, {"design": {"accuracy": {"length": 0.03}}, "figures": {"humidity_points": 7}})
    assert accuracy.numbers(small, {}, "code", DiskCache(kept)) == found
    assert accuracy.numbers(coarser, {}, "code", DiskCache(kept)).beams < found.beams
    for changed in ({"seed": 1}, {"surfaces": {"B2": {"rms_nm": 3}}}, {"devices": {"C1": {"gap_um": 11}}}):
        with pytest.raises(TypeError, match="not callable"):
            accuracy.numbers(merged(small, changed), {}, "code", DiskCache(kept))


def test_the_random_numbers_of_the_pilot_are_none_of_the_run(small):
    assert accuracy._Pilot.from_plan(Plan(small)).plan.config["seed"] != small["seed"]
    assert (
        accuracy._Pilot.from_plan(Plan(small)).plan.config["seed"]
        == accuracy._Pilot.from_plan(Plan(small)).plan.config["seed"]
    )


@pytest.mark.slow
def test_a_run_reaches_the_accuracy_within_a_factor_of_one_and_a_half(small, found):
    device = stiction.Device.of(found.within(small), "C1")
    dataset = device.safe_lengths(0.88).sel(share=1e-3)
    assert int(dataset.beams) == found.beams
    errors = np.hypot(dataset.beams_error, dataset.surfaces_error.fillna(0)) / dataset.estimate
    assert 0.01 / 1.5 < float(errors.max()) < 0.01 * 1.5
    warned = any("design.accuracy.length" in sentence for sentence in device.warnings(device.safe_lengths(0.88)))
    assert warned == (float(errors.max()) > 0.01)
