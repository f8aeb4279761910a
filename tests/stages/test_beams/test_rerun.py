"""The update of test beams computed again at its inputs: linear responses agree, others are warned of."""

from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import stiction
from stiction.beam.energy import arrest_length
from stiction.plan.graph import Results
from stiction.report.limits.words import texts
from stiction.report.test_beams import tables as tables_test_beams
from stiction.stages.devices import budget as stage_budget
from stiction.stages.devices.budget import Responses
from stiction.stages.devices.opening import S_SHAPE, DesignedBeam
from stiction.stages.devices.uncertain_inputs import OF_AIR, OF_BEAMS, InputState, Uncertainty, changed, number_blocks
from stiction.stages.test_beams import rerun
from stiction.stages.test_beams.inference import Result

UM = 1e-6
BEAM = DesignedBeam("cantilever", "b", 2.6 * UM, 20 * UM, 30 * UM, 164e9, 1.5 * UM)
STATED = Uncertainty(thickness=0.05 * UM, gap=0.3 * UM, humidity=0.01)
ERRORS = {"thickness": 0.1, "gap": -0.05, "humidity": 0.02}
ENERGIES = 1e-3 * np.random.default_rng(3).lognormal(0, 0.2, 200)
EMPTY = xr.Dataset(coords={"strip": range(3)})


@dataclass(frozen=True)
class Analytic:
    """Settings of beams of Eq. (13) whose adhesion energy is a function of the humidity."""

    exponent: callable

    def state(self, contact):
        return InputState(contact, 0.6, None, BEAM)

    def responder(self, _state):
        def lengths(state):
            return arrest_length(ENERGIES * np.exp(self.exponent(state.humidity)), state.device.beam)

        return lambda states: Responses(np.array([lengths(state) for state in states]), np.mean)


def compared(exponent):
    """Linear and repeated change of such beams by the errors, with standard errors."""
    settings = Analytic(exponent)
    inputs = [
        one for block in number_blocks(settings.state(EMPTY), (*OF_BEAMS, *OF_AIR), STATED) for one in block.inputs
    ]
    slopes = stage_budget.slopes(inputs, settings.responder(None))
    budget = xr.Dataset(
        {
            "slope": ("input", slopes[:, 0]),
            "slope_error": ("input", slopes[:, 1]),
            "centre": ((), 1.0, {"response": S_SHAPE, "share": 0.0}),
        },
        coords={"input": [one.name for one in inputs]},
    )
    errors = {f"{name} of C1" if name != "humidity" else name: value for name, value in ERRORS.items()}
    return rerun.change_of_response(Result("C1", 0.6, budget, None), EMPTY, EMPTY, errors, settings)


def reported(numbers):
    """Warnings of a device with these numbers."""
    found = rerun.with_reruns(xr.Dataset(), ["C1, RH 0.6"], [numbers])
    return texts(tables_test_beams._nonlinear(found)), tables_test_beams.again(found)


def test_lengths_that_are_powers_of_the_inputs_change_as_in_the_linear_update():
    linear, _, again, _ = compared(lambda humidity: 5 * humidity)
    # ln l = 3/4 ln t + 1/2 ln h - 1/4 ln energy
    assert_allclose(linear, 0.75 * 0.1 - 0.5 * 0.05 - 5 * 0.02 / 4, rtol=1e-9)
    assert_allclose(again, linear, rtol=1e-9)
    assert reported((linear, 1e-6, again, 1e-6))[0] == []


def test_lengths_that_depend_on_the_humidity_otherwise_do_not_and_a_warning_says_so():
    numbers = compared(lambda humidity: 400 * (humidity - 0.6) ** 2)
    assert_allclose(numbers[2] - numbers[0], -400 * 0.02**2 / 4, rtol=1e-6)
    (sentence,), _ = reported(numbers)
    assert sentence.startswith("The update is not linear: ")
    assert "differ from it by -4 ± 0 % (C1, RH 0.6)." in sentence


def test_a_difference_within_its_errors_is_no_warning_and_is_stated():
    warnings, said = reported((0.05, 0.01, 0.07, 0.01))
    assert warnings == []
    assert "C1, RH 0.6: 7.0 ± 1.0 % (linear 5.0 ± 1.0 %)" in said


def test_dimensions_air_and_modulus_err_by_what_the_names_of_the_inputs_say():
    found = changed(InputState(None, 0.6, None, BEAM), {**ERRORS, "Young's modulus": -0.1})
    assert_allclose(found.device.thickness / BEAM.thickness, np.exp(0.1))
    assert_allclose(found.device.gap / BEAM.gap, np.exp(-0.05))
    assert_allclose(found.device.young_modulus / BEAM.young_modulus, np.exp(-0.1))
    assert_allclose(found.humidity, 0.62)
    assert changed(found, {}) == found


STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 3, "humidities": [0.67]}
STOPPER |= {"uncertainty": {"young_modulus_GPa": 5, "humidity": 0.01, "scan_um": 10}, "test_beams": ["T"]}
ARRAY = {"pair": "b", "length_um": 1500, "thickness_um": 2.6, "gap_um": 20, "width_um": 6}
ARRAY |= {"crack_lengths": [{"humidity": 0.67, "mean_um": 700, "std_um": 20, "beams": 10}]}
SECTIONS = {
    "devices": {"S1": STOPPER},
    "test_beams": {"T": ARRAY},
    "run": {"pairs": [], "studies": []},
    "contact": {"samples": 40, "model": "summits"},
    "studies": {
        "variants": dict.fromkeys(("van_der_waals", "psd", "every", "spacing_nm"), []),
    },
    "chaos": {"order": 2},
    "design": {
        "budget_beams": 40,
        "budget_samples": 40,
        "worst_humidities": [0.6, 0.7],
        "discrepancy": {"factor": 0.02, "slope": 0.0, "rest": 0.01},
    },
}


@pytest.fixture(scope="module")
def stopper():
    return stiction.Device("S1", Results.of(stiction.load(SECTIONS)))


def assert_as_computed_again(found, names):
    assert found.attrs["refused"] == ""
    assert found.again.values.tolist() == names
    assert np.all(np.abs(found.linear) > 0.01)  # the measured beams are longer than the computed ones
    np.testing.assert_array_less(
        np.abs(found.rerun - found.linear), 3 * np.hypot(found.linear_error, found.rerun_error)
    )


@pytest.mark.slow
def test_test_beams_and_device_are_computed_again_on_one_contact_of_each_patch(stopper):
    found = stopper.test_beams_again()
    assert_as_computed_again(found, ["S1, RH 0.67", "T, RH 0.67"])
    xr.testing.assert_equal(found.drop_dims("again"), stopper.test_beams())


@pytest.mark.slow
def test_an_error_of_one_step_gives_the_contact_of_the_slope_bit_for_bit(stopper):
    job = stopper.results.graph.job("devices/test_beams/rerun/S1")
    surfaces = {
        name: (stopper.results[f"heights/{name}"], stopper.results[f"spectrum/{name}"]) for name in ("B2", "Sub1")
    }
    pair, plain = job.settings["contacts"]["b_1000x1000"]
    found = rerun.at_mean(surfaces, pair, plain, {"rms of B2": 0.05}, {})
    slope = stopper.results["devices/contact/slopes/b_1000x1000_B2_rms_more"]
    xr.testing.assert_equal(found.reset_coords(drop=True), slope.drop_vars("difference").reset_coords(drop=True))
    same = rerun.at_mean(surfaces, pair, plain, dict.fromkeys(map(str, stopper.test_beams().input.values), 0.0), {})
    xr.testing.assert_allclose(same, stopper.contact, rtol=1e-5)


@pytest.mark.nightly
def test_test_beams_in_dry_air_are_computed_again_on_contacts_in_dry_air():
    measured = [{"humidity": "dry", "mean_um": 1450, "std_um": 40, "beams": 10}]
    dry = SECTIONS | {"attraction": {"reach": "all"}}
    dry |= {"devices": {"S1": STOPPER | {"humidities": ["dry"], "uncertainty": {"young_modulus_GPa": 40}}}}
    dry |= {"test_beams": {"T": ARRAY | {"length_um": 3000, "crack_lengths": measured}}}
    config = stiction.load(dry)
    config["studies"]["full_contact"]["samples"] = 3
    device = stiction.Device("S1", Results.of(config))
    assert_as_computed_again(device.test_beams_again(), ["S1, dry", "T, dry"])
    job = device.results.graph.job("devices/test_beams/rerun/S1")
    assert {pair for pair, _ in job.settings["contacts"].values()} == {"b_dry"}


@pytest.mark.slow
def test_inputs_for_which_nothing_can_be_computed_are_named_with_the_reason(stopper, monkeypatch):
    def refuse(*_):
        raise ValueError("no density")

    monkeypatch.setattr(rerun, "at_mean", refuse)
    job = stopper.results.graph.job("devices/test_beams/rerun/S1")
    found = job.compute(stopper.results.inputs(job))
    assert found.sizes["again"] == 0
    assert tables_test_beams.again(found).endswith("nothing can be computed again: no density.")
