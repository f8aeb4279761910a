from functools import partial

import numpy as np
import pytest
from published import SURFACES

from stiction import identify as identification
from stiction.errors import NotConverged
from stiction.identify import SummitTarget, identify
from stiction.streams import stream
from stiction.surfaces import StripGrid

GRID = StripGrid(5e-6, 5e-6, 10e-9, margin=0.0)


def streams(seed=1, patches=2):
    return (stream(seed, k) for k in range(patches))


@pytest.mark.parametrize("name", ["B1", "Sub1"])
def test_summits_of_the_identified_spectrum_are_those_measured(name):
    target, translation = afm(name)
    found = identify(target, translation, GRID, streams)
    np.testing.assert_allclose(found.mean_radius / target.mean_radius, 1, atol=0.01)
    np.testing.assert_allclose(found.density / target.density, 1, atol=0.01)
    np.testing.assert_allclose(found.spectrum.variance, target.rms**2, rtol=1e-9)
    assert found.spectrum.cutoff == pytest.approx(np.pi / 20e-9)


def test_other_surfaces_of_the_identified_spectrum_have_these_summits_too():
    target, translation = afm("B1")
    one = identify(target, translation, GRID, streams)
    other = identify(target, translation, GRID, partial(streams, seed=2))
    # 2 patches of 25 µm² hold 3400 summits: 2 % in density, which the slope turns into several times as much.
    np.testing.assert_allclose(one.spectrum.corner / other.spectrum.corner, 1, atol=0.15)


def test_no_isotropic_spectrum_has_the_summits_of_sub2():
    """Its targets ask for m₀m₄/m₂² ≈ 1, a Gaussian surface has at least 1.5: radius and density stay too large."""
    target, translation = afm("Sub2")
    found = identify(target, translation, GRID, streams)
    assert found.mean_radius / target.mean_radius > 1.1
    assert found.density / target.density > 1.1


def test_a_search_that_does_not_come_to_rest_is_an_error(monkeypatch):
    monkeypatch.setattr(identification, "_MAX_EVALUATIONS", 2)
    target, translation = afm("B2")
    with pytest.raises(NotConverged, match="identified spectrum.*after 2 iterations"):
        identify(target, translation, GRID, partial(streams, patches=1))


def afm(name):
    """Target and translation of a surface of the case study."""
    surface = SURFACES[name]
    return SummitTarget(surface.rms, surface.mean_summit_radius, surface.summit_density, 20e-9), surface.translation
