"""Crack lengths of beams on force curves themselves, and on the laws of Eq. (12) that stand for them: ``make tails``.

The attraction across gaps falls with the third power of the distance, and Eq. (12) exponentially. It keeps energy,
largest attraction and its distance of every curve, and this script measures what the rest of the shape does to cracks
on samples drawn at random. The beam on tabulated curves is solved by code of its own, which knows no crack front: it
moves the whole beam in every step. Curves and tables of their laws are compared in it, so that only the shape differs;
that the beam of the package arrests where this one does on the same laws is measured beside it.
"""

import argparse
from dataclasses import replace
from functools import partial

import numpy as np
from numba import njit
from scipy.linalg import solveh_banded

from stiction.beam import release
from stiction.beam.energy import arrest_length
from stiction.beam.equilibrium import STEP, allowed_imbalance, distances, hermite
from stiction.beam.resolution import resolved
from stiction.config.cases import air
from stiction.config.files import load
from stiction.config.units import in_si, to_si
from stiction.contact import forcelaw
from stiction.contact.environment import Water, force_curves
from stiction.errors import NotConverged
from stiction.estimates import mean_with_error
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.report.format import TO_MJ, with_error
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.contact.contact import tables
from stiction.streams import stream

#: End of the tables of the curves [m], where the pressure is below 1e-4 of its largest value.
END = 150e-9
#: Beams longer than their cracks by this factor, of elements with five strips.
LONGER, STRIPS = 1.6, 5
#: Tables of laws end at this repulsion, in units of the largest attraction, where no beam rests.
FIRMEST = 1e3
#: Length of the strips [µm], short enough for all pairs.
STRIP = 1.0


# A beam on tabulated curves


@njit
def pressures_and_slopes(curves, drawn, step, distance):
    """Forces [Pa] of the curves (m, n) drawn at the points, at their distances (points,) [m], and derivatives [Pa/m].

    Cubic between nodes, with the slopes of central differences; linear before the second node, zero beyond the last.
    """
    force, slope = np.zeros(distance.size), np.zeros(distance.size)
    for p in range(distance.size):
        curve, place = curves[drawn[p]], distance[p] / step
        if place < curve.size - 3:
            k = max(int(place), 1)
            left, right, s = (curve[k + 1] - curve[k - 1]) / 2, (curve[k + 2] - curve[k]) / 2, max(place - k, 0.0)
            rise = curve[k + 1] - curve[k]
            square, cube = 3 * rise - 2 * left - right, left + right - 2 * rise
            force[p] = curve[k] + s * (left + s * (square + s * cube)) + min(place - k, 0.0) * left
            slope[p] = (left + s * (2 * square + 3 * s * cube)) / step
    return force, slope


@njit
def tangent(bend, stiffness, functions):
    """Upper band (4, n) of the beam's elements (4, 4) and the stiffness of their points (elements, points)."""
    band = np.zeros((4, 2 * len(stiffness) + 2))
    for e in range(len(stiffness)):
        for i in range(4):
            for j in range(i, 4):
                ground = np.sum(stiffness[e] * functions[:, i] * functions[:, j])
                band[3 - (j - i), 2 * e + j] += bend[i, j] + ground
    return band


def relaxed(beam, laws, curve, deflection, load=0.0):
    """Deflection (elements + 1, 2) after a beam has crept downhill to its next equilibrium on ``curve(distance)``.

    As `stiction.beam.equilibrium.equilibrate`: Newton's method with dashpots; the laws limit the steps.
    """
    size, functions = (
        beam.element_length,
        hermite((np.arange(len(laws) // beam.elements) + 0.5) * beam.elements / len(laws)),
    )
    area, scale = beam.width * beam.length / len(laws), np.array([1, size])
    bend = (
        np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) * beam.bending_stiffness / size**3
    )
    weight = load * size * np.array([1 / 2, 1 / 12, 1 / 2, -1 / 12])
    tolerance, steepest = (
        allowed_imbalance(beam, laws[:, 0].mean() * area),
        0.5 * np.max(laws[:, 0] * laws[:, 3]) * area,
    )
    u, viscosity = (deflection * scale).ravel(), steepest
    for _ in range(20_000):
        distance = distances(beam, laws, u.reshape(-1, 2) / scale)
        far = np.where(distance < laws[:, 1], laws[:, 2], laws[:, 3]) * (distance - laws[:, 1])
        ahead = 1 + np.maximum(far, 0)
        force, slope = curve(distance)
        push = (force * area).reshape(beam.elements, -1)
        ends = np.hstack([u.reshape(-1, 2)[:-1], u.reshape(-1, 2)[1:]])
        unbalanced = np.zeros_like(u)
        parts = weight - ends @ bend - push @ functions
        unbalanced.reshape(-1, 2)[:-1] += parts[:, :2]
        unbalanced.reshape(-1, 2)[1:] += parts[:, 2:]
        unbalanced[:2] = 0.0
        settled = np.abs(unbalanced).max() <= tolerance
        if settled:
            return u.reshape(-1, 2) / scale
        stiffness = (viscosity / ahead**2 - slope * area).reshape(beam.elements, -1)
        band = tangent(bend, stiffness, functions)
        band[:, :2], band[2, 2], band[1, 2:4], band[0, 3:5] = 0.0, 0.0, 0.0, 0.0
        band[3, :2] = 1.0
        try:
            change = solveh_banded(band, unbalanced, check_finite=False)
        except np.linalg.LinAlgError:
            viscosity *= 4
            continue
        moved = distances(beam, laws, change.reshape(-1, 2) / scale) - beam.gap
        move = np.max(np.where(far > 0, laws[:, 3], laws[:, 2]) * np.abs(moved) / ahead) / STEP
        if move <= 2:
            u = u + change
        viscosity = max(viscosity, 0.01 * steepest * (move > 1)) * min(max(move, 0.25), 4.0)
    raise NotConverged("equilibrium of the beam [N]", np.abs(unbalanced).max(), tolerance, 20_000)


def crack_length(beam, laws, curve, start):
    """Crack length of a beam released from a crack of the length ``start``, as `stiction.beam.release.release` [m]."""
    pressed = release.s_shape(beam, beam.gap - laws[:, 1].mean(), start)
    held = relaxed(beam, laws, curve, pressed, release.holding_load(beam, start))
    return release.crack_length(beam, laws, relaxed(beam, laws, curve, held))


# Samples of a pair and their laws


def sampled(contact, humidity, water):
    """Curves (m, n) [Pa] up to END, tables of their laws, the step of both [m], the laws (m, 4), and energies (m, 2).

    The energies are those with and without attraction across gaps [J/m²].
    """
    solid, bearing, starts, step = tables(contact)
    bearing = np.pad(bearing, ((0, 0), (0, round((END - starts[1]) / step) - bearing.shape[1])))
    found = force_curves(solid, bearing, starts, step, humidity, water)
    curves = np.array([found.curve(k).copy() for k in range(found.samples)])
    vectors, limit = forcelaw.parametrise(*found)
    lawful = forcelaw.admissible(vectors, limit)
    laws = forcelaw.coefficients(vectors[lawful], limit)
    of_laws = np.minimum(forcelaw.pressure(laws[:, None], found.distance), FIRMEST * laws[:, :1].max())
    alone = forcelaw.adhesion_energies(*force_curves(solid, bearing, starts, step, humidity, replace(water, gaps=None)))
    return curves[lawful], of_laws, step, laws, np.column_stack([vectors[:, 0], alone])


def resolved_beam(beam, strip, laws):
    """Beam longer than its crack on these laws, with elements that resolve it, and the number of its strips."""
    length = LONGER * arrest_length(forcelaw.energy(laws).mean(), beam)
    elements = int(np.ceil(length / (STRIPS * strip)))
    longer = replace(beam, length=elements * STRIPS * strip, elements=elements)
    return resolved(longer, elements * STRIPS, laws), elements * STRIPS


def cracks(beam, curves, tables_of_laws, step, laws, drawn):
    """ln l_s on the curves of the drawn samples (strips,), on tables of their laws, and by the beam of the package."""
    ground = np.ascontiguousarray(laws[drawn])
    energy = forcelaw.energy(ground).mean()
    start = release.START * min(arrest_length(energy, beam), beam.length)
    shapes = (partial(pressures_and_slopes, table, drawn, step) for table in (curves, tables_of_laws))
    lengths = [crack_length(beam, ground, curve, start) for curve in shapes]
    return np.log([*lengths, release.released_beam(beam, ground, energy).crack_length])


def row(pair, humidity, reach, samples, beams):
    """One row of the table: pair, air, reach, energies and their scatter, and the differences of the cracks."""
    strip = {"sampling": {"strip_length_um": STRIP}, "beam": {"elements": 300}}
    sizes = {
        "contact": {"samples": samples, "chunks": 1},
        "chaos": {"order": 2},
        "studies": {"variants": {"samples": 5}},
    }
    medium = {"van_der_waals": "water" if humidity else "dry", "attraction": {"reach": reach}}
    config = load(strip | sizes | medium)
    plan = Plan(config)
    contact = Results.of(config)[f"contact/{pair}_NG"]
    curves, of_laws, step, laws, energies = sampled(contact, humidity, in_si(Water, plan.air.water(pair)))
    one = cantilever(in_si(Cantilevers, sections(plan, pair)), pair)
    beam, strips = resolved_beam(one, to_si(STRIP, "um"), laws)
    rng = stream(config["seed"], "tails", pair)
    drawn = (rng.integers(len(laws), size=strips) for _ in range(beams))
    on_curves, on_laws, own = np.array([cracks(beam, curves, of_laws, step, laws, each) for each in drawn]).T
    differences = [100 * np.array(mean_with_error(one)) for one in (on_curves - on_laws, own - on_laws)]
    scatter = energies[:, 0].std(ddof=1) / energies[:, 0].mean()
    return [
        pair,
        air(humidity),
        reach,
        *(with_error(*mean_with_error(TO_MJ * one)) for one in energies.T),
        f"{scatter:.2f}",
        *(with_error(*one, "+") for one in differences),
    ]


#: Pair, humidity (0 in dry air) and reach of the attraction.
CASES = (("b", 0.0, "all"), ("c", 0.0, "all"), ("c", 0.6, "all"), ("a", 0.0, "all"))
HEADER = (
    "pair",
    "air",
    "reach",
    "ē [mJ/m²]",
    "touching summits alone [mJ/m²]",
    "scatter of e",
    "ln l_s, curves over Eq. (12) [%]",
    "package over it [%]",
)


def main():
    """Print the table as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=300)
    parser.add_argument("--beams", type=int, default=100)
    parser.add_argument("--rows", type=int, nargs="+", default=range(len(CASES)), help="of the table, from 0")
    sizes = parser.parse_args()
    print(f"| {' | '.join(HEADER)} |\n|{'---|' * len(HEADER)}", flush=True)  # noqa: T201
    for number in sizes.rows:
        print(f"| {' | '.join(row(*CASES[number], sizes.samples, sizes.beams))} |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
