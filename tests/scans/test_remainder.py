import dataclasses
import re

import numpy as np
import pytest
from drawn_scans import published
from published import SURFACES

from stiction.estimates import mean_with_error
from stiction.scans.estimate import Settings, estimate, inspect
from stiction.scans.levelling import Levelling, level
from stiction.scans.remainder import coefficients, remainders, variances
from stiction.streams import stream
from stiction.surface.spectrum import CutoffSelfAffine

SIZE = (5e-6, 3e-6)
SHAPE = (250, 150)
BOWS = [(2, 0), (1, 1), (0, 2)]
B2 = SURFACES["B2"]
X, Y = (np.linspace(-1, 1, n) for n in SHAPE)
FORMS = {
    "bow along the lines": X[:, None] ** 2 + 0 * Y,
    "twist": X[:, None] * Y,
    "bow across the lines": Y**2 + 0 * X[:, None],
}


def oblong(count, address="remainder"):
    """Scans of B2 that are longer along the fast axis."""
    return [
        dataclasses.replace(scan, heights=scan.heights[:, : SHAPE[1]], size=SIZE)
        for scan in published("B2", SIZE[0], count, address)
    ]


SCANS = oblong(40)


def absolute_spectrum():
    """Spectrum of B2 with the variance of its heights."""
    scale = B2.rms**2 / B2.spectrum.variance
    return dataclasses.replace(B2.spectrum, plateau=scale * B2.spectrum.plateau, floor=scale * B2.spectrum.floor)


def left(z, spectrum=None, levelling=None):
    """Remainders of one map after levelling by a plane, unless told otherwise."""
    levelling = levelling or Levelling()
    return remainders([level(z, levelling)], SIZE, levelling, spectrum or absolute_spectrum(), 0.05)


def test_coefficients_are_those_of_orthonormal_polynomials():
    form = 3 * np.sqrt(5) * (1.5 * X[:, None] ** 2 - 0.5) + 0 * Y
    np.testing.assert_allclose(coefficients(form, BOWS), [3, 0, 0], atol=1e-10)
    np.testing.assert_allclose(coefficients(2 * 3 * X[:, None] * Y, BOWS), [0, 2, 0], atol=1e-10)
    np.testing.assert_allclose(np.sqrt(np.mean(form**2)), 3, rtol=0.02)


def test_a_flat_spectrum_gives_the_variance_of_independent_areas():
    flat = CutoffSelfAffine(2e-30, 1e-30, 1e12, 1e13)
    expected = 4 * np.pi**2 * flat.plateau / np.prod(SIZE)
    np.testing.assert_allclose(variances(flat, SIZE, [(0, 0), (1, 0), *BOWS]), expected, rtol=0.03)


def test_a_bow_along_the_short_side_has_shorter_waves_and_less_of_them():
    along, _, across = variances(absolute_spectrum(), (1e-6, 10e-6), BOWS)
    assert along < 0.9 * across


def test_coefficients_of_drawn_oblong_scans_scatter_as_their_variances():
    drawn = np.array([coefficients(scan.heights, BOWS) for scan in SCANS])
    square, error = mean_with_error(drawn**2 / variances(absolute_spectrum(), SIZE, BOWS))
    assert np.all(np.abs(square - 1) < 3.5 * error)
    assert abs(np.mean(square) - 1) < 4 * np.sqrt(2 / drawn.size)
    mean, error = mean_with_error(drawn)
    assert np.all(np.abs(mean) < 4 * error)


@pytest.mark.parametrize("name", FORMS)
def test_each_bow_is_seen_and_the_next_level_removes_it(name):
    z = SCANS[0].heights + 0.6 * B2.rms * FORMS[name] / FORMS[name].std()
    (quadratic,) = left(z)
    assert quadratic.level == "quadratic"
    assert quadratic.likely < 1e-6
    assert quadratic.rms == pytest.approx(0.6 * B2.rms, rel=0.3)
    assert left(z, levelling=Levelling("quadratic")) == ()
    assert left(SCANS[0].heights)[0].likely > 0.01


def test_tilts_and_bows_are_told_apart():
    tilted = SCANS[0].heights + 2 * B2.rms * X[:, None]
    plane, quadratic = left(tilted, levelling=Levelling("mean"))
    assert plane.likely < 1e-9 < 0.01 < quadratic.likely


def test_terms_that_levelled_lines_cannot_have_do_not_count():
    twisted = SCANS[0].heights + 2 * B2.rms * FORMS["twist"]
    assert left(twisted, levelling=Levelling("plane", "offset"))[0].likely < 1e-6
    assert left(twisted, levelling=Levelling("plane", "tilt"))[0].likely > 0.01
    assert left(twisted, levelling=Levelling("plane", "bow")) == ()


def test_several_scans_show_a_bow_that_one_does_not():
    bow = 0.16 * B2.rms * FORMS["bow along the lines"] / FORMS["bow along the lines"].std()
    maps = [level(scan.heights + bow, Levelling()) for scan in SCANS[:20]]
    of = [remainders(some, SIZE, Levelling(), absolute_spectrum(), 0.02)[0] for some in (maps[:1], maps)]
    assert of[1].likely < 0.01 < of[0].likely
    opposite = [-z if k % 2 else z for k, z in enumerate(maps)]
    assert remainders(opposite, SIZE, Levelling(), absolute_spectrum(), 0.02)[0].likely == pytest.approx(of[1].likely)


@pytest.mark.parametrize("error", [0.05, 0.3])
def test_bows_are_as_unlikely_as_a_spectrum_known_to_this_error_makes_them(error):
    z = level(SCANS[0].heights + 0.1 * B2.rms * FORMS["twist"], Levelling())
    size = np.sum(coefficients(z, BOWS) ** 2 / variances(absolute_spectrum(), SIZE, BOWS))
    rng, count = stream(1, "unsure"), 100_000
    scale = rng.gamma(error**-2, error**2, count)  # of mean 1 and this standard deviation
    expected = np.mean(rng.chisquare(3, count) / scale > size)
    found = remainders([z], SIZE, Levelling(), absolute_spectrum(), error)[0].likely
    assert abs(found - expected) < 4 * np.sqrt(expected / count)
    assert 0.001 < found < 0.9


def about_bows(found):
    return [flag for flag in found.flags if flag.startswith("levelling leaves")]


def share_of_rms(flag):
    return float(re.search(r"of (\S+) rms", flag)[1])


@pytest.mark.slow
def test_a_bow_of_one_and_a_half_rms_is_flagged_with_its_remedy():
    form = X[:, None] ** 2 + Y**2
    bowed = dataclasses.replace(SCANS[0], heights=SCANS[0].heights + 1.5 * B2.rms * (form - form.mean()))
    found = estimate([bowed], 1, model_scans=8)
    (flag,) = about_bows(found)
    added = 1.5 * form.std()
    assert share_of_rms(flag) == pytest.approx(added / np.hypot(1, added), rel=0.15)
    assert flag.startswith("levelling leaves a bow")
    assert flag.endswith(", which counts as roughness, the unsafe side; level: quadratic removes it")
    assert not about_bows(estimate([bowed], 1, Settings(Levelling("quadratic")), model_scans=8))
    assert not about_bows(estimate([SCANS[0]], 1, model_scans=8))
    tilted = dataclasses.replace(SCANS[0], heights=SCANS[0].heights + B2.rms * X[:, None])
    (flag,) = about_bows(estimate([tilted], 1, Settings(Levelling("mean")), model_scans=8))
    assert share_of_rms(flag) == pytest.approx(0.5, rel=0.15)  # 1 / √3 against √(1 + 1/3)
    assert flag.startswith("levelling leaves a tilt")
    assert flag.endswith("; level: plane removes it")


@pytest.mark.slow
def test_surfaces_without_bow_are_flagged_in_one_of_a_hundred():
    likely = np.array([inspect([scan], Settings()).remainders[0].likely for scan in oblong(200, "false alarms")])
    for level_of_test in (0.01, 0.05, 0.2, 0.5):
        error = np.sqrt(level_of_test * (1 - level_of_test) / len(likely))
        assert abs(np.mean(likely < level_of_test) - level_of_test) < 3 * error + 0.3 * level_of_test, level_of_test


@pytest.mark.parametrize(("size", "flagged"), [(0, False), (3, True), (30, True)])
def test_a_bow_is_found_even_if_it_hides_the_plateau(size, flagged):
    scan = published("B2", 10e-6, 1)[0]
    along = np.linspace(-1, 1, len(scan.heights))[:, None]
    bent = dataclasses.replace(scan, heights=scan.heights + size * scan.heights.std() * along**2)
    found = inspect([bent], Settings())
    assert (found.remainders[-1].likely < 1e-3) == flagged
    assert (found.fit.errors[1] > 0.5) == (size == 30), "the corner is hidden"
