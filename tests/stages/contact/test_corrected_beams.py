"""Beams on corrected force laws against beams on force curves of full elastic contact alone."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from stiction.beam.cantilever import Beam
from stiction.beam.montecarlo import Experiment, released_beams
from stiction.config.files import load
from stiction.contact import forcelaw, solids
from stiction.contact.full import elements
from stiction.contact.full.halfspace import HalfSpace
from stiction.plan.graph import Results
from stiction.stages.contact import contact
from stiction.stages.contact.curves import force_curves
from stiction.stages.contact.pairs import bodies, streams_of_sides, surface_pair
from stiction.stages.surfaces.rough_surfaces import both
from stiction.streams import stream

STRIPS, WIDTH, STEP = 8, 10e-6, 0.2e-9


def full_curve(at, start, highest):
    """Distances and forces from a repulsion above the highest one to where the attraction has decayed."""
    points = [at(start, None)]
    while points[0].force < highest:
        points.insert(0, at(points[0].distance - STEP, None))
    while abs(points[-1].force) > 0.5 * forcelaw.DECAYED * abs(min(point.force for point in points)):
        points.append(at(points[-1].distance + STEP, points[-1]))
    return np.array([(point.distance, point.force) for point in points]).T.copy()


def by_both_models(pair, humidity):
    """Vectors v and f_limit of the same strips: by the sum over summits, and of curves of full contact alone."""
    results = Results.of(load({"beam": {"width_um": 1e6 * WIDTH}}))
    job = results.graph.job(f"studies/full_contact/{pair}")
    settings = replace(job.stage.converted(job.settings), strips=STRIPS)
    surfaces = both(results.inputs(job))
    summits = force_curves(contact.compute(surfaces, pair, "NG", settings, range(STRIPS)), humidity, settings.water)
    base, limit = forcelaw.parametrise(*summits)
    strips, materials = surface_pair(surfaces, "NG", settings), bodies(settings)
    streams = streams_of_sides(settings.seed, pair)
    space = HalfSpace(strips.beam.grid.shape, strips.beam.grid.spacing, solids.composite_modulus(*materials))
    attraction = solids.attraction_between(*materials, settings.van_der_waals)
    adhesion = elements.Adhesion.of(settings.water.film(humidity), attraction, space)
    found = []
    for k in range(STRIPS):
        at = partial(_state, space, strips.draw(*streams(k)), adhesion)
        found.append(full_curve(at, forcelaw.limit_distance(summits.distance, summits.curve(k), 0.0), 1.6 * limit))
    wells = np.array([[forcelaw.adhesion_energy(*one), *forcelaw.extremum(*one)[::-1]] for one in found])
    highest = wells[:, 1].max()
    ends = [forcelaw.limit_distance(*one, highest) for one in found]
    return (base, limit), (np.column_stack([wells, ends]), highest)


def _state(space, heights, adhesion, distance, before):
    return elements.equilibrium(space, heights, distance, adhesion, before)


def lengths(vectors, limit):
    """Crack lengths of 150 beams on laws drawn from some strips, with common random numbers [m]."""
    laws = forcelaw.coefficients(vectors, limit)
    beam = Beam(1500e-6, WIDTH, 2.6e-6, 164e9, 20e-6, 200)
    case = Experiment(beam, 1000, lambda n, rng: laws[rng.integers(len(laws), size=n)])
    return released_beams(case, 150, lambda k: stream(1, "check", k))["crack_length"]


def excess(base, full, corrected=(True, True)):
    """By how much beams on corrected laws stick at longer lengths than on curves of full contact alone [-]."""
    vectors, limit = base
    energy, pull_off = np.where(corrected, full[0][:, :2].mean(axis=0) / vectors[:, :2].mean(axis=0), 1.0)
    return (lengths(vectors * [energy, pull_off, 1, 1], pull_off * limit) / lengths(*full)).mean() - 1


@pytest.mark.slow
@pytest.mark.parametrize(("pair", "humidity", "largest"), [("a", 0.45, 0.005), ("b", 0.67, 0.015)])
def test_corrected_beams_are_those_on_curves_of_full_contact_alone_within_the_error_of_the_strips(
    pair, humidity, largest
):
    """Of eight strips, each left out once: distances differ from strip to strip by more than energies and forces."""
    models = by_both_models(pair, humidity)
    without = [[(np.delete(vectors, k, axis=0), limit) for vectors, limit in models] for k in range(STRIPS)]
    parts = np.array([excess(*both) for both in without])
    error = np.sqrt((STRIPS - 1) * parts.var())
    assert error < largest
    assert abs(excess(*models)) < 2 * error
    if pair == "a":  # the controls: no correction, and one of the energies alone
        for corrected in ((False, False), (True, False)):
            assert abs(excess(*models, corrected)) > 4 * error
