"""Errors that finite scans leave in the adhesion energy: slopes times covariance, and the known value of B2."""

import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import small
import xarray as xr
from drawn_scans import published
from numpy.testing import assert_allclose
from plans import job_settings
from published import SURFACES

from stiction.analysis.shifts import ORDERS
from stiction.analysis.variants import relative_shift
from stiction.config.merging import merged
from stiction.models import MODE_QUANTITIES, MOMENT_QUANTITIES, SPECTRUM_QUANTITIES
from stiction.plan.plan import Plan
from stiction.scans.estimate import Settings as Evaluation
from stiction.scans.model_scans import SurfaceModel
from stiction.scans.moments import mode_covariance
from stiction.scans.quantiles import SCORES, measured_density
from stiction.scans.reading import ScanFile
from stiction.scans.scan import Frame
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact import curves
from stiction.stages.contact.changes import quantities
from stiction.stages.laws import scan_uncertainty, slopes
from stiction.stages.laws.scan_uncertainty import GOAL, ScanErrors, scans_needed
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import measured_heights, measured_spectrum
from stiction.stages.surfaces import scan as stage_scan
from stiction.stages.surfaces import spectrum as stage_spectrum
from stiction.stages.surfaces.spectrum import SpectrumUse
from stiction.streams import stream

HUMIDITIES = (0.44, 0.67, 0.88)
MODES = MODE_QUANTITIES[1:]
QUANTITIES = [*MOMENT_QUANTITIES, *SPECTRUM_QUANTITIES, *MODES]
#: Slopes at the humidities, and those of the modes.
SLOPES = np.array([[-6.0, -5.0, -1.6], [-6.5, -4.0, -1.0], [-1.5, -1.0, -0.3], [-0.5, -0.3, -0.1], [0.4, 0.2, 0.1]])
SLOPES = np.vstack([SLOPES, np.outer([1.5, -14, -16, -10, 1.4, 12, 9], [1, 0.5, 0.1])])
ERRORS = ScanErrors(
    names=MOMENT_QUANTITIES,
    heights=np.array([[2.6e-4, -2.4e-4, 3e-4], [-2.4e-4, 1.9e-3, -5.3e-3], [3e-4, -5.3e-3, 2.0e-2]]),
    modes=np.diag(np.linspace(0.019, 0.009, 7) ** 2),
    spectrum=np.array([[1.9e-4, -1e-5], [-1e-5, 9e-6]]),
    scans=1,
)
WANTED = replace(
    small.settings_of(scan_uncertainty, job_settings(small.PLAN, "studies/scan_uncertainty/b")), humidities=HUMIDITIES
)


def study(errors=ERRORS, values=SLOPES, choices=None):
    dataset = slopes.layout(QUANTITIES, HUMIDITIES, values, 0.1 * np.abs(values))
    surfaces = {"B2": dataset, "Sub1": dataset}
    return scan_uncertainty.compute(
        surfaces, dict.fromkeys(surfaces, errors), small.contact_of_pair(), choices or {}, WANTED
    )


@pytest.mark.parametrize(
    ("quantities", "names"), [(QUANTITIES, MOMENT_QUANTITIES), (MODE_QUANTITIES + SPECTRUM_QUANTITIES, MODE_QUANTITIES)]
)
def test_errors_are_those_of_the_heights_that_have_slopes(quantities, names):
    modes, fit = np.diag(np.arange(1.0, 9.0)), np.diag([7.0, 8.0, 9.0])
    covariances = {"covariance": ERRORS.heights, "mode_covariance": modes, "fit_covariance": fit}
    estimate = xr.Dataset({name: ((f"{name}_1", f"{name}_2"), value) for name, value in covariances.items()})
    found = scan_uncertainty.errors_of(estimate.assign(files="a\nb"), quantities)
    assert (found.names, found.scans) == (names, 2)
    assert_allclose(found.heights, ERRORS.heights if names == MOMENT_QUANTITIES else modes)
    assert_allclose(np.diag(found.modes), np.arange(2, 9))
    assert_allclose(np.diag(found.spectrum), [8, 9])
    of_slopes = slopes.layout(quantities, HUMIDITIES, *np.zeros((2, len(quantities), len(HUMIDITIES))))
    by_surface = scan_uncertainty.errors_by_surface({"B2": of_slopes}, {"B2": estimate.assign(files="a\nb")})
    assert [found.names for found in by_surface.values()] == [names]


def test_parts_add_up_with_their_correlations():
    found = study().sel(surface="B2")
    for k in range(3):
        g = SLOPES[:3, k]
        of = {part: float(found.error.sel(part=part)[k]) for part in found.part.values}
        assert of["rms"] == pytest.approx(abs(g[0]) * np.sqrt(ERRORS.heights[0, 0]))
        assert of["shape"] == pytest.approx(np.sqrt(g[1:] @ ERRORS.heights[1:, 1:] @ g[1:]))
        assert of["spectrum"] == pytest.approx(np.sqrt(SLOPES[3:5, k] @ ERRORS.spectrum @ SLOPES[3:5, k]))
        assert of["total"] == pytest.approx(np.hypot(np.sqrt(g @ ERRORS.heights @ g), of["spectrum"]))
    independent = np.sqrt(SLOPES[1:3, 0] ** 2 @ np.diag(ERRORS.heights)[1:])
    assert float(found.error.sel(part="shape")[0]) < 0.6 * independent


def test_surfaces_of_a_pair_add_up_as_independent():
    found = study()
    assert_allclose(found.pair_error, np.sqrt(2) * found.error.sel(surface="B2", part="total"), rtol=1e-12)
    assert scan_uncertainty.pair_errors(found)[0.67] == pytest.approx(float(found.pair_error[1]))


@pytest.mark.slow
def test_the_error_of_the_slopes_is_carried_on_to_the_error_by_the_scans():
    # Slopes drawn around the given ones, with a scatter of a tenth of them; 400 draws know a scatter to 3.5 %.
    draws = [SLOPES * (1 + 0.1 * stream(1, "slopes", k).standard_normal(SLOPES.shape)) for k in range(400)]
    scatter = np.std([study(values=drawn).error.sel(surface="B2", part="total") for drawn in draws], axis=0)
    found = study()
    assert_allclose(found.error_sampling.sel(surface="B2"), scatter, rtol=0.15)
    assert_allclose(found.pair_error_sampling, found.error_sampling.sel(surface="B2"), rtol=1e-9)


@pytest.mark.parametrize("scans", [1, 3])
def test_the_scans_needed_of_one_surface_reach_the_goal_and_one_scan_less_does_not(scans):
    errors = np.array([[0.02, 0.051, 0.129, 0.5]])
    needed = scans_needed(errors, scans, GOAL)
    assert np.all(errors * np.sqrt(scans / needed) <= GOAL)
    fewer = needed > 1
    assert np.all(errors[fewer] * np.sqrt(scans / (needed[fewer] - 1)) > GOAL)
    assert list(study(replace(ERRORS, scans=scans)).scans.values) == [scans, scans]


@pytest.mark.parametrize(
    ("errors", "scans"),
    [
        ((0.2, 0.1), (3, 2)),
        ((0.0796, 0.0074), (3, 2)),  # the example of the documentation: rounding the continuous optimum up gives 9 + 1
        ((0.3, 0.31), (1, 1)),
        ((0.01, 0.02), (1, 1)),
        ((0.12, 0.001), (1, 4)),
        *((stream(1, "errors", k).uniform(0.02, 0.3, 2), (1 + k % 3, 1)) for k in range(20)),
    ],
)
def test_the_scans_needed_of_two_surfaces_bring_the_pair_to_the_goal_with_the_fewest_scans(errors, scans):
    needed = scans_needed(np.array(errors)[:, None], np.array(scans)[:, None], GOAL)[:, 0]

    def of_pair(*numbers):
        return np.sqrt(np.sum(np.square(errors) * scans / numbers))

    assert of_pair(*needed) <= GOAL * (1 + 1e-9)
    fewest = min(m + n for m in range(1, 150) for n in range(1, 150) if of_pair(m, n) <= GOAL)
    assert needed.sum() == fewest
    assert of_pair(*needed) == pytest.approx(min(of_pair(m, fewest - m) for m in range(1, fewest)), rel=1e-12)


def test_a_surface_without_an_error_needs_no_scan_and_an_error_at_the_goal_no_further_one():
    assert scans_needed(np.array([[0.05], [0.0]]), 1, GOAL).tolist() == [[1], [0]]
    numbers = np.arange(1, 40)
    assert np.any((GOAL * np.sqrt(numbers) / GOAL) ** 2 > numbers)  # rounding errors
    assert scans_needed(np.array([0 * numbers, GOAL * np.sqrt(numbers)]), 1, GOAL).tolist() == [[0] * 39, [*numbers]]


def test_choices_are_compared_on_the_same_samples():
    base = small.contact_of_pair()
    stiff = base.assign(solid_pressure=1.2 * base.solid_pressure)
    found = study(choices={"beyond": stiff.isel(strip=slice(10))})
    assert list(found.choice.values) == ["beyond"]
    for k, h in enumerate(HUMIDITIES):
        energies = [curves.energies(contact.isel(strip=slice(10)), h, WANTED.water) for contact in (stiff, base)]
        assert_allclose([found.change[0, k], found.change_error[0, k]], relative_shift(*energies), rtol=1e-9)
    assert np.all(found.change < 0)
    assert np.all(found.change_error_scans == 0)


@pytest.mark.parametrize("names", [MOMENT_QUANTITIES, MODE_QUANTITIES])
def test_the_effect_of_the_form_of_the_heights_has_the_error_of_the_measured_form(names):
    covariance = np.diag([1e-4, *np.diag(ERRORS.modes)]) if names == MODE_QUANTITIES else ERRORS.heights
    choices = {"beyond": small.contact_of_pair(), "heights": small.contact_of_pair()}
    found = study(replace(ERRORS, names=names, heights=covariance), choices=choices)
    of_one = np.sqrt(np.einsum("ih,ij,jh->h", SLOPES[5:], ERRORS.modes, SLOPES[5:]))
    assert_allclose(found.change_error_scans.sel(choice="heights"), np.sqrt(2) * of_one, rtol=1e-9)
    if names == MODE_QUANTITIES:
        assert_allclose(found.error.sel(surface="B2", part="shape"), of_one, rtol=1e-9)


#: Standard error of ln ē of pair b by one scan of 10 µm x 10 µm, of it by its spectrum: scatter of drawn scans.
KNOWN, BY_SPECTRUM = np.array([0.129, 0.092, 0.029]), np.array([0.024, 0.012, 0.002])


def wide(name, samples):
    """Settings of pair b with strips of 30 µm."""
    plan = Plan(small.PLAN.config | {"beam": small.PLAN.config["beam"] | {"width_um": 30}})
    return merged(job_settings(plan, name), {"contact": {"samples": samples}})


@cache
def slopes_of_b2():
    """Slopes of ln ē of pair b to the quantities of B2."""
    settings = small.settings_of(quantities, wide("studies/slopes/contact/b_B2_rms_less", 300))
    (moments, spectrum), substrate = small.surfaces()
    form = measured_density(SURFACES["B2"].density.quantile_of_normal(SCORES), 2036)
    measured = stage_heights.layout(form, stage_heights.moments(moments))
    contacts = {
        name: quantities.compute(
            [(measured if name in MODES else moments, spectrum), substrate], "b", "B2", name, settings
        )
        for name in QUANTITIES
    }
    less, more = ({name: pair[k] for name, pair in contacts.items()} for k in (0, 1))
    return slopes.compute(less, more, WANTED)


@cache
def estimates():
    """Estimates of single scans of B2."""
    maps = (stage_scan.layout(ScanFile(drawn, "Height", "nm", ())) for drawn in published("B2", 10e-6, 6, "loop"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return [stage_estimate.compute([one], "Etched", stage_estimate.Settings(1, Evaluation(), 24)) for one in maps]


def predicted(errors):
    """Standard errors of ln ē by the scans of B2, (parts, n_rh)."""
    found = scan_uncertainty.compute({"B2": slopes_of_b2()}, {"B2": errors}, small.contact_of_pair(), {}, WANTED)
    return found.error.sel(surface="B2").values


@pytest.mark.nightly
def test_one_scan_of_b2_leaves_the_known_errors():
    surface = SURFACES["B2"]
    model = SurfaceModel(surface.density, surface.spectrum, 1e-6, surface.rms, Frame((500, 500), (1e-5, 1e-5)))
    modes = mode_covariance(model.translation, model.overlaps, ORDERS)[1:, 1:]
    errors = ScanErrors(MOMENT_QUANTITIES, model.covariance, modes, np.diag([0.0145**2, 0.0035**2]), 1)
    choices = {"heights": small.contact_of_pair()}
    found = scan_uncertainty.compute({"B2": slopes_of_b2()}, {"B2": errors}, small.contact_of_pair(), choices, WANTED)
    *_, by_spectrum, total = found.error.sel(surface="B2").values
    assert_allclose(total, KNOWN, rtol=0.12)
    assert by_spectrum[0] < 0.4 * total[0]
    # Scatter by the measured form, of whose modes the prediction has those up to order 8.
    assert_allclose(found.change_error_scans[0], [0.41, 0.24, 0.04], rtol=0.3)


@pytest.mark.nightly
def test_errors_that_scans_predict_are_the_known_ones():
    of_scans = [predicted(scan_uncertainty.errors_of(found, QUANTITIES)) for found in estimates()]
    *_, by_spectrum, total = np.mean(of_scans, axis=0)
    assert abs(total[0] - KNOWN[0]) < 0.015
    assert_allclose(total, KNOWN, rtol=0.15)
    assert_allclose(by_spectrum, BY_SPECTRUM, rtol=0.5)  # scatter of 24 scans, known to 15 %


def energies_of(beam, settings):
    """Mean adhesion energies of pair b with another surface under the beam, (n_rh,) [J m⁻²]."""
    contact = stage_contact.compute((beam, small.surfaces()[1]), "b", "NG", settings)
    return np.array([curves.energies(contact, h, WANTED.water).mean() for h in HUMIDITIES])


@pytest.mark.nightly
def test_energies_from_single_scans_are_those_of_the_surface_within_the_known_error():
    settings = small.settings_of(stage_contact, wide("contact/b_NG", 100))
    true, spectrum = small.surfaces()[0][0], SURFACES["B2"].spectrum
    use = measured_spectrum.Settings("fitted", "cut", 10e-9, SpectrumUse("Etched", 1.5e-6, 1e-6))
    ratios, by_spectrum = [], []
    for found in estimates():
        end = stage_estimate.reach(found).end
        assert end == pytest.approx(spectrum.cutoff, rel=0.005)
        # Equal cut-offs give equal random numbers.
        exact = replace(spectrum, cutoff=end, floor=spectrum.plateau * (end / spectrum.corner) ** spectrum.slope)
        truth = energies_of((true, stage_spectrum.on_grid(exact, true, 10e-9)), settings)
        heights = measured_heights.compute(found, "Etched", "moments")
        for of, kept in ((heights, ratios), (true, by_spectrum)):
            beam = of, measured_spectrum.compute(found, of, use)
            kept.append(np.log(energies_of(beam, settings) / truth))
    assert np.all(np.abs(ratios) < 3 * KNOWN)
    assert np.all(np.mean(np.abs(ratios), axis=0)[:2] < [0.15, 0.1])
    for found, error in ((ratios, KNOWN), (by_spectrum, BY_SPECTRUM)):
        assert np.all(np.abs(np.mean(found, axis=0)) < 3 * error / np.sqrt(len(found))), "unbiased within its error"
