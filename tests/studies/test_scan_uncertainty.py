"""Errors that finite scans leave in the adhesion energy: slopes times covariance, and the known value of B2."""

from dataclasses import replace

import numpy as np
import pytest
import small
from drawn_scans import published
from numpy.testing import assert_allclose
from published import SURFACES

from stiction.analysis.variants import relative_shift
from stiction.config import jobs
from stiction.config.plan import Plan
from stiction.measured import estimate as stage_estimate
from stiction.measured import heights as measured_heights
from stiction.measured import scan as stage_scan
from stiction.measured import spectrum as measured_spectrum
from stiction.models import OF_MOMENTS, OF_SPECTRUM
from stiction.scans.estimate import Settings as Evaluation
from stiction.scans.model_scans import SurfaceModel
from stiction.scans.reading import ScanFile
from stiction.scans.scan import Frame
from stiction.stages import contact as stage_contact
from stiction.stages import curves
from stiction.stages.spectrum import Use
from stiction.studies import scan_uncertainty, slope_contact, slopes
from stiction.studies.scan_uncertainty import GOAL, Errors, scans_needed

HUMIDITIES = (0.44, 0.67, 0.88)
QUANTITIES = [*OF_MOMENTS, *OF_SPECTRUM]
#: Slopes at the humidities.
SLOPES = np.array([[-6.0, -5.0, -1.6], [-6.5, -4.0, -1.0], [-1.5, -1.0, -0.3], [-0.5, -0.3, -0.1], [0.4, 0.2, 0.1]])
ERRORS = Errors(
    names=OF_MOMENTS,
    heights=np.array([[2.6e-4, -2.4e-4, 3e-4], [-2.4e-4, 1.9e-3, -5.3e-3], [3e-4, -5.3e-3, 2.0e-2]]),
    spectrum=np.array([[1.9e-4, -1e-5], [-1e-5, 9e-6]]),
    scans=1,
)
WANTED = replace(small.settings_of(slopes, jobs.sensitivity(small.PLAN, "b")), humidities=HUMIDITIES)


def study(errors=ERRORS, values=SLOPES, choices=None):
    dataset = slopes.layout(QUANTITIES, HUMIDITIES, values, 0.1 * np.abs(values))
    surfaces = {"B2": dataset, "Sub1": dataset}
    return scan_uncertainty.compute(
        surfaces, dict.fromkeys(surfaces, errors), small.contact_of_pair(), choices or {}, WANTED
    )


def test_parts_add_up_with_their_correlations():
    found = study().sel(surface="B2")
    for k in range(3):
        g = SLOPES[:3, k]
        of = {part: float(found.error.sel(part=part)[k]) for part in found.part.values}
        assert of["rms"] == pytest.approx(abs(g[0]) * np.sqrt(ERRORS.heights[0, 0]))
        assert of["shape"] == pytest.approx(np.sqrt(g[1:] @ ERRORS.heights[1:, 1:] @ g[1:]))
        assert of["spectrum"] == pytest.approx(np.sqrt(SLOPES[3:, k] @ ERRORS.spectrum @ SLOPES[3:, k]))
        assert of["total"] == pytest.approx(np.hypot(np.sqrt(g @ ERRORS.heights @ g), of["spectrum"]))
    independent = np.sqrt(SLOPES[1:3, 0] ** 2 @ np.diag(ERRORS.heights)[1:])
    assert float(found.error.sel(part="shape")[0]) < 0.6 * independent


def test_surfaces_of_a_pair_add_up_as_independent():
    found = study()
    assert_allclose(found.pair_error, np.sqrt(2) * found.error.sel(surface="B2", part="total"), rtol=1e-12)
    assert scan_uncertainty.pair_errors(found)[0.67] == pytest.approx(float(found.pair_error[1]))


@pytest.mark.parametrize("scans", [1, 3])
def test_the_scans_needed_reach_the_goal_and_one_scan_less_does_not(scans):
    errors = np.array([0.02, 0.051, 0.129, 0.5])
    needed = scans_needed(errors, np.full(4, scans), GOAL)
    assert np.all(errors * np.sqrt(scans / needed) <= GOAL)
    fewer = needed > 1
    assert np.all(errors[fewer] * np.sqrt(scans / (needed[fewer] - 1)) > GOAL)
    assert list(study(replace(ERRORS, scans=scans)).scans.values) == [scans, scans]


def test_choices_are_compared_on_the_same_samples():
    base = small.contact_of_pair()
    stiff = base.assign(solid_pressure=1.2 * base.solid_pressure)
    found = study(choices={"beyond": stiff.isel(sample=slice(10))})
    assert list(found.choice.values) == ["beyond"]
    for k, h in enumerate(HUMIDITIES):
        energies = [curves.energies(contact.isel(sample=slice(10)), h, WANTED.water) for contact in (stiff, base)]
        assert_allclose([found.change[0, k], found.change_error[0, k]], relative_shift(*energies), rtol=1e-9)
    assert np.all(found.change < 0)


@pytest.mark.slow
def test_one_scan_of_b2_leaves_the_known_error():
    # ln ē of pair b by one scan of 10 µm x 10 µm: 0.129 ± 0.015, 0.092, 0.029, found by estimating drawn scans.
    surface = SURFACES["B2"]
    model = SurfaceModel(surface.density, surface.spectrum, 1e-6, surface.rms, Frame((500, 500), (1e-5, 1e-5)))
    plan = small.PLAN.config | {"beam": small.PLAN.config["beam"] | {"width_um": 30}}
    plain = jobs.slope_contact(Plan(plan), "b")
    plain["contact"]["samples"] = 300
    settings = small.settings_of(slope_contact, plain)
    contacts = {name: slope_contact.compute(small.surfaces(), "b", "B2", name, settings) for name in QUANTITIES}
    errors = Errors(OF_MOMENTS, model.covariance, np.diag([0.0145**2, 0.0035**2]), 1)
    found = scan_uncertainty.compute(
        {"B2": slopes.compute(contacts, WANTED)}, {"B2": errors}, small.contact_of_pair(), {}, WANTED
    )
    total = found.error.sel(surface="B2", part="total").values
    assert_allclose(total, [0.129, 0.092, 0.029], rtol=0.12)
    assert float(found.error.sel(surface="B2", part="spectrum")[0]) < 0.4 * total[0]


def energies_of(beam, settings):
    """Adhesion energies of pair b with another surface under the beam, (n_rh, m) [J m⁻²]."""
    contact = stage_contact.compute((beam, small.surfaces()[1]), "b", "NG", settings)
    return np.array([curves.energies(contact, h, WANTED.water) for h in HUMIDITIES])


@pytest.mark.slow
def test_energies_from_single_scans_are_those_of_the_surface_within_the_known_error():
    plain = jobs.contact(Plan(small.PLAN.config | {"beam": small.PLAN.config["beam"] | {"width_um": 30}}), "b")
    plain["contact"]["samples"] = 200
    settings = small.settings_of(stage_contact, plain)
    truth = energies_of(small.surfaces()[0], settings).mean(axis=1)
    ratios = []
    for drawn in published("B2", 10e-6, 6, "loop"):
        read = stage_scan.layout(ScanFile(drawn, "Height", "nm", ()))
        found = stage_estimate.compute([read], "Etched", stage_estimate.Settings(1, Evaluation(), 8))
        heights = measured_heights.compute(found, measured_heights.Settings("Etched", "moments"))
        use = measured_spectrum.Settings("fitted", "cut", 10e-9, Use("Etched", 1.5e-6, 1e-6))
        beam = heights, measured_spectrum.compute(found, heights, use)
        ratios.append(np.log(energies_of(beam, settings).mean(axis=1) / truth))
    assert np.all(np.abs(ratios) < 3 * np.array([0.129, 0.092, 0.029]))
    assert np.all(np.mean(np.abs(ratios), axis=0)[:2] < [0.15, 0.1])
