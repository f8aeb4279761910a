from functools import partial

import numpy as np
import pytest
from published import SURFACES
from standard_errors import ALLOWED

from stiction.errors import NotConverged
from stiction.streams import stream
from stiction.surface import identify as identification
from stiction.surface.field import StripGrid
from stiction.surface.identify import SummitTarget, identify
from stiction.surface.translation import underlying_spectrum

GRID = StripGrid(5e-6, 5e-6, 10e-9, margin=0.0)


def streams(seed=1, patches=2):
    return (stream(seed, k) for k in range(patches))


CONTROL = partial(streams, seed=3, patches=6)


@pytest.mark.parametrize(
    "name", [pytest.param("B1", marks=pytest.mark.slow), "B2", pytest.param("Sub1", marks=pytest.mark.slow)]
)
def test_summits_of_the_identified_spectrum_match_the_measured_ones_on_surfaces_not_used(name):
    target, translation = afm(name)
    again = identify(target, translation, GRID, partial(streams, patches=4), partial(streams, patches=4))
    np.testing.assert_allclose(again.mean_radius / target.mean_radius, 1, atol=2e-3)
    np.testing.assert_allclose(again.density / target.density, 1, atol=2e-3)
    np.testing.assert_allclose(again.spectrum.variance, target.rms**2, rtol=1e-9)
    assert again.spectrum.cutoff == pytest.approx(np.pi / 20e-9)
    found = identify(target, translation, GRID, partial(streams, patches=4), CONTROL)
    assert found.spectrum == again.spectrum
    # Search and control have the sampling errors of 4 and of 6 patches.
    for name in ("mean_radius", "density"):
        value, wanted, error = (getattr(o, n) for o, n in ((found, name), (target, name), (found, f"{name}_error")))
        assert abs(value - wanted) < ALLOWED * error * np.sqrt(1 + 6 / 4)
        assert 0 < error < 0.05 * value


@pytest.mark.slow
def test_identification_with_other_surfaces_gives_nearly_the_same_spectrum():
    target, translation = afm("B1")
    one = identify(target, translation, GRID, streams, CONTROL)
    other = identify(target, translation, GRID, partial(streams, seed=2), CONTROL)
    # 2 patches of 25 µm² hold 3400 summits: 2 % in density, which the slope amplifies several times.
    np.testing.assert_allclose(one.spectrum.corner / other.spectrum.corner, 1, atol=0.15)


def test_no_isotropic_spectrum_has_the_summits_of_sub2():
    """Its targets require m₀m₄/m₂² ≈ 1; a Gaussian surface has at least 1.5: radius and density remain too large."""
    target, translation = afm("Sub2")
    found = identify(target, translation, GRID, streams, CONTROL)
    assert found.mean_radius / target.mean_radius > 1.1
    assert found.density / target.density > 1.1


def test_patches_without_summits_are_refused_with_the_keys_that_help(monkeypatch):
    target, translation = afm("B2")
    monkeypatch.setattr(identification.RoughSurface, "draw", lambda surface, _: np.zeros(surface.grid.shape, "f4"))
    with pytest.raises(ValueError, match=r"no patch has a summit: increase identification\.patch_um or decrease"):
        identify(target, translation, GRID, partial(streams, patches=1), CONTROL)


def test_a_search_that_does_not_converge_is_an_error(monkeypatch):
    monkeypatch.setattr(identification, "_MAX_EVALUATIONS", 2)
    target, translation = afm("B2")
    with pytest.raises(NotConverged, match="identified spectrum.*after 2 iterations"):
        identify(target, translation, GRID, partial(streams, patches=1), CONTROL)


def test_no_spectrum_is_simulated_twice_and_all_are_counted(monkeypatch):
    simulated, target_and_translation = [], afm("B2")

    def counted(spectrum, *rest, **options):
        simulated.append(spectrum)
        return underlying_spectrum(spectrum, *rest, **options)

    monkeypatch.setattr(identification, "underlying_spectrum", counted)
    grid = StripGrid(2e-6, 2e-6, 10e-9, margin=0.0)
    found = identify(*target_and_translation, grid, streams, CONTROL)
    *search, control = simulated
    assert len(search) == len(set(search)) == found.evaluations
    assert control == found.spectrum


def afm(name):
    """Target and translation of a surface of the case study."""
    surface = SURFACES[name]
    return SummitTarget(surface.rms, surface.mean_summit_radius, surface.summit_density, 20e-9), surface.translation
