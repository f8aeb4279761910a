"""Energies of surfaces that follow each other, beside a generator of fields of its own."""

from dataclasses import replace

import numpy as np
import pytest
from plans import LIKE_B2, surface_datasets
from scipy import fft
from standard_errors import ALLOWED, errors_off

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.meniscus import flooded_energy
from stiction.contact.vanderwaals import attraction
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.plan.stage import select
from stiction.report.limits.words import not_modelled
from stiction.stages.contact import contact, curves, full_contact, pairs


def plan_of(replica, **surface):
    """Plan of a pair of two such surfaces, independent ones without ``replica``."""
    pair = {"beam": "G", "substrate": "G", "gap_um": 2, "humidities": [0.45, 0.67]}
    pair |= {"replica": replica} if replica else {}
    return Plan(
        load({"surfaces": {"G": LIKE_B2 | surface}, "pairs": {"r": pair}, "run": {"pairs": ["r"], "studies": []}})
    )


def settings_of(plan, samples=12, width=5):
    """Settings of the contact of strips of this width [µm]."""
    seen = plan.seen_by("r", samples=samples)
    return in_si(pairs.Settings, select(pairs.Settings, seen | {"beam": {"width_um": width}}))


def contact_of(replica, **size):
    plan = plan_of(replica)
    surface = surface_datasets(plan, "G")
    return contact.compute([surface, surface], "r", "NG", settings_of(plan, **size))


def energies(dataset, humidity):
    """Energies of all strips [J/m²]."""
    return curves.energies(dataset, humidity, in_si(Water, plan_of(None).air.water("r")))


def test_jobs_of_independent_pairs_have_no_setting_of_replicas():
    assert "replica" not in select(pairs.Settings, plan_of(None).seen_by("r", samples=5))
    assert plan_of({"coherence": 0.9}).replica("r") == {"replica": {"coherence": 0.9}}


def test_contact_without_coherence_is_that_of_independent_surfaces():
    alone, together = contact_of(None, samples=3), contact_of({"coherence": 0}, samples=3)
    assert alone.identical(together)


@pytest.mark.parametrize("replica", [None, {"coherence": 0.7, "above_nm": 80, "offset_nm": 30}])
def test_changed_surfaces_drawn_together_have_the_contact_of_each_alone(replica):
    plan, skewed = plan_of(replica), plan_of(replica, skewness=-0.3)
    one, other = surface_datasets(plan, "G"), surface_datasets(skewed, "G")
    alternatives, settings = [[one, one], [other, one], [one, other]], settings_of(plan, samples=2, width=2)
    together = contact.compute_each(alternatives, "r", "NG", settings)
    for surfaces, found in zip(alternatives, together, strict=True):
        assert found.identical(contact.compute(surfaces, "r", "NG", settings))


@pytest.mark.parametrize("file", ["studies/full_contact/r", "studies/full_contact/across/r"])
def test_full_contact_has_the_strips_of_the_copy(file):
    plan = plan_of({"coherence": 0.9}, rms_nm=3)
    surface = surface_datasets(plan, "G")
    stated = in_si(full_contact.Settings, Graph(plan).job(file).settings)
    settings = replace(stated, beam=replace(stated.beam, width=1e-6), strips=1)
    ((_, heights, *_),) = full_contact.strips([surface, surface], "r", settings)
    pair, streams = pairs.surface_pair([surface, surface], "NG", settings), pairs.streams_of_sides(settings.seed, "r")
    np.testing.assert_array_equal(heights, pair.draw(*streams(0)))
    independent = pairs.surface_pair([surface, surface], "NG", replace(settings, replica=None))
    assert np.abs(heights - independent.draw(*streams(0))).max() > pair.beam.rms


def test_a_device_says_how_its_underside_follows_and_otherwise_what_a_copy_would_cost():
    section = {"kind": "stopper", "pair": "r", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.6]}
    said = []
    for replica in (None, {"coherence": 0.9, "offset_nm": 20}):
        plan = plan_of(replica)
        page = Graph(Plan(plan.config | {"devices": {"S": section}})).job("devices/S.html").settings
        said.append((page["surfaces"]["surface of the device"], not_modelled(**page["not_modelled"])))
    (alone, without), (follows, with_replica) = said
    assert follows.removeprefix(alone) == ", follows the substrate with a coherence of 0.9, 20 nm beside its register"
    assert "conformal films" in without
    assert "conformal films" not in with_replica
    assert "in register it sticks most" in with_replica
    assert "for cantilevers along their length alone" in with_replica
    assert "along their length" not in without


def test_the_closer_the_copy_the_larger_the_energy():
    means = [
        energies(contact_of({"coherence": c}, samples=6), 0.45).mean() for c in (0, 0.3, 0.6, 0.8, 0.9, 0.95, 0.99)
    ]
    assert np.all(np.diff(means) > 0)


@pytest.mark.parametrize("humidity", [0.45, 0.67])
def test_a_full_copy_sticks_like_flats(humidity):
    """Water on both sides, 2γ, and the attraction of solids that touch in it; that across the film adds below 1 %."""
    flats = flooded_energy(plan_of(None).config["water"]["temperature_K"]) + attraction("water").work_of_adhesion
    assert energies(contact_of({"coherence": 0.999}, samples=4), humidity).mean() == pytest.approx(flats, rel=0.01)
    assert energies(contact_of({"coherence": 0.97}, samples=4), humidity).mean() < 0.5 * flats


def test_energies_of_a_beam_beside_its_register_fall_to_those_of_independent_surfaces():
    offsets = [energies(contact_of({"coherence": 0.97, "offset_nm": s}, samples=8), 0.67) for s in (0, 20, 50, 1000)]
    independent = energies(contact_of(None, samples=8), 0.67)
    assert np.all(np.diff([one.mean() for one in offsets]) < 0)
    assert abs(np.log(offsets[-1].mean() / independent.mean())) < 0.5 * np.log(offsets[-2].mean() / independent.mean())


def own_fields(coherence, shape, spacing, rng):
    """Sums of a Gaussian field and its copy on a periodic square, by noise that is filtered in the frequency domain."""
    psd = LIKE_B2["published_psd"]
    zeta = 2e-6 * np.pi * np.hypot(*np.meshgrid(*(fft.fftfreq(n, spacing) for n in shape), indexing="ij"))
    slope = np.log(psd["floor_nm4"] / psd["plateau_nm4"]) / np.log(psd["cutoff_rad_per_um"] / psd["corner_rad_per_um"])
    power = np.maximum(zeta / psd["corner_rad_per_um"], 1) ** slope * (zeta <= psd["cutoff_rad_per_um"])
    gain = np.sqrt(power / power.mean()) * 1e-9 * LIKE_B2["rms_nm"]
    substrate, own = (fft.ifft2(gain * fft.fft2(rng.standard_normal(shape))).real for _ in range(2))
    return substrate + (-coherence * substrate + np.sqrt(1 - coherence**2) * own)


@pytest.mark.slow
@pytest.mark.parametrize(("coherence", "published"), [(0.9, (16.4, 33.0)), (0.97, (91.7, 102.0))])
def test_energies_are_those_of_fields_drawn_in_another_way(coherence, published):
    """The numbers [mJ/m²] are from 100 strips of a third program, with errors of 6 %."""
    plan, strips = plan_of({"coherence": coherence}), 30
    settings, surface = settings_of(plan, samples=strips, width=30), surface_datasets(plan, "G")
    drawn = contact.compute([surface, surface], "r", "NG", settings)
    pair, rng = pairs.surface_pair([surface, surface], "NG", settings), np.random.default_rng(75)
    heights = (own_fields(coherence, (256, 3125), 1e-8, rng)[:150, :3000].astype(np.float32) for _ in range(strips))
    own = contact.layout(*zip(*map(pair.contact, heights), strict=True), pair.distances, range(strips))
    for humidity, expected in zip((0.45, 0.67), published, strict=True):
        one, other = energies(drawn, humidity), energies(own, humidity)
        assert errors_off(one - other, 0) < ALLOWED
        assert one.mean() == pytest.approx(1e-3 * expected, rel=3 * 0.06)


@pytest.mark.parametrize("size", [{"coherence": 0.97}, {"coherence": 0.999}])
def test_a_coherence_that_skewed_surfaces_cannot_have_is_refused_before_anything_is_drawn(size):
    plan = plan_of(size, skewness=-0.76, kurtosis=3.9)
    surface = surface_datasets(plan, "G")
    data = {"heights": [surface[0]] * 2, "spectrum": [surface[1]] * 2}
    with pytest.raises(ValueError, match="a full replica has the opposite skewness of its original"):
        contact.from_surfaces(data, "r", settings_of(plan))
