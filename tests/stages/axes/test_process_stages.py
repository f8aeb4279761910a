"""Processes through all stages: today's roughness at a setting, brute force at the best one, pages and Python."""

import itertools
import pickle
import re
from dataclasses import replace

import drawn_curves
import numpy as np
import pytest
import xarray as xr
from legends import covering

import stiction
from stiction.contact.correction import Correction, ElasticChange
from stiction.contact.environment import Water
from stiction.devices.process import unknown
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.report.axes import process as sentences
from stiction.report.axes import section, tables
from stiction.report.devices import pages
from stiction.report.style import png
from stiction.stages.axes import law, margins, recommended, requirement
from stiction.stages.axes.process import values_of
from stiction.stages.surfaces.descriptions import description

SAMPLES, SHARE = 200, 0.05
BUMP = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 8, "humidities": [0.6]}
BARE = dict(BUMP)
BUMP |= {"requirement": {"share": SHARE}}
SECTIONS = {
    "contact": {"samples": SAMPLES, "model": "summits"},
    "design": {"worst_humidities": [0.45, 0.6], "budget_samples": 180},
    "run": {"pairs": [], "studies": []},
}


def setting(value, **numbers):
    """Setting by numbers, with errors of 2 %."""
    return {"value": value} | numbers | {"uncertainty": {key: abs(0.02 * one) for key, one in numbers.items()}}


#: Rougher with time, with pits at the end.
ETCH = {
    "variable": "etch_time_s",
    "surface": "B2",
    "settings": [
        setting(30, rms_nm=2.0, skewness=-0.3, kurtosis=3.1),
        setting(60, rms_nm=3.4, skewness=-0.4, kurtosis=3.2),
        setting(90, rms_nm=4.6, skewness=-0.7, kurtosis=3.6),
        setting(120, rms_nm=5.0, skewness=-1.2, kurtosis=4.7),
    ],
}
RMS = {"variable": "etch_time_s", "surface": "B2", "settings": [setting(30, rms_nm=2.0), setting(90, rms_nm=8.0)]}


def config(process, *more, **devices):
    """Configuration with one process."""
    return stiction.load(SECTIONS, {"process": {"etch": process}, "devices": devices}, *more)


@pytest.fixture(scope="module")
def etched():
    other = BUMP | {"contact_um": [0.8, 0.8], "restoring_force_uN": 7}
    return stiction.Process.of(config(ETCH, Bump=BUMP | {"process": "etch"}, Small=other | {"process": "etch"}), "etch")


@pytest.mark.slow
def test_a_setting_alone_is_todays_roughness_at_its_value_bit_for_bit():
    device = BUMP | {"process": "etch", "roughness": {"surface": "B2", "rms_nm": [2, 8]}}
    results = Results.of(config(RMS, Bump=device))
    for number, rough in ((0, 0), (6, 6)):
        ours, today = results[f"process/points/Bump_{number}"], results[f"devices/roughness/points/Bump_{rough}"]
        for name in ("safe", "estimate", "error", "stuck"):
            np.testing.assert_array_equal(ours[name], today[name])
    between = results["process/points/Bump_3"]
    np.testing.assert_array_equal(
        between.estimate, results["devices/roughness/points/Bump_3"].estimate
    )  # ln rms linear


def test_settings_smoother_than_the_surfaces_of_full_contact_are_flagged_and_no_others():
    """Their forces are corrected by the changes of the given surface, which are too small for them."""
    results = Results.of(config(RMS, Bump=BUMP | {"process": "etch"}))
    full = Correction(np.array([0.6]), ElasticChange(1.2), ElasticChange(1.3))
    given = float(results["heights/B2"].rms)
    for number, water in itertools.product((0, 6), (None, full)):
        job = results.graph.job(f"process/points/Bump_{number}")
        settings = job.stage.converted(job.settings | {"samples": 0})
        stopper = settings.device.stopper
        stopper = replace(stopper, water=replace(stopper.water, correction=water))
        settings = replace(settings, device=replace(settings.device, stopper=stopper))
        without_own = {name: value for name, value in results.inputs(job).items() if name != "model_error"}
        found = job.stage.result(without_own, job.at, settings)
        smoother = {0: 2.0e-9, 6: 8.0e-9}[number] < given
        assert smoother == (number == 0)
        assert (requirement.SMOOTHER.kind in str(found.flagged.values)) == (smoother and water is full)


@pytest.mark.slow
def test_a_cantilever_at_a_setting_is_that_of_todays_roughness_with_its_tip():
    beam = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 10, "width_um": 4, "humidities": [0.88]}
    beam |= {"requirement": {"share": SHARE, "length_um": 300}, "process": "etch"}
    beam |= {"roughness": {"surface": "B2", "rms_nm": [2, 8]}}
    small = {
        "contact": {"samples": 100, "model": "summits"},
        "chaos": {"order": 1},
        "design": {"beams": 200, "shares": [SHARE]},
    }
    results = Results.of(config(RMS, small, Lever=beam))
    job = results.graph.job("process/points/Lever_0")
    settings = job.stage.converted(job.settings | {"samples": 0})  # without slopes
    ours = job.stage.result(results.inputs(job), job.at, settings)
    today = results["devices/roughness/points/Lever_0"]
    for name in ("safe", "estimate", "error", "bound", "stuck"):
        np.testing.assert_array_equal(ours[name], today[name])


def test_a_setting_by_numbers_is_the_surface_with_these_numbers():
    corner = {"corner_rad_per_um": 15, "hurst": 0.9}
    first, last = (setting(value, **numbers, **corner) for value, numbers in ((30, _numbers(0)), (90, _numbers(2))))
    results = Results.of(config(ETCH | {"settings": [first, last]}, Bump=BUMP | {"process": "etch"}))
    given = description(results["heights/B2"], results["spectrum/B2"])
    made = law.on_law(given, results["process/laws/etch"], 30.0)
    assert (made.rms, made.skewness, made.kurtosis) == (2.0 * 1e-9, -0.3, 3.1)
    np.testing.assert_allclose((made.spectrum.corner, made.spectrum.slope), (15e6, -3.8), rtol=1e-8)
    assert made.spectrum.cutoff == given.spectrum.cutoff
    drawn = results["heights/etch-1"]  # the surface of the setting itself
    assert (float(drawn.rms), float(drawn.skewness), float(drawn.kurtosis)) == (2.0 * 1e-9, -0.3, 3.1)


def _numbers(number):
    """Stated numbers of a setting."""
    return {key: ETCH["settings"][number][key] for key in ("rms_nm", "skewness", "kurtosis")}


@pytest.mark.nightly
def test_the_margin_at_the_best_setting_is_that_of_other_samples_on_its_surface(etched):
    settings = etched.settings().sel(who="Bump")
    best = float(settings.best)
    quantities = etched.at(best).estimate.values
    numbers = dict(zip(("rms_nm", "skewness", "kurtosis"), [1e9 * np.exp(quantities[0]), *quantities[1:]], strict=True))
    brute = stiction.load(
        SECTIONS, {"surfaces": {"B2": numbers}, "devices": {"Bump": BARE}, "seed": 7}, {"contact": {"samples": 1000}}
    )
    forces = stiction.Device("Bump", Results.of(brute)).forces().pull_off.values[0]
    promised = float(np.interp(best, settings["value"], settings.margin))
    found = -np.log(np.quantile(forces, 1 - SHARE) / 8e-6)
    error = np.interp(best, *(etched.margins("Bump")[name].values.ravel() for name in ("value", "simulation_error")))
    assert abs(found - promised) < 3 * error
    assert abs(found - promised + 10 * error) > 3 * error  # control


@pytest.mark.slow
def test_the_band_has_all_errors_and_shrinks_with_those_of_the_settings(etched):
    curve = etched.margins("Bump")
    assert np.all(curve.law_error > 0)
    assert np.all(curve.simulation_error > 0)
    assert np.all(curve.model_error == 0)
    exact = [one | {"uncertainty": {key: 1e-6 for key in one["uncertainty"]}} for one in ETCH["settings"]]
    narrow = stiction.Process.of(config(ETCH | {"settings": exact}, Bump=BUMP | {"process": "etch"}), "etch")
    sure, known = (law.law_of(found.law) for found in (narrow, etched))
    variances = [np.einsum("nqq->nq", one.covariance_at(one.settings)) for one in (sure, known)]
    assert np.all(variances[0] < variances[1])
    assert np.all(variances[0] > 0), "four settings do not show that runs agree"


@pytest.mark.slow
def test_what_serves_all_devices_serves_each_and_has_the_smallest_margin(etched):
    found = etched.settings()
    assert list(found.who.values) == ["Bump", "Small", recommended.ALL]
    each = found.margin.sel(who=["Bump", "Small"]).min("who")
    np.testing.assert_allclose(found.margin.sel(who=recommended.ALL), each, atol=1e-12)


@pytest.mark.slow
def test_answers_name_the_settings_the_best_and_the_next(etched):
    first, *more = etched.answers("Bump")
    assert first.startswith(("Settings of the etch time from ", "No setting of the etch time from 30 to 120 s"))
    assert any(one.startswith("Measure ") and (" s next: " in one or " s again: " in one) for one in more)
    (together, *_) = etched.answers(recommended.ALL)
    assert together.startswith("All devices together: ")
    with pytest.raises(ValueError, match="device Other has no process over etch_time_s: Bump, Small"):
        etched.answers("Other")


def test_tables_figures_and_pages_show_them(etched):
    curve, settings = etched.margins("Bump"), etched.settings()
    table = tables.of_processes({"Bump": curve}, [settings], {"Bump": [etched.law]})
    assert list(table.frame.value) == list(curve.value)
    of_mean = np.sqrt((table.frame[["simulation_se", "law_se", "model_se"]] ** 2).sum(axis=1))
    np.testing.assert_allclose(table.frame.margin_se, of_mean)
    np.testing.assert_allclose(table.frame.margin_of_run_se, np.hypot(of_mean, table.frame.run_se))
    assert np.all(table.frame.run_se > 0.1 * of_mean), "without this, both errors would be nearly the same"
    assert "Bump: " + etched.answers("Bump")[0] in table.caption
    for figure in (etched.plot(), etched.plot("Bump")):
        assert covering(figure) == []
        assert png(figure)[:4] == b"\x89PNG"
    page = etched.results.graph.job("devices/Bump.html")
    assert section.inputs(etched.results.graph.plan, "Bump").items() <= page.inputs.items()
    assert pages._requirement(page.settings) == {"requirement": "at most 1 in 20 sticks"}


def test_a_process_shows_itself_pickles_and_says_what_there_is(etched):
    assert repr(etched) == "Process etch: B2 over the etch time, 30 to 120 s, 4 settings"
    again = pickle.loads(pickle.dumps(etched))
    xr.testing.assert_identical(again.law, etched.law)
    assert etched.devices == ["Bump", "Small"]
    with pytest.raises(ValueError, match="there is no process anneal; the configuration has etch"):
        stiction.Process.of(etched.results.graph.plan.config, "anneal")
    with pytest.raises(ValueError, match="known from 30 to 120, got 121"):
        etched.at(121)
    with pytest.raises(ValueError, match="no device has process etch"):
        stiction.Process.of(config(RMS, Bump=BARE), "etch").settings()


@pytest.mark.parametrize(("applied", "expected"), [(False, np.hypot(np.log(0.8), 0.05)), (True, 0.05)])
def test_the_error_of_the_model_is_its_change_or_if_applied_the_error_of_that(etched, applied, expected):
    model = xr.Dataset(
        {
            "factor": (("shape", "humidity"), [[0.8]]),
            "factor_error": (("shape", "humidity"), [[0.04]]),
            "applied": ("humidity", [applied]),
        },
        {"shape": ["force"], "humidity": [0.6]},
    )
    at = [etched.results[f"process/points/Bump_{number}"] for number in range(7)]
    named = {"variables": ["etch_time_s"], "processes": ["etch"], "surfaces": ["B2"]}
    with_model, without = (margins.compute(at, [etched.law], **named, model_error=error) for error in (model, None))
    np.testing.assert_allclose(with_model.model_error, expected)
    assert np.all(without.model_error == 0)
    wide, narrow = (
        recommended.compute({"Bump": one}, {"etch": etched.law}, "etch_time_s", 1) for one in (with_model, without)
    )
    # 1000 draws scatter by 0.017 at a single setting, twice the effect of the smaller error there.
    assert float((wide.safe - narrow.safe).mean()) < 0


def test_points_that_cannot_be_computed_are_named_and_nothing_is_recommended_without_any():
    settings = requirement.RequiredStopper(
        seed=1, water=Water(300.0), humidities=(0.6,), contact=(1e-6, 1e-6), share=0.05, restoring_force=1e-6
    )
    none = requirement.Response(np.nan, np.nan, np.nan, np.nan, (np.nan,) * 3)
    said = {"flagged": ("humidity", [""]), "refused": ("humidity", ["too smooth"])}
    refused = requirement.layout([[none]], 200, settings).assign(said)
    slopes = {"slopes": (("humidity", "shape", "law_quantity"), np.full((1, 1, 1), np.nan))}
    known = Results.of(config(RMS, Bump=BUMP | {"process": "etch"}))["process/laws/etch"]
    at = [refused.assign(value=float(value)).assign(slopes) for value in (30, 60, 90)]
    curve = margins.compute(at, [known], ["etch_time_s"], ["etch"], ["B2"])
    found = recommended.compute({"Bump": curve}, {"etch": known}, "etch_time_s", 1)
    assert sentences.answers(found, "Bump") == [
        "Settings of the etch time that suffice are not known: too few could be computed."
    ]
    assert "Not computed where the etch time is 30 s, 60 s, 90 s: too smooth." in sentences.notes(curve, [known])


#: Best setting, end that it is in every draw, and the other end.
ENDS = [(120.0, "above", 30.0), (30.0, "below", 120.0)]


def _known(best, sufficient, following=np.nan, again=False, ends=(30, 120)):
    """Recommendation with a best setting that is certain."""
    values = np.linspace(*ends, 7)
    numbers = {"best": [best], "error": [0.0], "interval": [[best, best]], "before": [2.0], "after": [1.0]}
    numbers |= {"next": [following], "again": [again]}
    found = replace(unknown(values), **{name: np.array(one) for name, one in numbers.items()}, subject="range")
    ranges = {"sufficient": (("range", "end"), np.reshape(sufficient, (-1, 2))), "share": SHARE}
    layout = recommended.layout(found).drop_dims("range").assign(ranges).expand_dims(who=["Bump"])
    return layout.assign_attrs(variable="etch_time_s")


@pytest.mark.parametrize(("best", "side", "other"), ENDS)
def test_where_no_setting_suffices_and_an_end_is_the_best_settings_beyond_it_are_advised(best, side, other):
    beyond = f"The best setting is the end of the measured range: measure settings {side} {best:g} s."
    assert sentences.answers(_known(best, []), "Bump")[1:] == [beyond]
    enough = sentences.answers(_known(best, [tuple(sorted((best, best + (other - best) / 9)))]), "Bump")
    inside = sentences.answers(_known(75.0, []), "Bump")
    assert beyond not in enough + inside


@pytest.mark.parametrize(("again", "when"), [(True, "again"), (False, "next")])
def test_a_setting_that_is_measured_already_is_advised_again(again, when):
    *_, last = sentences.answers(_known(75.0, [(60.0, 90.0)], 60.0, again), "Bump")
    assert last.startswith(f"Measure 60 s {when}: ")


@pytest.mark.parametrize(("low", "high"), [(0.03, 0.12), (30.0, 120.0), (1000.0, 1050.0), (120_000.0, 300_000.0)])
def test_settings_are_shown_as_closely_as_their_range_is_wide(low, high):
    exact = [low + part * (high - low) for part in (0.3147, 0.6853, 0.5219, 0.8141)]
    said = " ".join(sentences.answers(_known(exact[2], [tuple(exact[:2])], exact[3], ends=(low, high)), "Bump"))
    found = re.search(r"from (\S+) to (\S+) s leave .*, best (\S+) s.*Measure (\S+) s", said).groups()
    np.testing.assert_allclose(list(map(float, found)), exact, rtol=0, atol=0.005 * (high - low))
    assert all(len(one.replace(".", "").lstrip("0")) <= 6 for one in found)
    assert "e" not in "".join(found)


@pytest.mark.slow
def test_both_surfaces_of_a_pair_change_together():
    polish = {"variable": "etch_time_s", "surface": "Sub1", "together_with": "etch"}
    polish |= {"settings": [setting(30, rms_nm=0.2), setting(90, rms_nm=3.0)]}
    both = stiction.load(
        SECTIONS, {"process": {"etch": RMS, "polish": polish}, "devices": {"Bump": BUMP | {"process": "etch"}}}
    )
    alone = Results.of(config(RMS, Bump=BUMP | {"process": "etch"}))
    together = stiction.Process.of(both, "etch").margins("Bump")
    assert list(together.law_process.values) == ["etch", "polish"]
    assert together.surface == "B2 and Sub1"
    rougher = float(alone["process/points/Bump_6"].estimate[0, 0]), float(together.estimate[-1, 0, 0])
    assert rougher[1] < 0.9 * rougher[0]


def test_values_are_within_the_settings_of_all_processes_of_a_device():
    polish = RMS | {"surface": "Sub1", "together_with": "etch"}
    polish["settings"] = [setting(value, rms_nm=2.0) for value in (20, 50, 100)]
    both = stiction.load(
        SECTIONS, {"process": {"etch": ETCH, "polish": polish}, "devices": {"Bump": BUMP | {"process": "etch"}}}
    )
    values = values_of(Plan(both), "Bump")
    assert (values[0], values[-1]) == (30, 100)
    assert {50, 60, 90} < {*values}


def test_a_device_of_which_one_air_and_end_state_is_unknown_has_no_settings():
    curve, _ = drawn_curves.etched(is_beam=True)
    curve = xr.concat([curve, curve.assign_coords(shape=["other"])], "shape", data_vars="minimal", coords="minimal")
    gap = curve.assign(margin=curve.margin.where((curve.humidity != 0.6) | (curve["shape"] != "other")))
    known, none = (
        recommended.compute({"D": one}, {"etch": drawn_curves.law_of()}, drawn_curves.VARIABLE, 1)
        for one in (curve, gap)
    )
    assert np.isnan(none.safe).all()
    assert not np.isnan(known.safe).all()
