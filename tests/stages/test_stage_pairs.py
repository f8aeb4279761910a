import numpy as np
from published import CONFIG, SPACING, SURFACES
from scipy.constants import pi

from stiction.config import settings
from stiction.stages import cases, pairs
from stiction.streams import stream

SETTINGS = settings.read(CONFIG)


def datasets(name):
    """Stages heights and spectrum of a surface."""
    of = SURFACES[name]
    moments = {"rms": of.rms, "skewness": of.skewness, "kurtosis": of.kurtosis}
    return cases.surface(moments, of.spectrum, SPACING)


def test_asperities_of_the_paper_have_the_modulus_and_the_attraction_of_a_hand_calculation():
    table = pairs.asperity(SETTINGS["solid"], "water")
    np.testing.assert_allclose(table.modulus, 164e9 / 2 / (1 - 0.23**2), rtol=1e-12)
    # Check values from D₀ rounded to 1.49 Å.
    np.testing.assert_allclose(table.attraction.work_of_adhesion, 0.0874, rtol=6e-3)
    np.testing.assert_allclose(table.attraction.stress, 383e6, rtol=6e-3)
    # A big sphere lets go at a force between those of JKR and DMT.
    radius = 1e-6
    pull_off = -table.force(np.linspace(-5e-9, 5e-9, 2001), radius).min()
    assert 1.5 < pull_off / (pi * table.attraction.work_of_adhesion * radius) < 2


def test_a_pair_has_the_strips_the_steps_and_the_rms_of_the_configuration():
    pair = pairs.surface_pair((datasets("B1"), datasets("Sub1")), "NG", SETTINGS)
    assert pair.beam.grid.shape == (150, 3000)
    np.testing.assert_allclose((pair.beam.rms, pair.substrate.rms), (1.7e-9, 0.17e-9), rtol=1e-12)
    np.testing.assert_allclose(pair.step, 0.05e-9, rtol=1e-12)
    assert pair.every == 1


def test_sides_of_a_sample_draw_from_streams_of_their_own():
    beam, substrate = pairs.streams_of_sides(7, "a")(3)
    for side, rng in (("beam", beam), ("substrate", substrate)):
        assert rng.random() == stream(7, "contact", "a", side, 3).random()
