"""Beams on corrected force laws against beams on force curves of full elastic contact alone.

``pytest -m "slow or nightly" --log-cli-level INFO tests/stages/contact/test_corrected_beams.py`` gives numbers like
those of docs/tables/model_error_checks.md, which are of 24 strips.
"""

import logging
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from stiction.beam.cantilever import Beam
from stiction.beam.energy import arrest_length
from stiction.beam.montecarlo import Experiment, released_beams
from stiction.config.files import load
from stiction.contact import forcelaw, solids
from stiction.contact.correction import NONE, ElasticChange
from stiction.contact.full import elements
from stiction.contact.full.halfspace import HalfSpace
from stiction.plan.graph import Results
from stiction.stages.contact import contact
from stiction.stages.contact.curves import force_curves
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import sides_of
from stiction.streams import stream

WIDTH, STEP = 10e-6, 0.2e-9
#: Gaps of the pairs [m], and their humidities in Table III.
GAPS = {"a": 20e-6, "b": 20e-6, "c": 2e-6}
HUMIDITIES = {pair: section["humidities"] for pair, section in load()["pairs"].items()}
#: Cases of continuous integration, and of the night.
BY_DAY = [("b", 0.67)]
BY_NIGHT = [(pair, humidity) for pair in GAPS for humidity in HUMIDITIES[pair] if (pair, humidity) not in BY_DAY]


def full_curve(at, start, highest):
    """Distances and forces from a repulsion above the highest one to where the attraction has decayed."""
    points = [at(start, None)]
    while points[0].force < highest:
        points.insert(0, at(points[0].distance - STEP, None))
    while abs(points[-1].force) > 0.5 * forcelaw.DECAYED * abs(min(point.force for point in points)):
        points.append(at(points[-1].distance + STEP, points[-1]))
    return np.array([(point.distance, point.force) for point in points]).T.copy()


def by_both_models(pair, humidity, number):
    """Vectors v and f_limit of the same strips: by the sum over summits, and of curves of full contact alone.

    Those without a law in one of the models are left out.
    """
    results = Results.of(load({"beam": {"width_um": 1e6 * WIDTH}}))
    job = results.graph.job(f"studies/full_contact/{pair}")
    settings = replace(job.stage.converted(job.settings), strips=number)
    surfaces = sides_of(results.inputs(job))
    summits = force_curves(contact.compute(surfaces, pair, "NG", settings, range(number)), humidity, settings.water)
    base, limit = forcelaw.parametrise(*summits)
    strips, materials = surface_pair(surfaces, "NG", settings), bodies(settings)
    streams = streams_of_sides(settings.seed, pair)
    space = HalfSpace(strips.beam.grid.shape, strips.beam.grid.spacing, solids.composite_modulus(*materials))
    attraction = solids.attraction_between(*materials, settings.van_der_waals)
    adhesion = elements.Adhesion.from_film(settings.water.film(humidity), attraction, space)
    found = []
    for k in range(number):
        at = partial(_state, space, strips.draw(*streams(k)), adhesion)
        found.append(full_curve(at, forcelaw.limit_distance(summits.distance, summits.curve(k), 0.0), 1.6 * limit))
    wells = np.array([[forcelaw.adhesion_energy(*one), *forcelaw.extremum(*one)[::-1]] for one in found])
    highest = wells[:, 1].max()
    ends = [forcelaw.limit_distance(*one, highest) for one in found]
    models = (base, limit), (np.column_stack([wells, ends]), highest)
    lawful = np.all([forcelaw.admissible(*one) for one in models], axis=0)
    return [(vectors[lawful], largest) for vectors, largest in models]


def _state(space, heights, adhesion, distance, before):
    return elements.equilibrium(space, heights, distance, adhesion, before)


def lengths(vectors, limit, gap, energy):
    """Crack lengths of 150 beams on laws drawn from some strips, longer than those on a mean energy [m]."""
    laws = forcelaw.coefficients(vectors, limit)
    beam = Beam(90e-6, WIDTH, 2.6e-6, 164e9, gap, 12)
    parts = int(np.ceil(1.5 * arrest_length(energy, beam) / beam.length))
    beam = replace(beam, length=parts * beam.length, elements=parts * beam.elements)
    case = Experiment(beam, 60 * parts, lambda n, rng: laws[rng.integers(len(laws), size=n)])
    return released_beams(case, 150, lambda k: stream(1, "check", k))["crack_length"]


def excess(models, gap, corrected=(True, True)):
    """By how much beams on corrected laws stick at longer lengths than on curves of full contact alone [-]."""
    (vectors, limit), full = models
    base, other, mean = vectors[:, :2], full[0][:, :2], full[0][:, 0].mean()
    ratios, powers = other.mean(axis=0) / base.mean(axis=0), np.log(other).std(axis=0) / np.log(base).std(axis=0)
    changes = map(ElasticChange, ratios, np.maximum(1.0, powers))
    used = [change if used else NONE for change, used in zip(changes, corrected, strict=True)]
    energy, pull_off = (change.of(values)(values) for change, values in zip(used, base.T, strict=True))
    laws = np.column_stack([energy, pull_off, vectors[:, 2:]]), max(used[1].ratio * limit, pull_off.max())
    return (lengths(*laws, gap, mean) / lengths(*full, gap, mean)).mean() - 1


@pytest.mark.parametrize(
    ("pair", "humidity", "strips"),
    [pytest.param(*case, 8, marks=pytest.mark.slow) for case in BY_DAY]
    + [pytest.param(*case, 12, marks=pytest.mark.nightly) for case in BY_NIGHT],
)
def test_corrected_beams_are_those_on_curves_of_full_contact_alone_within_the_error_of_the_strips(
    pair, humidity, strips
):
    """Each strip is left out once: distances differ from strip to strip by more than energies and forces."""
    models, gap = by_both_models(pair, humidity, strips), GAPS[pair]
    number = len(models[0][0])
    without = [[(np.delete(vectors, k, axis=0), limit) for vectors, limit in models] for k in range(number)]
    error = np.sqrt((number - 1) * np.var([excess(part, gap) for part in without]))
    found = excess(models, gap)
    logging.info("pair %s, RH %s: %+.2f ± %.2f %%", pair, humidity, 100 * found, 100 * error)
    assert abs(found) < 3 * error + 0.001
    if pair == "a" and humidity < 0.5:  # the controls: no correction, and one of the energies alone
        for corrected in ((False, False), (True, False)):
            assert abs(excess(models, gap, corrected)) > 4 * error
