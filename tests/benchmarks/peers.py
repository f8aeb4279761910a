"""Measure the CPU time of the same work here and in public libraries: ``make peers``. This is no test.

Each row states how far both results agree, or what the library leaves out. The libraries are in the extra ``peers``.
"""

import os
import platform
import time
from importlib.metadata import version
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import chaospy  # noqa: E402
import ContactMechanics  # noqa: E402
import numpy as np  # noqa: E402
import openturns  # noqa: E402
import SurfaceTopography  # noqa: E402
import tamaas  # noqa: E402
from scipy.integrate import solve_bvp  # noqa: E402
from stages import CONFIG, shown, vectors  # noqa: E402
from SurfaceTopography.Generation import fourier_synthesis  # noqa: E402

from stiction.beam.release import released_beam  # noqa: E402
from stiction.chaos.coordinates import principal_coordinates  # noqa: E402
from stiction.chaos.density import conditional_quantiles, kernel_density  # noqa: E402
from stiction.contact.environment import Water  # noqa: E402
from stiction.contact.full import elements  # noqa: E402
from stiction.contact.full.halfspace import HalfSpace  # noqa: E402
from stiction.streams import stream  # noqa: E402
from stiction.study import PairStudy  # noqa: E402

#: Rows of conditional quantiles that a library computes, and that the fit of a chaos model needs.
FEW, NEEDED = 5, 2000
#: E' of two silicon half-spaces [Pa].
MODULUS = 86.6e9
#: Humidity, height of its film [m], and tension in it [Pa].
HUMIDITY = 0.67
FILM, TENSION = Water(300.0).film(HUMIDITY)


def in_turn(work, ours, peers, repeats):
    """Rows of the table: median CPU times of calls in turn. The first calls, which may compile, are left out.

    Each peer has a call, the part of our work that it does, and what both results say.
    """
    calls = [ours, *(call for call, _, _ in peers.values())]
    seconds = np.median([[cpu_time(call, k) for call in calls] for k in range(repeats + 1)][1:], axis=0)
    for (name, (_, part, said)), spent in zip(peers.items(), seconds[1:], strict=True):
        own = part * seconds[0]
        yield work, shown(own), name, shown(spent), f"{float(f'{spent / own:.2g}'):g}", said


def cpu_time(call, k):
    """CPU time of one call [s]."""
    start = time.process_time()
    call(k)
    return time.process_time() - start


def surface_rows():
    """One rough surface of pair b's beam: a strip of a non-Gaussian field, beside a Gaussian field of the same size."""
    surface = PairStudy.of(CONFIG, "b").surfaces.beam
    points, spacing = surface.grid.field_shape, surface.grid.spacing
    sides, rms = tuple(n * spacing for n in points), 3.4e-9
    long, short = 2 * np.pi / 12e6, 2 * np.pi / 125e6

    def synthesis(k):
        fourier_synthesis(
            points, sides, hurst=0.9, rms_height=rms, short_cutoff=short, long_cutoff=long, rng=np.random.default_rng(k)
        ).heights()

    def random_phase(k):
        spectrum = tamaas.Isopowerlaw2D()
        spectrum.q0, spectrum.q1, spectrum.q2, spectrum.hurst = 2, 4, 60, 0.9
        generator = tamaas.SurfaceGeneratorRandomPhase2D(list(points))
        generator.spectrum, generator.random_seed = spectrum, k
        generator.buildSurface()

    said = "Gaussian heights, power law alone"
    yield from in_turn(
        f"one rough surface of {points[0]} × {points[1]} points",
        lambda k: surface.draw(stream(1, k)),
        {"SurfaceTopography": (synthesis, 1, said), "tamaas": (random_phase, 1, said)},
        8,
    )


def patch():
    """Heights [m] of a patch of pair b, its sides [m], half-space, and a distance at which summits touch [m]."""
    pair = PairStudy.of(CONFIG, "b").surfaces
    heights = pair.draw(stream(1, 1), stream(2, 1))[:, :1000].copy()
    spacing = pair.beam.grid.spacing
    sides = tuple(n * spacing for n in heights.shape)
    return heights, sides, HalfSpace(heights.shape, spacing, MODULUS), float(heights.mean() + 1.5 * heights.std())


def contact_rows():
    """Elastic contact of a patch without adhesion, at equal mean pressure."""
    heights, sides, space, distance = patch()
    state = elements.equilibrium(space, heights, distance)
    pressure, touching = float(state.pressure.mean(dtype=float)), np.mean(state.pressure > 0)
    double, found = heights.astype(float), {}

    def polonsky_keer(_):
        model = tamaas.Model(tamaas.model_type.basic_2d, list(sides), list(heights.shape))
        model.E, model.nu = MODULUS, 0.0
        tamaas.PolonskyKeerRey(model, double, 1e-6).solve(pressure)
        found["tamaas"] = np.mean(model.traction[:] > 0)

    def constrained(_):
        topography = SurfaceTopography.Topography(double, sides, periodic=True)
        half_space = ContactMechanics.PeriodicFFTElasticHalfSpace(heights.shape, MODULUS, sides)
        system = ContactMechanics.make_system(substrate=half_space, surface=topography)
        result = system.minimize_proxy(external_force=pressure * np.prod(sides), pentol=2e-12)
        found["ContactMechanics"] = np.mean(result.jac > 0)

    tamaas.set_log_level(tamaas.LogLevel.error)
    peers = {"tamaas": polonsky_keer, "ContactMechanics": constrained}
    for call in peers.values():
        call(0)
    said = {name: f"{100 * found[name]:.2f} % of the points touch, here {100 * touching:.2f} %" for name in peers}
    yield from in_turn(
        f"elastic contact of {heights.shape[0]} × {heights.shape[1]} points",
        lambda _: elements.equilibrium(space, heights, distance),
        {name: (call, 1, said[name]) for name, call in peers.items()},
        3,
    )


def meniscus_rows():
    """Elastic contact of a patch in a film of water, at equal mean gap: its suction does not depend on the gap."""
    heights, sides, space, distance = patch()
    film, double = elements.Adhesion(FILM, TENSION), heights.astype(float)
    state = elements.equilibrium(space, heights, distance, film)
    gap, found = float(state.gap.mean(dtype=float)), {}

    def cohesive(_):
        model = tamaas.Model(tamaas.model_type.basic_2d, list(sides), list(heights.shape))
        model.E, model.nu = MODULUS, 0.0
        by_gap = tamaas.PolonskyKeerRey.gap
        solver = tamaas.PolonskyKeerRey(model, double, 1e-6, by_gap, by_gap)
        potential = tamaas.MaugisAdhesionFunctional(double)
        potential.parameters = {"rho": FILM, "surface_energy": TENSION * FILM}
        solver.addFunctionalTerm(potential)
        solver.solve(gap)
        gaps = model.displacement[:] - double
        found.update(force=model.traction[:].mean(), wet=np.mean(gaps - gaps.min() < FILM))

    cohesive(0)
    said = (
        f"force {found['force'] / 1e6:.3g} MPa, here {state.force / 1e6:.3g}; "
        f"{100 * found['wet']:.1f} % wet, here {100 * np.mean(state.gap < FILM):.1f} %"
    )
    yield from in_turn(
        f"the same patch with menisci, RH {HUMIDITY}",
        lambda _: elements.equilibrium(space, heights, distance, film),
        {"tamaas": (cohesive, 1, said)},
        3,
    )


def quantile_rows():
    """Quantiles of the last of four coordinates given the first three, of the kernel density of 1000 samples."""
    sample = vectors()[:1000]
    coordinates = principal_coordinates(sample).reduce(sample)
    density = kernel_density(coordinates)
    given, probability = np.tile(coordinates[:, :3], (2, 1)), np.array([0.3])
    bandwidth = openturns.Point([density.bandwidth] * 4)
    kernels = openturns.KernelSmoothing().build(openturns.Sample(np.column_stack(density.centres)), bandwidth)
    gaussians = chaospy.GaussianKDE(np.array(density.centres), density.bandwidth**2 * np.eye(4))
    known = kernels.getMarginal([0, 1, 2]), gaussians

    def by_openturns(_):
        return [kernels.computeConditionalQuantile(probability[0], list(row)) for row in given[:FEW]]

    def by_chaospy(_):
        uniform = np.vstack(
            [known[1].fwd(np.column_stack([given[:FEW], given[:FEW, :1]]).T)[:3], [probability[0]] * FEW]
        )
        return known[1].inv(uniform)[3]

    exact = conditional_quantiles(density, given, probability)[:FEW, 0]
    said = {
        call: f"largest difference {np.max(np.abs(np.array(call(0)) - exact)):.1g} of unit variance"
        for call in (by_openturns, by_chaospy)
    }
    yield from in_turn(
        f"{FEW} conditional quantiles of a density of 1000 kernels",
        lambda _: conditional_quantiles(density, given, probability),
        {
            "OpenTURNS": (by_openturns, FEW / NEEDED, said[by_openturns]),
            "chaospy": (by_chaospy, FEW / NEEDED, said[by_chaospy]),
        },
        3,
    )


def beam_rows():
    """Release of one beam with one force law, beside a solver of boundary values that starts at the solution."""
    beam = PairStudy.of(CONFIG, "b").beam
    law = np.array([3e5, 5.3e-9, 1.07e9, 1.52e9])
    laws = np.tile(law, (1000, 1))
    end = released_beam(beam, laws)
    x, (u, slope) = beam.nodes / beam.length, end.equilibrium.deflection.T
    curvature = np.gradient(slope * beam.length / beam.gap, x)
    start = np.array([u / beam.gap, slope * beam.length / beam.gap, curvature, np.gradient(curvature, x)])
    scale = beam.width * beam.length**4 / (beam.bending_stiffness * beam.gap)
    found = {}

    def derivatives(_, y):
        return np.array([y[1], y[2], y[3], scale * attraction(law, beam.gap * (1 - y[0]))])

    def ends(left, right):
        return np.array([left[0], left[1], right[2], right[3]])

    def boundary_values(_):
        solution = solve_bvp(derivatives, ends, x, start, tol=1e-3, max_nodes=20_000)
        found["tip"] = beam.gap * solution.y[0, -1] if solution.success else np.nan

    boundary_values(0)
    said = f"deflection of the tip {1e6 * found['tip']:.4f} µm, here {1e6 * u[-1]:.4f} µm"
    yield from in_turn(
        "release of one beam", lambda _: released_beam(beam, laws), {"scipy.solve_bvp": (boundary_values, 1, said)}, 5
    )


def attraction(law, distance):
    """Attraction at distances by a force law, Eq. (12) [Pa]."""
    largest, at, before, beyond = law
    rate = np.where(distance < at, before, beyond)
    e = np.exp(-np.clip(rate * (distance - at), -20, 60))
    return largest * e * (2 - e)


def main():
    """Print the table."""
    cpu = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":")[1].strip() for line in cpu if line.startswith("model name")), "?")
    names = "SurfaceTopography", "tamaas", "ContactMechanics", "openturns", "chaospy", "scipy"
    libraries = ", ".join(f"{name} {version(name)}" for name in names)
    print(f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}, one core used; {libraries}\n")  # noqa: T201
    print("| work | stiction | library | its time | ratio | results |\n|---|---|---|---|---|---|")  # noqa: T201
    for rows in (surface_rows, contact_rows, meniscus_rows, quantile_rows, beam_rows):
        for row in rows():
            print("| " + " | ".join(row) + " |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
