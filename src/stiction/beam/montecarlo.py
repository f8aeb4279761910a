"""Monte Carlo over beams: random force laws, random dimensions, one release each (Secs. III-C and IV, Figs. 14 and 15).

A beam is identified by its number: its result does not depend on the order, the batch or the number of threads.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.beam.release import EndState, released_beam
from stiction.progress import progress

#: Dimensions that scatter in the model GEO, in the order in which they are drawn.
SCATTERED = ("thickness", "length", "width", "gap")


@dataclass(frozen=True)
class Experiment:
    """One case: nominal beam, random substrate and scatter of its dimensions."""

    beam: Beam  #: nominal dimensions
    points: int  #: number of force laws along the beam, N_p
    #: ``draw_laws(n, rng)`` -> (n, 4) rows [f_max, d_max, a_left, a_right], SI
    draw_laws: Callable[[int, np.random.Generator], np.ndarray]
    scatter: float = 0.0  #: relative standard deviation of each dimension [-]; 0 in models G and NG

    def __post_init__(self):
        if self.points <= 0 or self.points % self.beam.elements:
            raise ValueError(f"{self.points} points do not spread evenly over {self.beam.elements} elements")
        if not self.scatter >= 0:
            raise ValueError(f"scatter must not be negative, got {self.scatter}")


@dataclass(frozen=True)
class Outcome:
    """Result of one beam."""

    sample: int  #: number of the beam
    state: EndState
    crack_length: float  #: l_s, `stiction.beam.release.crack_length` [m]; the length of the beam if it is free
    #: Γ of Eq. (13) [J m⁻²], an adhesion energy for an S-shape only. ASSUME: nominal dimensions, as in experiments.
    energy: float
    deflection: np.ndarray  #: of the nodes (elements + 1,) [m]
    imbalance: float  #: largest unbalanced force [N]
    iterations: int


def scattered_beam(beam: Beam, scatter: float, rng: np.random.Generator) -> Beam:
    """Beam with normally distributed thickness, length, width and gap of relative standard deviation ``scatter``.

    ASSUME: the four dimensions are independent; the mesh keeps its number of elements and points.
    """
    factors = 1 + scatter * rng.standard_normal(len(SCATTERED))
    return replace(
        beam, **{name: getattr(beam, name) * factor for name, factor in zip(SCATTERED, factors, strict=True)}
    )


def release_beam(experiment: Experiment, sample: int, rng: np.random.Generator) -> Outcome:
    """Draw the laws, then the dimensions, of one beam, by its number, from its stream and release it.

    The laws are drawn first, so that models with and without geometric scatter share them.

    Raises
    ------
    ValueError
        If the elements do not resolve a crack.
    NotConverged
        If no equilibrium is found.
    """
    laws = experiment.draw_laws(experiment.points, rng)
    beam = scattered_beam(experiment.beam, experiment.scatter, rng)
    end = released_beam(beam, laws)
    return Outcome(
        sample=sample,
        state=end.state,
        crack_length=end.crack_length,
        energy=apparent_adhesion_energy(end.crack_length, experiment.beam),
        deflection=end.equilibrium.deflection[:, 0],
        imbalance=end.equilibrium.imbalance,
        iterations=end.equilibrium.iterations,
    )


def simulate(
    experiment: Experiment, samples: Iterable[int], stream: Callable[[int], np.random.Generator], threads: int = 1
) -> Iterator[Outcome]:
    """Release many beams. Yields their outcomes in the order of ``samples``, their numbers, as they become available.

    ``stream(k)`` is the numpy.random.Generator of beam k. The results do not depend on the number of threads, in which
    beams are computed at a time.
    """
    with ThreadPoolExecutor(threads) as pool:
        yield from pool.map(lambda k: _numbered(experiment, k, stream(k)), samples)


def _numbered(experiment, sample, rng):
    """`release_beam`, with the number of the beam added to any error."""
    try:
        return release_beam(experiment, sample, rng)
    except (ValueError, RuntimeError) as error:
        error.add_note(f"in beam {sample}")
        raise


def columns(outcomes: Sequence[Outcome], shapes: int = 0) -> dict[str, np.ndarray]:
    """Outcomes of n beams as arrays, of all end states: select by ``state`` before averaging energies.

    The deflections of the first ``shapes`` beams are kept.

    Returns
    -------
    dict of arrays
        ``sample``, ``state``, ``crack_length``, ``energy``, ``imbalance``, ``iterations``, each (n,), and
        ``deflection`` (shapes, elements + 1), or (0,) without shapes.
    """
    names = ("sample", "state", "crack_length", "energy", "imbalance", "iterations")
    arrays = {name: np.array([getattr(outcome, name) for outcome in outcomes]) for name in names}
    return arrays | {"deflection": np.array([outcome.deflection for outcome in outcomes[:shapes]])}


def released_beams(
    experiment: Experiment, number: int, stream: Callable, threads: int = 1, shapes: int = 0
) -> dict[str, np.ndarray]:
    """`columns` of the first beams of an experiment, with a bar of the progress. Arguments as in `simulate`."""
    outcomes = simulate(experiment, range(number), stream, threads)
    return columns(list(progress(outcomes, "beams", total=number)), shapes)
