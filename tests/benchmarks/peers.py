"""Measure the CPU time of the same work here and in public libraries: ``make peers``. This is no test.

Each row states how far both results agree, or what the library leaves out. The libraries are in the extra ``peers``.
"""

import os
import platform
import tempfile
import time
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import chaospy  # noqa: E402
import ContactMechanics  # noqa: E402
import numpy as np  # noqa: E402
import openturns  # noqa: E402
import peer_chain  # noqa: E402
import SurfaceTopography  # noqa: E402
import tamaas  # noqa: E402
from scipy.integrate import solve_bvp  # noqa: E402
from scipy.interpolate import PchipInterpolator  # noqa: E402
from stages import CONFIG, STRIPS, shown, vectors  # noqa: E402
from SurfaceTopography.Generation import fourier_synthesis  # noqa: E402

from stiction.beam.montecarlo import Experiment, simulate  # noqa: E402
from stiction.beam.release import released_beam  # noqa: E402
from stiction.chaos import model as chaos  # noqa: E402
from stiction.chaos.coordinates import principal_coordinates  # noqa: E402
from stiction.chaos.density import conditional_quantiles, kernel_density  # noqa: E402
from stiction.config import files  # noqa: E402
from stiction.config.units import in_si  # noqa: E402
from stiction.contact import forcelaw  # noqa: E402
from stiction.contact.environment import Water, force_curves  # noqa: E402
from stiction.contact.full import elements  # noqa: E402
from stiction.contact.full.halfspace import HalfSpace  # noqa: E402
from stiction.scans.reading import Source, read  # noqa: E402
from stiction.streams import stream  # noqa: E402
from stiction.study import PairStudy  # noqa: E402
from stiction.surface.spectrum import CutoffSelfAffine  # noqa: E402

#: The paper's pair b without van der Waals forces.
HERTZ = files.load({"van_der_waals": "none", "contact": {"samples": 5}, "chaos": {"order": 1}})
#: Chain from surfaces to cracks: patches and their points, beams, force laws along each, and order of the chaos model.
PAIRS, PATCH, BEAMS, ORDER = 20, (150, 1000), 20, 3
#: Largest relative difference of its mean cracks: models of contact may differ by a third in e, to whose power -1/4
#: lengths go, and 20 beams have a standard error of 2 %.
TOLERANCE = 0.1
#: Humidity of the chain, with cracks far from the end of a beam, height of its film [m], and tension in it [Pa].
WET = 0.8
WET_FILM = Water(300.0).film(WET)
#: Distances in full contact: first, last [m], and their number.
FULL = 4e-9, 22e-9, 19
#: How the library writes a scan, by the ending of the file, and files without sizes and units.
WRITERS = {
    "gwy": lambda surface, path: surface.to_gwy(str(path)),
    "x3p": lambda surface, path: surface.to_x3p(str(path)),
    "nc": lambda surface, path: surface.to_netcdf(str(path)),
    "npy": lambda surface, path: np.save(path, 1e9 * surface.heights()),
    "txt": lambda surface, path: np.savetxt(path, 1e9 * surface.heights().T, "%.6f"),
}
BARE = {"npy", "txt"}
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
        yield row(work, part * seconds[0], name, spent, said)


def row(work, own, name, spent, said):
    """Row of the table, of times [s]."""
    return work, shown(own), name, shown(spent), f"{float(f'{spent / own:.2g}'):g}", said


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
        return np.array([y[1], y[2], y[3], scale * peer_chain.attraction(law, beam.gap * (1 - y[0]))])

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


def scan_rows():
    """Reading one scan of 512 × 512 points from files of several formats, beside the library that reads some of them.

    Here the file is also checked: channel, units, axes, undefined points and lines that stand there twice.
    """
    heights, side = 3.4e-9 * stream(7).standard_normal((512, 512)), 10e-6
    surface = SurfaceTopography.Topography(heights, (side, side), unit="m")
    given = Source(size=(side, side), height_unit="nm")
    with tempfile.TemporaryDirectory() as folder:
        for ending, write in WRITERS.items():
            path = Path(folder) / f"scan.{ending}"
            write(surface, path)
            bare = ending in BARE
            keys = {"physical_sizes": (side, side), "unit": "nm"} if bare else {}
            yield from reading_row(path, given if bare else None, keys)


def reading_row(path, given, keys):
    """Row of one file, with the largest difference of the heights, and that to a map upside down as a control."""

    def by_library(_):
        topography = SurfaceTopography.read_topography(path, **keys)
        return topography.to_unit("m").heights()

    own, theirs = read(path, given).scan.heights, by_library(0)
    apart, control = (np.abs(own - other).max() / own.std() for other in (theirs, theirs[:, ::-1]))
    said = f"heights differ by {apart:.1g} rms at most, by {control:.1g} from those upside down"
    yield from in_turn(
        f"reading of a scan of 512 × 512 points, {path.suffix[1:]}",
        lambda _: read(path, given),
        {"SurfaceTopography": (by_library, 1, said)},
        5,
    )


def chain_rows():
    """Cracks of beams from two spectra, with sums over summits and in full contact, beside public libraries.

    Results are of the surfaces that the libraries drew. The cracks of both sides may differ by `TOLERANCE`.
    """
    chain, found = Chain(PairStudy.of(HERTZ, "b", "G")), {}
    spent = cpu_time(lambda k: found.update(chain.by_libraries(k)), 1)
    for name, vectors_of in {"sums over summits": chain.on_summits, "full contact": chain.in_full}.items():
        own = np.median([cpu_time(partial(chain.run, vectors_of), k) for k in range(3)][1:])
        vectors, limit = vectors_of(found["heights"])
        cracks, energy = chain.cracks((vectors, limit)), vectors[:, 0].mean() / found["vectors"][:, 0].mean()
        if abs(cracks.mean() / found["cracks"].mean() - 1) > TOLERANCE:
            raise ValueError(f"cracks of {cracks.mean():.3g} m differ from {found['cracks'].mean():.3g} m")
        said = (
            f"cracks {mean(found['cracks'])} µm, here {mean(cracks)} (tolerance {100 * TOLERANCE:.0f} %); e here "
            f"{100 * energy - 100:+.0f} %; one beam with the same laws {found['one']:.1f} µm, here "
            f"{chain.one(found['laws']):.1f}"
        )
        work = f"{PAIRS} patches of {PATCH[0]} × {PATCH[1]} points, curves, model, {BEAMS} beams: {name}"
        yield row(work, own, "SurfaceTopography, ContactMechanics, OpenTURNS, scipy", spent, said)


def mean(lengths):
    """Mean of lengths with its standard error [µm], from [m]."""
    return f"{1e6 * np.mean(lengths):.0f} ± {1e6 * np.std(lengths, ddof=1) / len(lengths) ** 0.5:.0f}"


@dataclass(frozen=True)
class Chain:
    """Chain from surfaces to cracks of one pair, without van der Waals forces."""

    study: PairStudy

    def heights(self, seed):
        """Patches of both surfaces."""
        pair = self.study.surfaces
        draws = (pair.draw(stream(seed, 1, k), stream(seed, 2, k)) for k in range(PAIRS))
        return [drawn[:, : PATCH[1]].copy() for drawn in draws]

    def on_summits(self, heights):
        """Vectors of Eq. (11) and f_limit, from sums over summits."""
        pair = self.study.surfaces
        solid, bearing = (np.array(each) for each in zip(*map(pair.contact, heights), strict=True))
        grid = pair.distances
        starts = grid.solid[0], grid.bearing[0]
        return forcelaw.parametrise(*force_curves(solid, bearing, starts, grid.step, WET, Water(300.0)))

    def in_full(self, heights):
        """Vectors of Eq. (11) and f_limit, from full elastic contact that the film deforms as well."""
        spacing, film = self.study.surfaces.spacing, elements.Adhesion(*WET_FILM)
        space, distances = HalfSpace(PATCH, spacing, MODULUS), np.linspace(*FULL)
        fine = np.linspace(*FULL[:2], peer_chain.FINE)
        curves = []
        for z in heights:
            forces = [elements.equilibrium(space, z, d + z.mean(), film).force for d in distances]
            curves.append(PchipInterpolator(distances, forces)(fine))
        return forcelaw.parametrise(fine, curves.__getitem__, len(curves))

    def run(self, vectors_of, seed):
        """Cracks of beams [m], from one of the two contacts."""
        return self.cracks(vectors_of(self.heights(seed)))

    def cracks(self, parameters):
        """Cracks of beams of a chaos model of vectors and f_limit [m]."""
        model = chaos.fit(*parameters, ORDER, 0.001)
        experiment = Experiment(self.study.beam, STRIPS, partial(chaos.draw_laws, model))
        return np.array([end.crack_length for end in simulate(experiment, range(BEAMS), partial(stream, 8))])

    def one(self, laws):
        """Crack of one beam with given laws [µm]."""
        return 1e6 * released_beam(self.study.beam, laws).crack_length

    def by_libraries(self, seed):
        """Surfaces, vectors and cracks by public libraries, and laws and crack of the first beam."""
        pair, beam = self.study.surfaces, self.study.beam
        spectra = [in_si(CutoffSelfAffine, HERTZ["surfaces"][side]["published_psd"]) for side in ("B2", "Sub1")]
        patch = peer_chain.Patch(PATCH, pair.spacing, MODULUS, WET_FILM)
        shape = pair.beam.grid.field_shape
        fields = (peer_chain.drawn(spectra, shape, pair.spacing, seed + k) for k in range(PAIRS))
        heights = [field[: PATCH[0], : PATCH[1]].copy() for field in fields]
        vectors, limit = peer_chain.vectors([patch.curve(z) for z in heights])
        along = [peer_chain.laws(vectors, limit, STRIPS) for _ in range(BEAMS)]
        cracks = np.array([peer_chain.crack(beam, laws) for laws in along])
        heights = [z.astype(np.float32) for z in heights]
        return {"heights": heights, "vectors": vectors, "cracks": cracks, "one": 1e6 * cracks[0], "laws": along[0]}


def main():
    """Print the table."""
    cpu = Path("/proc/cpuinfo").read_text().splitlines()
    model = next((line.split(":")[1].strip() for line in cpu if line.startswith("model name")), "?")
    names = "SurfaceTopography", "tamaas", "ContactMechanics", "openturns", "chaospy", "scipy"
    libraries = ", ".join(f"{name} {version(name)}" for name in names)
    print(f"{model}, {os.cpu_count()} cores, Python {platform.python_version()}, one core used; {libraries}\n")  # noqa: T201
    print("| work | stiction | library | its time | ratio | results |\n|---|---|---|---|---|---|")  # noqa: T201
    for rows in (surface_rows, contact_rows, meniscus_rows, quantile_rows, beam_rows, scan_rows, chain_rows):
        for row in rows():
            print("| " + " | ".join(row) + " |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
