from dataclasses import replace

import numpy as np
from plans import job_settings
from published import SPACING, SURFACES
from scipy.constants import pi

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.asperity import HertzAsperity
from stiction.plan.plan import Plan
from stiction.stages.contact import contact, pairs
from stiction.stages.contact.changes.variants import DrawnSurface, Sides, surfaces_of
from stiction.stages.surfaces import heights, spectrum
from stiction.stages.surfaces.parameters import spectrum_of
from stiction.streams import stream

SETTINGS = in_si(contact.Settings, job_settings(Plan(load()), "contact/b_NG"))


def datasets(name):
    """Datasets of stages heights and spectrum of a surface."""
    of = SURFACES[name]
    found = heights.compute(heights.Settings(of.rms, of.skewness, of.kurtosis))
    return found, spectrum.compute(found, spectrum.Settings(SPACING, of.spectrum))


def pair():
    return pairs.surface_pair((datasets("B1"), datasets("Sub1")), "NG", SETTINGS)


def test_asperities_of_the_paper_have_the_modulus_and_the_attraction_of_a_hand_calculation():
    table = pair().asperity
    np.testing.assert_allclose(table.modulus, 164e9 / 2 / (1 - 0.23**2), rtol=1e-12)
    # Check values from D₀ rounded to 1.49 Å.
    np.testing.assert_allclose(table.attraction.work_of_adhesion, 0.0874, rtol=6e-3)
    np.testing.assert_allclose(table.attraction.stress, 383e6, rtol=6e-3)
    # The pull-off force of a large sphere lies between the JKR and DMT limits.
    radius = 1e-6
    pull_off = -table.force(np.linspace(-5e-9, 5e-9, 2001), radius).min()
    assert 1.5 < pull_off / (pi * table.attraction.work_of_adhesion * radius) < 2


def test_asperities_attract_through_the_medium_of_the_configuration():
    dry, none = (pairs.asperity_of(replace(SETTINGS, van_der_waals=medium)) for medium in ("dry", "none"))
    ratio = dry.attraction.work_of_adhesion / pair().asperity.attraction.work_of_adhesion
    np.testing.assert_allclose(ratio, HAMAKER_CONSTANT["dry"] / HAMAKER_CONSTANT["water"], rtol=1e-12)
    assert none == HertzAsperity(dry.modulus)


def test_a_pair_has_the_strips_the_steps_and_the_rms_of_the_configuration():
    found = pair()
    assert found.beam.grid.shape == (150, 3000)
    np.testing.assert_allclose((found.beam.rms, found.substrate.rms), (1.7e-9, 0.17e-9), rtol=1e-12)
    np.testing.assert_allclose(found.step, 0.05e-9, rtol=1e-12)
    assert found.every == 1


def test_the_two_surfaces_of_a_sample_are_drawn_from_separate_streams():
    beam, substrate = pairs.streams_of_sides(7, "a")(3)
    for side, rng in (("beam", beam), ("substrate", substrate)):
        assert rng.random() == stream(7, "contact", "a", side, 3).random()


def test_surfaces_of_a_pair_are_those_of_their_stages_that_of_the_beam_first():
    moments = {name: (of.rms, of.skewness, of.kurtosis) for name, of in SURFACES.items()}
    known = {name: DrawnSurface(*moments[name], "published", of.spectrum) for name, of in SURFACES.items()}
    (beam, beam_spectrum), (substrate, _) = surfaces_of(Sides("B1", "Sub1"), known, SPACING, {})
    assert (float(beam.rms), float(substrate.rms)) == (SURFACES["B1"].rms, SURFACES["Sub1"].rms)
    assert spectrum_of(beam_spectrum) == SURFACES["B1"].spectrum


# Materials


def with_materials(**properties):
    """Settings under which the substrate is of another material."""
    changes = {"materials": {"Other": properties}, "surfaces": {"Sub1": {"material": "Other"}}}
    return in_si(contact.Settings, job_settings(Plan(load(changes)), "contact/b_NG"))


def test_stated_properties_of_polysilicon_give_the_asperities_of_the_paper():
    same = with_materials(young_modulus_GPa=164, hamaker_constant_zJ={"water": 97.5, "dry": 186.5})
    found = pairs.surface_pair((datasets("B1"), datasets("Sub1")), "NG", same).asperity
    np.testing.assert_allclose(found.modulus, pair().asperity.modulus, rtol=1e-14)
    np.testing.assert_allclose(
        found.attraction.work_of_adhesion, pair().asperity.attraction.work_of_adhesion, rtol=1e-14
    )


def test_a_substrate_of_another_material_has_its_share_in_modulus_and_attraction():
    other = with_materials(young_modulus_GPa=82, hamaker_constant_zJ={"water": 390, "dry": 400})
    found = pairs.surface_pair((datasets("B1"), datasets("Sub1")), "NG", other).asperity
    # 1/E' is the sum of both compliances; the Hamaker constant is the geometric mean.
    np.testing.assert_allclose(found.modulus, pair().asperity.modulus * 2 / 3, rtol=1e-12)
    ratio = found.attraction.work_of_adhesion / pair().asperity.attraction.work_of_adhesion
    np.testing.assert_allclose(ratio, 2, rtol=1e-12)
    assert [solid.young_modulus for solid in pairs.bodies(other)] == [164e9, 82e9]
