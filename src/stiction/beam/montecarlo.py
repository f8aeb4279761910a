"""Monte Carlo over beams: random force laws, random dimensions, one release each (Sec. III-C and IV, Figs. 14 and 15).

A beam is known by its number: the same number gives the same result in every order, batch and number of threads.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from stiction.beam.cantilever import Beam, EndState, crack_length, end_state, release
from stiction.beam.energy import adhesion_energy, arrest_length
from stiction.contact import forcelaw

#: Dimensions that scatter in the model GEO, in the order in which they are drawn.
SCATTERED = ("thickness", "length", "width", "gap")
#: The artificial load leaves this part of the crack length that Eq. (13) expects of the mean adhesion.
START = 1 / 3


@dataclass(frozen=True)
class Experiment:
    """One case: the nominal beam, its random substrate and the scatter of its dimensions."""

    beam: Beam  #: nominal dimensions
    points: int  #: force laws along the beam, N_p
    draw_laws: Callable  #: ``draw_laws(rng, n)`` -> (n, 4) rows [f_max, d_max, a_left, a_right], SI
    scatter: float = 0.0  #: relative standard deviation of each dimension [-]; 0 in models G and NG

    def __post_init__(self):
        if self.points <= 0 or self.points % self.beam.elements:
            raise ValueError(f"{self.points} points do not spread evenly over {self.beam.elements} elements")
        if not self.scatter >= 0:
            raise ValueError(f"scatter must not be negative, got {self.scatter}")


@dataclass(frozen=True)
class Outcome:
    """How one beam ended."""

    sample: int  #: its number
    state: EndState
    crack_length: float  #: l_s, up to the first contact [m]; the length of the beam if it is free
    #: Γ of Eq. (13) [J m⁻²], an adhesion energy for an S-shape only. ASSUME: of nominal dimensions, as in experiments.
    energy: float
    deflection: np.ndarray  #: of the nodes (elements + 1,) [m]
    imbalance: float  #: largest unbalanced force [N]
    iterations: int


def scattered_beam(beam, scatter, rng):
    """Beam with normally distributed thickness, length, width and gap of relative standard deviation ``scatter``.

    ASSUME: the four dimensions are independent; the mesh keeps its number of elements and points.
    """
    factors = 1 + scatter * rng.standard_normal(len(SCATTERED))
    return replace(
        beam, **{name: getattr(beam, name) * factor for name, factor in zip(SCATTERED, factors, strict=True)}
    )


def release_beam(experiment, sample, rng):
    """Draw the laws, then the dimensions, of one beam and release it.

    The laws come first, so that models with and without geometric scatter share them.

    Parameters
    ----------
    experiment : Experiment
    sample : int
        Number of the beam.
    rng : numpy.random.Generator
        The stream of this beam.

    Returns
    -------
    Outcome

    Raises
    ------
    NotConverged
        If the beam finds no equilibrium.
    """
    laws = experiment.draw_laws(rng, experiment.points)
    beam = scattered_beam(experiment.beam, experiment.scatter, rng)
    expected = min(arrest_length(forcelaw.energy(laws).mean(), beam), beam.length)
    end = release(beam, laws, START * expected)
    crack = crack_length(beam, laws, end.deflection)
    return Outcome(
        sample=sample,
        state=end_state(beam, laws, end.deflection),
        crack_length=crack,
        energy=adhesion_energy(crack, experiment.beam),
        deflection=end.deflection[:, 0],
        imbalance=end.imbalance,
        iterations=end.iterations,
    )


def simulate(experiment, samples, stream, threads=1):
    """Release many beams; yields their outcomes in the order of ``samples`` as they get done.

    Parameters
    ----------
    experiment : Experiment
    samples : iterable of int
        Numbers of the beams, for instance one chunk of all.
    stream : callable
        ``stream(k)`` is the numpy.random.Generator of beam k.
    threads : int
        Beams that are in work at once; no result depends on it.

    Yields
    ------
    Outcome
    """
    with ThreadPoolExecutor(threads) as pool:
        yield from pool.map(lambda k: _numbered(experiment, k, stream(k)), samples)


def _numbered(experiment, sample, rng):
    """`release_beam`, whose errors name the beam."""
    try:
        return release_beam(experiment, sample, rng)
    except (ValueError, RuntimeError) as error:
        error.add_note(f"in beam {sample}")
        raise


def columns(outcomes, shapes=0):
    """Outcomes as arrays over the samples, without gaps: whoever averages energies selects ``state`` first.

    Parameters
    ----------
    outcomes : sequence of Outcome, n of them
    shapes : int
        Number of beams, from the first on, whose deflection is kept.

    Returns
    -------
    dict of arrays
        ``sample``, ``state``, ``crack_length``, ``energy``, ``imbalance``, ``iterations``, each (n,), and
        ``deflection`` (shapes, elements + 1).
    """
    names = ("sample", "state", "crack_length", "energy", "imbalance", "iterations")
    arrays = {name: np.array([getattr(outcome, name) for outcome in outcomes]) for name in names}
    return arrays | {"deflection": np.array([outcome.deflection for outcome in outcomes[:shapes]])}
