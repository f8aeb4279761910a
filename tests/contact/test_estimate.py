"""Estimated mean force curves agree with surfaces that are drawn, and with closed forms."""

import dataclasses

import numpy as np
import pytest
import small
from hypothesis import given
from hypothesis import strategies as st
from published import SPACING, SURFACES
from scipy.special import gamma, ndtr, ndtri

from stiction.beam.foundation import decay_length, ground_stiffness
from stiction.contact import forcelaw
from stiction.contact.asperity import HertzAsperity, MaugisTable, hertz_force, reduced_modulus
from stiction.contact.environment import Water
from stiction.contact.estimate import ProfileMoments, force_law, repulsion_and_attraction, solid_pressure
from stiction.contact.meniscus import film
from stiction.contact.pair import SurfacePair, contacts_of_samples
from stiction.contact.vanderwaals import attraction
from stiction.stages.contact import curves
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.spectrum import NayakSummits

POLYSILICON = reduced_modulus(164e9, 0.23)
scales = st.floats(0.3, 30)


def moments(name, rms=None):
    return ProfileMoments.of_spectrum(rms or SURFACES[name].rms, SURFACES[name].spectrum)


@pytest.mark.parametrize("name", SURFACES)
def test_summits_are_those_of_nayak(name):
    found, nayak = moments(name), NayakSummits(SURFACES[name].spectrum)
    assert found.m0 == pytest.approx(SURFACES[name].rms ** 2)
    # Density and α do not depend on the scale of the heights; the curvature is proportional to it.
    assert found.summit_density == pytest.approx(nayak.density)
    assert found.m0 * found.m4 / found.m2**2 == pytest.approx(nayak.bandwidth)
    scale = SURFACES[name].rms / np.sqrt(nayak.profile_moments[0])
    assert found.mean_radius == pytest.approx(1 / (scale * nayak.mean_curvature))


@given(scales, scales, scales)
def test_moments_of_summits_return_their_radius_and_density(rms, radius, density):
    found = ProfileMoments.of_summits(1e-9 * rms, 1e-7 * radius, 1e12 * density)
    assert found.m0 == pytest.approx((1e-9 * rms) ** 2)
    assert found.mean_radius == pytest.approx(1e-7 * radius)
    assert found.summit_density == pytest.approx(1e12 * density)


def test_moments_of_independent_surfaces_add():
    one, other = moments("B1"), moments("Sub2")
    both = ProfileMoments.of_sum([one, other])
    assert dataclasses.astuple(both) == tuple(map(sum, zip(*map(dataclasses.astuple, (one, other)), strict=True)))


@given(scales, scales)
def test_pressure_without_attraction_is_that_of_greenwood_and_williamson(rms, stiffness):
    surface = ProfileMoments(*(factor * part for factor, part in zip((rms**2,) * 3, (1e-18, 1e-4, 1e11), strict=True)))
    modulus = 1e10 * stiffness
    mean, deviation = surface.summit_heights
    # Distances below the mean plane of the summits by many deviations: all of them carry the load of their mean height.
    load = hertz_force(mean, surface.mean_radius, modulus)
    spread = deviation / mean
    closed = surface.summit_density * load * (1 + 3 / 8 * spread**2)  # ∫ z^1.5 φ, to second order in the spread
    found = solid_pressure(surface, HertzAsperity(modulus), np.array([0.0, 6 * rms * 1e-9]))
    assert found[0] == pytest.approx(closed, rel=0.05)
    assert found[1] < 1e-3 * found[0]


def test_half_of_the_moments_of_a_half_normal_distribution():
    # Mean height 0 in the limit of a wide band: ∫ z^1.5 φ = 2^0.75 Γ(1.25) / (2 √π) σ^1.5.
    surface = ProfileMoments(1e-18, 1e-6, 1e13)
    mean, deviation = surface.summit_heights
    assert mean < 1e-3 * deviation
    closed = surface.summit_density * hertz_force(1e-9, surface.mean_radius, POLYSILICON)
    closed *= 2**0.75 * gamma(1.25) / (2 * np.sqrt(np.pi))
    found = solid_pressure(surface, HertzAsperity(POLYSILICON), np.array([0.0, 6e-9]))[0]
    assert found == pytest.approx(closed, rel=3e-3)


def drawn(rms, medium):
    """Pair of Gaussian surfaces, its asperity, and the contact of four samples."""
    grid = StripGrid(1.5e-6, 30e-6, SPACING, margin=1e-6)
    beam, substrate = (SURFACES[name].with_gaussian_heights(grid) for name in ("B2", "Sub1"))
    solid = HertzAsperity(POLYSILICON) if medium == "none" else MaugisTable(POLYSILICON, attraction(medium))
    pair = SurfacePair(dataclasses.replace(beam, rms=rms), substrate, 0.05e-9, asperity=solid)
    streams = [(stream(1, "beam", k), stream(1, "substrate", k)) for k in range(4)]
    return pair, contacts_of_samples([pair], streams.__getitem__, range(4))[0]


@pytest.mark.parametrize("rms", [0.2e-9, 0.5e-9, 1.2e-9, 3.4e-9])
def test_pressure_of_hertzian_summits_is_that_of_drawn_surfaces_which_have_blunter_and_fewer_summits(rms):
    pair, (solid, _) = drawn(rms, "none")
    both = ProfileMoments.of_sum([moments("B2", rms), moments("Sub1")])
    at = pair.distances.solid[: solid.shape[1]]
    estimated = solid_pressure(both, pair.asperity, at)
    near = at < np.sqrt(both.m0)
    ratio = estimated[near] / solid.mean(axis=0)[near]
    # Sampled every 10 nm: 10 to 40 % fewer summits, with a curvature smaller by a similar share.
    assert np.all((ratio > 1) & (ratio < 2))


@pytest.mark.parametrize("medium", ["water", "none"])
@pytest.mark.parametrize("rms", [0.2e-9, 0.3e-9, 0.4e-9, 0.6e-9, 0.8e-9, 1.2e-9])
def test_a_ratio_above_three_means_that_the_solids_resist_and_below_one_that_they_do_not(rms, medium):
    pair, tables = drawn(rms, medium)
    both = ProfileMoments.of_sum([moments("B2", rms), moments("Sub1")])
    starts = pair.distances.solid[0], pair.distances.bearing[0]
    for humidity in (0.3, 0.5, 0.7, 0.8, 0.92):
        _, curve = forcelaw.humid_curves(*tables, starts, pair.step, film(humidity, 300.0))
        mean = np.mean([curve(k).copy() for k in range(4)], axis=0)
        ((repulsion, pull),) = repulsion_and_attraction(both, pair.asperity, [film(humidity, 300.0)])
        resists = mean.max() >= -mean.min()
        assert resists or repulsion < 3 * pull
        assert not resists or repulsion > pull


def test_a_stiffer_solid_and_wetter_air_resist_more():
    both = ProfileMoments.of_sum([moments("B2"), moments("Sub1")])
    films = [film(humidity, 300.0) for humidity in (0.3, 0.6, 0.9)]
    soft, stiff = (repulsion_and_attraction(both, HertzAsperity(modulus), films) for modulus in (1e9, 1e11))
    assert all(more[0] > less[0] for less, more in zip(soft, stiff, strict=True))
    assert soft[0][0] < soft[1][0] < soft[2][0]


# Force law of heights that are not Gaussian


def quantiles(name):
    """Equally probable heights of a surface [m]."""
    scores = ndtri((np.arange(40_000) + 0.5) / 40_000)
    return scores, SURFACES[name].rms * SURFACES[name].density.quantile_of_normal(scores)


def test_gaussian_heights_have_the_attraction_of_the_mean_curve():
    surface, solid = moments("B2"), MaugisTable(POLYSILICON, attraction("water"))
    ((_, pull),) = repulsion_and_attraction(surface, solid, [film(0.95, 300.0)])
    heights = SURFACES["B2"].rms * quantiles("B2")[0]
    assert force_law(surface, solid, heights, film(0.95, 300.0))[0] == pytest.approx(pull, rel=0.01)


@pytest.mark.parametrize("humidity", [0.67, 0.88])
def test_the_foundation_length_is_that_of_surfaces_that_are_drawn(humidity):
    # Pair b with 20 samples, whose foundation length, a fourth root, has an error of 2 %.
    contact = small.contact_of_pair()
    vectors, limit = curves.vectors(contact, humidity, Water(300.0))
    laws = forcelaw.coefficients(vectors[forcelaw.admissible(vectors, limit)], limit)
    drawn = decay_length(1.0, ground_stiffness(laws[:, 0], laws[:, 2]).mean())
    solid = MaugisTable(POLYSILICON, attraction("water"))
    found = ground_stiffness(*force_law(moments("B2"), solid, quantiles("B2")[1], film(humidity, 300.0)))
    assert 0.85 < decay_length(1.0, found) / drawn < 1.05
    gaussian = ground_stiffness(
        *force_law(moments("B2"), solid, SURFACES["B2"].rms * quantiles("B2")[0], film(humidity, 300.0))
    )
    assert abs(decay_length(1.0, gaussian) / drawn - 1) > 0.15  # control: heights decide


def test_forces_of_heights_and_radii_that_grow_together_keep_their_ratio():
    # Twice the heights and the film at the same tension: Hertz pressures and the water pull over twice the distance.
    surface, solid = moments("B2"), HertzAsperity(POLYSILICON)
    wide = ProfileMoments(4 * surface.m0, 4 * surface.m2 / 4, 4 * surface.m4 / 16)
    heights, (height, tension) = quantiles("B2")[1], film(0.8, 300.0)
    one = force_law(surface, solid, heights, (height, tension))
    other = force_law(wide, solid, 2 * heights, (2 * height, tension))
    assert other[0] == pytest.approx(one[0], rel=1e-6)
    assert other[1] == pytest.approx(one[1] / 2, rel=1e-6)


def test_heights_of_half_the_size_have_the_law_of_a_surface_of_half_the_roughness():
    surface, solid, factor = moments("B2"), HertzAsperity(POLYSILICON), 0.5
    smooth = ProfileMoments(*(factor**2 * moment for moment in dataclasses.astuple(surface)))
    heights = factor * SURFACES["B2"].rms * quantiles("B2")[0]
    halved, own = (force_law(each, solid, heights, film(0.95, 300.0), points=400) for each in (surface, smooth))
    assert halved == pytest.approx(own, rel=0.01)  # the highest summits, beyond the last of the heights, differ


def test_the_law_of_gaussian_heights_reaches_f_limit_where_their_mean_curve_does():
    surface, solid, (height, tension) = moments("B2"), HertzAsperity(POLYSILICON), film(0.88, 300.0)
    distance = np.linspace(0, 6e-9 + height, 20_000)
    curve = solid_pressure(surface, solid, distance) - tension * ndtr((height - distance) / np.sqrt(surface.m0))
    heights = SURFACES["B2"].rms * quantiles("B2")[0]
    f_max, a_left = force_law(surface, solid, heights, (height, tension))
    before = np.interp(-1.5 * f_max, -curve[: curve.argmin()], distance[: curve.argmin()]) - distance[curve.argmin()]
    law = np.array([f_max, 0.0, a_left, 1.0])
    assert forcelaw.pressure(law, before) == pytest.approx(1.5 * f_max, rel=0.15)


def test_a_solid_that_does_not_resist_has_no_force_law():
    with pytest.raises(ValueError, match="does not rise to f_limit"):
        force_law(moments("B2"), HertzAsperity(1e3), quantiles("B2")[1], film(0.8, 300.0))
