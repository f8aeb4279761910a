"""Crack lengths of beams on force curves themselves, and on the laws of Eq. (12) that stand for them: ``make tails``.

The attraction across gaps falls with the third power of the distance, and Eq. (12) exponentially. It keeps energy,
largest attraction and its distance of every curve, and this script measures what the rest of the shape does to cracks
on samples drawn at random. Which part of a law does it is shown by laws of the same energy that take the shape of one
branch from the curve, and by laws whose left branch is a parabola.

A solver of its own, which knows no crack front and moves the whole beam in every step, finds all of these cracks on
tables, so that only the shape differs. That the beam of the package arrests where this one does on the same laws is
measured beside it.
"""

import argparse
from dataclasses import replace

import numpy as np
from numba import njit
from scipy.integrate import cumulative_trapezoid

from stiction.beam import equilibrium, release
from stiction.beam.energy import arrest_length
from stiction.beam.resolution import resolved
from stiction.config.files import load
from stiction.config.units import in_si, to_si
from stiction.contact import forcelaw
from stiction.contact.air import Air
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
#: Curves have jumps where summits let go: they need steps that are shorter by this factor than those of laws.
FINER = 6.0
#: Shapes of equal energy with the factor of their steps; all cracks are compared with those on the first.
SHAPES = {"Eq. (12)": 1.0, "curves": FINER, "its right branch": FINER, "its left branch": 1.0, "parabola": 1.0}
#: Largest number of Newton steps.
STEPS = 400_000
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
def assemble(u, ground, system, mesh, viscosity):
    """Assemble the whole beam, clamped at its first node; returns the largest unbalanced force [N]."""
    laws, curves, drawn, step = ground
    system.band[:] = 0.0
    system.force[:] = 0.0
    points, elements = mesh.points_per_element, u.size // 2 - 1
    for element in range(elements):
        equilibrium.add_element(u, system, mesh, element)
        i, here = 2 * element, slice(element * points, (element + 1) * points)
        distance = mesh.gap - np.sum(mesh.hermite * u[i : i + 4], axis=1)
        force, slope = pressures_and_slopes(curves, drawn[here], step, distance)
        for p in range(points):
            law, n = laws[here][p], mesh.hermite[p]
            stretch = (law[2] if distance[p] < law[1] else law[3]) * (distance[p] - law[1])
            system.stretch[here.start + p] = stretch
            stiffness = viscosity / (1 + max(stretch, 0.0)) ** 2 - slope[p] * mesh.area
            for row in range(4):
                system.force[i + row] -= n[row] * force[p] * mesh.area
                for column in range(row, 4):
                    system.band[i + row, column - row] += stiffness * n[row] * n[column]
    system.band[:2], system.force[:2] = 0.0, 0.0
    system.band[:2, 0] = 1.0
    return np.abs(system.force).max()


@njit
def relax(u, ground, mesh, finer, tolerance):
    """Relax a beam in place, as `stiction.beam.equilibrium.equilibrate`; returns the largest unbalanced force [N].

    Steps are limited by the laws, whose lengths 1/a are divided by ``finer``: curves are less smooth than laws.
    """
    laws = ground[0]
    limits = laws * np.array([1.0, 1.0, finer, finer])
    system = equilibrium.System(np.zeros((u.size + 3, 4)), np.zeros(u.size + 3), np.zeros(len(laws)))
    slopes = 0.5 * mesh.area * laws[:, 0] * laws[:, 3]
    viscosity, slope, residual = slopes.max(), slopes.mean(), np.inf
    for _ in range(STEPS):
        residual = assemble(u, ground, system, mesh, viscosity)
        if residual <= tolerance:
            return residual
        move = equilibrium.newton_step(u, limits, system, mesh, (0, u.size // 2 - 1))
        viscosity = equilibrium.next_viscosity(viscosity, move, slope)
    return residual


def relaxed(beam, ground, deflection, finer):
    """Deflection (elements + 1, 2) after a beam has crept downhill to its next equilibrium on the ground."""
    mesh, scale = equilibrium.mesh_of(beam, ground[0], 0.0, 0.0), np.array([1, beam.element_length])
    u, tolerance = (deflection * scale).ravel(), equilibrium.allowed_imbalance(beam, ground[0][:, 0].mean() * mesh.area)
    residual = relax(u, ground, mesh, finer, tolerance)
    if not residual <= tolerance:
        raise NotConverged("equilibrium of the beam [N]", residual, tolerance, STEPS)
    return u.reshape(-1, 2) / scale


def crack_length(beam, ground, start, finer):
    """Crack length of a beam released from a crack of the length ``start``, as `stiction.beam.release.release` [m].

    The ground is (laws, curves, drawn, step): of every point (points, 4), force curves (m, n) [Pa], which of them each
    point has (points,), and the spacing of their nodes [m].
    """
    laws = ground[0]
    adhering = release.s_shape(beam, beam.gap - laws[:, 1].mean(), start)
    return release.crack_length(beam, laws, relaxed(beam, ground, adhering, finer))


# Samples of a pair, their laws, and laws of which one part is that of the curve


def sampled(contact, humidity, water):
    """Force curves of the samples up to END, and their energies without attraction across gaps (m,) [J/m²]."""
    solid, bearing, starts, step = tables(contact)
    bearing = np.pad(bearing, ((0, 0), (0, round((END - starts[1]) / step) - bearing.shape[1])))
    found = force_curves(solid, bearing, starts, step, humidity, water)
    curves = np.array([found.curve(k).copy() for k in range(found.samples)])
    alone = forcelaw.adhesion_energies(*force_curves(solid, bearing, starts, step, humidity, replace(water, gaps=None)))
    return found._replace(curve=curves.__getitem__), curves, alone


def right_energies(distance, curves, laws):
    """Attraction of each curve beyond its d_max, integrated (m,) [J/m²]."""
    passed = cumulative_trapezoid(np.maximum(-curves, 0), distance, initial=0)
    return passed[:, -1] - [np.interp(law[1], distance, each) for law, each in zip(laws, passed, strict=True)]


def stretched(distance, curve, law, factor):
    """A law with the right branch of the curve, whose distances from d_max are divided by a factor (n,) [Pa]."""
    shape = np.interp(law[1] + (distance - law[1]) * factor, distance, curve, right=0.0)
    return np.where(distance > law[1], shape, forcelaw.pressure(law, distance))


def parabolic(distance, vectors, limit):
    r"""Pressures (m, n) [Pa] of laws whose left branch is a parabola; the right one is that of Eq. (12).

    The parabola has its lowest point in (d_max, -f_max) and passes (d_limit, f_limit), so that it needs no more than
    Eq. (12) does:

    .. math:: f(d) = f_\mathrm{max} \bigl( a^2 (d - d_\mathrm{max})^2 - 1 \bigr), \quad
        a = \frac{\sqrt{1 + f_\mathrm{limit} / f_\mathrm{max}}}{d_\mathrm{max} - d_\mathrm{limit}}

    Its zero is at d_max - 1/a, and the right branch has the rest of the energy, e - 2 f_max / (3 a) = 3 f_max / (2
    a_right). This is more than in Eq. (12) for every f_limit >= f_max.
    """
    e, f_max, d_max, d_limit = vectors.T[..., None]
    a = np.sqrt(1 + limit / f_max) / (d_max - d_limit)
    a_right = 1.5 * f_max / (e - 2 / 3 * f_max / a)
    decay = np.exp(-a_right * np.maximum(distance - d_max, 0.0))
    return f_max * np.where(distance < d_max, (a * (distance - d_max)) ** 2 - 1, decay * (decay - 2))


def shapes(distance, curves, vectors, limit):
    """Force curves (m, n) [Pa] of equal energy e, in the order of SHAPES; the laws of the samples are admissible."""
    laws = forcelaw.coefficients(vectors, limit)
    beyond, of_laws = right_energies(distance, curves, laws), 1.5 * laws[:, 0] / laws[:, 3]
    own_right = np.column_stack([laws[:, :3], 1.5 * laws[:, 0] / beyond])
    found = (
        forcelaw.pressure(laws[:, None], distance),
        curves,
        np.array([stretched(distance, *each) for each in zip(curves, laws, beyond / of_laws, strict=True)]),
        np.where(distance < laws[:, 1:2], curves, forcelaw.pressure(own_right[:, None], distance)),
        parabolic(distance, vectors, limit),
    )
    return [np.minimum(each, FIRMEST * laws[:, 0].max()) for each in found]


def resolved_beam(beam, strip, laws):
    """Beam longer than its crack on these laws, with elements that resolve it, and the number of its strips."""
    length = LONGER * arrest_length(forcelaw.energy(laws).mean(), beam)
    elements = int(np.ceil(length / (STRIPS * strip)))
    longer = replace(beam, length=elements * STRIPS * strip, elements=elements)
    return resolved(longer, elements * STRIPS, laws), elements * STRIPS


def cracks(beam, curves, step, laws, drawn):
    """ln l_s on the curves of each of SHAPES for the drawn samples (strips,), and by the beam of the package."""
    ground = np.ascontiguousarray(laws[drawn])
    start = release.START * min(arrest_length(forcelaw.energy(ground).max(), beam), beam.length)
    lengths = [
        crack_length(beam, (ground, table, drawn, step), start, finer)
        for table, finer in zip(curves, SHAPES.values(), strict=True)
    ]
    return np.log([*lengths, release.released_beam(beam, ground).crack_length])


def row(pair, humidity, reach, beams, samples):
    """One row of the table: pair, air, reach, beams, energies, their scatter, the share, and differences of cracks."""
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
    found, curves, alone = sampled(contact, humidity, in_si(Water, plan.air.water(pair)))
    vectors, limit = forcelaw.parametrise(*found)
    lawful = forcelaw.admissible(vectors, limit)
    laws = forcelaw.coefficients(vectors[lawful], limit)
    step = found.distance[1] - found.distance[0]
    every = shapes(found.distance, curves[lawful], vectors[lawful], limit)
    of_curves = vectors[lawful, 0] - right_energies(found.distance, curves[lawful], laws)
    share = 0.5 * np.mean(laws[:, 0] / laws[:, 2]) / of_curves.mean()
    one = cantilever(in_si(Cantilevers, sections(plan, pair)), pair)
    beam, strips = resolved_beam(one, to_si(STRIP, "um"), laws)
    rng = stream(config["seed"], "tails", pair)
    drawn = (rng.integers(len(laws), size=strips) for _ in range(beams))
    law, curve, right, left, parabola, own = np.array([cracks(beam, every, step, laws, each) for each in drawn]).T
    differences = (curve - law, right - law, left - law, curve - parabola, own - law)
    energies = vectors[:, 0]
    return [
        pair,
        Air(humidity).words,
        reach,
        str(beams),
        *(with_error(*mean_with_error(TO_MJ * one)) for one in (energies, alone)),
        f"{energies.std(ddof=1) / energies.mean():.2f}",
        f"{share:.2f}",
        *(with_error(*(100 * np.array(mean_with_error(one))), "+") for one in differences),
    ]


#: Pair, humidity (0 in dry air), reach of the attraction and number of beams: more where Eq. (12) is farthest off.
CASES = (
    ("b", 0.0, "all", 80),
    ("c", 0.0, "all", 80),
    ("c", 0.6, "all", 300),
    ("a", 0.0, "all", 80),
    ("c", 0.6, "touching", 300),
    ("b", 0.44, "touching", 80),
)
HEADER = (
    "pair",
    "air",
    "reach",
    "beams",
    "ē [mJ/m²]",
    "touching summits alone [mJ/m²]",
    "scatter of e",
    "energy left of d_max, Eq. (12) over curves",
    "ln l_s, curves over Eq. (12) [%]",
    "right branch of the curve over Eq. (12) [%]",
    "left branch of the curve over Eq. (12) [%]",
    "curves over parabola [%]",
    "package over Eq. (12) [%]",
)


def main():
    """Print the table as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=300)
    parser.add_argument("--rows", type=int, nargs="+", default=range(len(CASES)), help="of the table, from 0")
    sizes = parser.parse_args()
    print(f"| {' | '.join(HEADER)} |\n|{'---|' * len(HEADER)}", flush=True)  # noqa: T201
    for number in sizes.rows:
        print(f"| {' | '.join(row(*CASES[number], sizes.samples))} |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
