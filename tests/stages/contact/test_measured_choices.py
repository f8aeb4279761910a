"""The other choices of how scans are evaluated, and the slopes of surfaces that are described by scans."""

import warnings

import numpy as np
import pytest
import small
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings
from published import SURFACES
from written_scans import etched, scans_of

from stiction.analysis.shifts import ORDERS
from stiction.config.files import load
from stiction.config.scans import quantities as measured_quantities
from stiction.models import MODE_QUANTITIES, MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.plan.plan import Plan
from stiction.scans.histogram import EDGES, histogram
from stiction.scans.levelling import Levelling, level
from stiction.scans.moments import mode_covariance, overlap_integrals
from stiction.scans.quantiles import quantiles
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact.changes import quantities
from stiction.stages.contact.changes import scan_options as choices
from stiction.stages.devices import uncertain_inputs as inputs
from stiction.stages.laws import scan_uncertainty
from stiction.stages.surfaces import descriptions, estimate, parameters, scan
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import measured_heights as heights
from stiction.stages.surfaces import measured_spectrum as spectrum
from stiction.surface.empirical import MeasuredDensity


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return scans_of(tmp_path_factory.mktemp("scans"), count=2)


def plan_of(files, **keys):
    return Plan(load(small.PLAN.config, etched(*files, **keys)))


@pytest.fixture(scope="module")
def plan(files):
    return plan_of(files)


@pytest.fixture(scope="module")
def estimated(plan):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        read = [
            scan.compute(path, small.settings_of(scan, job_settings(plan, f"scan/Etched_{number}")))
            for number, path in plan.scans.files("Etched").items()
        ]
        return estimate.compute(read, "Etched", small.settings_of(estimate, job_settings(plan, "estimate/Etched")))


def surfaces(plan, estimated):
    """Datasets (heights, spectrum) of both surfaces of pair b."""
    found = heights.compute(estimated, **job_settings(plan, "heights/Etched"))
    settings = small.settings_of(spectrum, job_settings(plan, "spectrum/Etched"))
    return (found, spectrum.compute(estimated, found, settings)), small.surfaces()[1]


@pytest.fixture
def asked(monkeypatch):
    """Arguments of the contact that is asked for."""
    kept, contact = [], small.contact_of_pair()
    monkeypatch.setattr(stage_contact, "compute", lambda *given: kept.extend(given) or contact)
    return kept


def settings_of(plan):
    return small.settings_of(choices, job_settings(plan, "studies/choices/b_beyond"))


#: Largest wave number of B2 [rad/m]; the scans have no shorter waves.
END = SURFACES["B2"].spectrum.cutoff


@pytest.mark.parametrize(("beyond", "expected"), [("cut", np.pi / 10e-9), ("continued", END)])
def test_the_other_end_of_the_spectrum_is_that_of_the_grid_or_of_the_scans(files, estimated, asked, beyond, expected):
    plan = plan_of(files, beyond=beyond)
    given = surfaces(plan, estimated)
    choices.compute(given, {"Etched": estimated}, "b", "beyond", settings_of(plan))
    ((found, shape), substrate), pair, model, _ = asked
    assert parameters.spectrum_of(shape).cutoff == pytest.approx(expected, rel=0.01)
    assert parameters.spectrum_of(given[0][1]).cutoff != pytest.approx(expected, rel=0.01)
    assert_allclose(found.density, given[0][0].density)
    assert substrate is given[1]
    assert (pair, model) == ("b", "NG")


@pytest.mark.parametrize("source", ["moments", "measured"])
def test_the_other_heights_are_measured_or_of_the_moments(files, estimated, asked, source):
    plan = plan_of(files, heights=source)
    choices.compute(surfaces(plan, estimated), {"Etched": estimated}, "b", "heights", settings_of(plan))
    ((found, shape), _), *_ = asked
    assert isinstance(stage_heights.density(found, "NG"), MeasuredDensity) == (source == "moments")
    assert parameters.spectrum_of(shape).cutoff == pytest.approx(END, rel=0.01)


def test_moments_without_a_density_leave_the_measured_one(files, estimated, asked):
    plan = plan_of(files, heights="measured")
    without = estimated.assign(feasible=("shape", np.full(3, np.nan)))
    choices.compute(surfaces(plan, estimated), {"Etched": without}, "b", "heights", settings_of(plan))
    assert isinstance(stage_heights.density(asked[0][0][0], "NG"), MeasuredDensity)


def test_the_contact_of_a_choice_has_the_samples_of_the_slopes(plan):
    assert settings_of(plan).contact.samples == 20
    assert set(settings_of(plan).sources) == {"Etched"}
    assert settings_of(plan).sources["Etched"] == choices.EstimateParts("moments", "fitted", "cut")


def test_the_contact_of_a_choice_has_no_more_samples_than_that_of_the_pair_with_which_it_is_compared(files):
    few = Plan(load(small.PLAN.config, {"contact": {"samples": 15}}, etched(*files)))
    assert few.config["studies"]["slopes"]["samples"] > 15
    assert settings_of(few).contact.samples == 15


# What the estimate keeps for the sheet and for the errors


def test_the_estimate_keeps_the_levelled_map_and_the_histogram(plan, estimated):
    files = plan.scans.files("Etched").items()
    wanted = {n: small.settings_of(scan, job_settings(plan, f"scan/Etched_{n}")) for n, _ in files}
    read = [scan.scan_of(scan.compute(path, wanted[n])) for n, path in files]
    levelled = [level(one.heights, Levelling()) for one in read]
    assert_allclose(estimated.elevation, levelled[0], atol=1e-14)
    corrected = histogram(levelled, quantiles(levelled), estimated["quantile"].values)
    assert_allclose(estimated.histogram, corrected, rtol=1e-6, atol=1e-6)
    assert np.abs(corrected - histogram(levelled, *[quantiles(levelled)] * 2)).max() > 1e-4
    assert_array_equal(estimated.edge, EDGES)
    assert np.all(estimated.histogram_error.values[20:40] > 0)


def test_modes_have_the_errors_of_all_scans_together(estimated):
    surface = SURFACES["B2"]
    overlaps = overlap_integrals(surface.underlying, (5e-6, 5e-6), 5e-6, 24)
    expected = mode_covariance(surface.translation, overlaps, ORDERS) / 2
    rms, *shape = estimated.places.values[:3]
    of_another_place = np.sqrt(np.diag(expected)) * [rms, *[max(shape)] * (len(expected) - 1)]
    assert_allclose(np.sqrt(np.diag(estimated.mode_covariance)), of_another_place, rtol=0.1)
    assert tuple(estimated["mode"].values) == MODE_QUANTITIES


@pytest.mark.parametrize(("source", "names"), [("moments", MOMENT_QUANTITIES), ("measured", MODE_QUANTITIES)])
def test_quantities_of_the_plan_are_those_of_the_surface_and_have_errors(files, estimated, source, names):
    plan = plan_of(files, heights=source)
    own = descriptions.description(*surfaces(plan, estimated)[0]).quantities
    assert own == measured_quantities(plan.config["surfaces"]["Etched"]) == names + SPECTRUM_QUANTITIES
    assert sorted(plan.quantities("Etched")) == sorted({*own, *MODE_QUANTITIES[1:]})
    assert plan.quantities("Sub1") == MOMENT_QUANTITIES + SPECTRUM_QUANTITIES
    assert (plan.scanned_pairs, plan.scans.sides("b")) == (["b"], ["Etched"])
    errors = scan_uncertainty.errors_of(estimated, plan.quantities("Etched"))
    assert errors.names == names
    assert errors.scans == 2
    assert errors.heights.shape == (len(names), len(names))
    assert_allclose(errors.heights[0, 0], float(estimated.covariance[0, 0]), rtol=0.05)
    assert_allclose(errors.spectrum, estimated.fit_covariance[1:, 1:])
    assert_allclose(errors.modes, estimated.mode_covariance[1:, 1:])


@pytest.mark.parametrize("quantity", ["mode3", "rms"])
def test_slopes_of_measured_heights_keep_their_form_but_for_a_mode(files, estimated, monkeypatch, quantity):
    asked, contact = [], small.contact_of_pair()
    monkeypatch.setattr(stage_contact, "compute_each", lambda *given: asked.extend(given[0]) or [contact, contact])
    plan = plan_of(files, heights="measured")
    given = surfaces(plan, estimated)
    settings = small.settings_of(quantities, job_settings(plan, "studies/slopes/contact/b_Etched_rms_less"))
    _, found = quantities.compute(given, "b", "Etched", quantity, settings)
    changed, before = asked[1][0][0], given[0][0]
    u = np.array([-2.0, 0.0, 2.0])
    forms = [stage_heights.density(of, "NG").quantile_of_normal(u) for of in (changed, before)]
    if quantity == "rms":
        assert_allclose(*forms)
        assert float(changed.rms / before.rms) == pytest.approx(np.exp(0.05))
    else:
        # u² - 1 raises both tails against the middle.
        assert np.all((forms[0] - forms[1])[[0, 2]] > (forms[0] - forms[1])[1])
        assert float(changed.rms) == float(before.rms)
    assert quantities.difference(found) == pytest.approx(0.1 if quantity == "rms" else 0.04)


def test_modes_of_a_surface_with_the_heights_of_its_moments_are_those_of_its_measured_heights(
    files, estimated, monkeypatch
):
    asked, contact = [], small.contact_of_pair()
    monkeypatch.setattr(stage_contact, "compute_each", lambda *given: asked.append(given[0]) or [contact, contact])
    for plan in (plan_of(files), plan_of(files, heights="measured")):
        settings = small.settings_of(quantities, job_settings(plan, "studies/slopes/contact/b_Etched_rms_less"))
        quantities.compute(surfaces(plan, estimated), "b", "Etched", "mode4", settings, estimated)
    for from_moments, from_measured in zip(*asked, strict=True):
        for ours, theirs in zip(from_moments[0], from_measured[0], strict=True):
            xr.testing.assert_allclose(ours, theirs, rtol=1e-6)


@pytest.mark.parametrize(("form", "names"), [("moments", MOMENT_QUANTITIES), ("measured", MODE_QUANTITIES)])
def test_the_budget_of_a_device_takes_the_covariance_of_the_estimate(files, estimated, form, names):
    plan = plan_of(files, heights=form)
    drawn = heights.compute(estimated, **job_settings(plan, "heights/Etched"))
    found = inputs.scan_errors(estimated, drawn)
    assert found.quantities == (*names, *SPECTRUM_QUANTITIES)
    of_heights = estimated.covariance if form == "moments" else estimated.mode_covariance
    assert_array_equal(found.covariance[: len(names), : len(names)], of_heights)
    assert_array_equal(found.covariance[len(names) :, len(names) :], estimated.fit_covariance[1:, 1:])
    assert not np.any(found.covariance[: len(names), len(names) :])
    described = {"Etched": (drawn, None)}
    assert inputs.covariances(described, {"Etched": estimated}, None)["Etched"].quantities == found.quantities
