"""Compile and cache the kernels of the paper before jobs run in parallel: ``python -m stiction.run.warmup``.

Kernels that are not in the cache are compiled by processes of their own, whose memory is free again when they end. The
parts have no kernel in common, so that none is compiled twice. Kernels of other studies (islands) are compiled by the
first jobs that need them.
"""

import sys
from multiprocessing import get_context

import numpy as np
from numba.core.event import Listener, install_listener

from stiction.beam.cantilever import Beam
from stiction.beam.middle import shortest_held
from stiction.beam.release import release
from stiction.beam.tension import end_stiffness
from stiction.chaos import model as chaos
from stiction.contact import forcelaw, separation
from stiction.contact.asperity import asperity, reduced_modulus
from stiction.contact.full import descent, elements
from stiction.contact.full.elements import GAPS, Adhesion
from stiction.contact.full.halfspace import HalfSpace
from stiction.contact.pair import SurfacePair
from stiction.contact.tilt import Tilt
from stiction.contact.tilted import TiltedPair
from stiction.contact.vanderwaals import attraction
from stiction.streams import stream
from stiction.surface import maxent
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.spectrum import CutoffSelfAffine
from stiction.surface.translation import Translation


def contact_kernels() -> None:
    """Run the kernels of surfaces and contact on a small problem."""
    rng = stream(0)
    grid = StripGrid(1e-6, 1e-6, 1e-8, 0.0)
    translation = Translation(maxent.GAUSSIAN)
    translation.autocorrelation(0.5)
    surface = RoughSurface(CutoffSelfAffine(1e-33, 1e-34, 1e7, 1e8), translation, 1e-9, grid)
    for through in ("water", "none"):
        model = asperity(reduced_modulus(164e9, 0.23), attraction(through))
        pair = SurfacePair(surface, surface, 1e-10, asperity=model)
        solid, bearing = pair.contact(pair.draw(rng, rng))
    starts = pair.distances.solid[0], pair.distances.bearing[0]
    stored = [values[None].astype(np.float32) for values in (solid, bearing)]
    distance, curve = forcelaw.humid_curves(*stored, starts, 1e-10, (1e-9, 1e6))
    forcelaw.parametrise(distance, curve, 1)
    separation.keep_volume(np.linspace(1.0, -1.0, distance.size), distance, stored[1][0], starts[1], (1e-9, 1e6))
    tip = TiltedPair(surface, surface, 1e-10, asperity=model, tilt=Tilt((0.01, 0.1), 1e-8))
    starts = tip.distances.solid[0], tip.distances.bearing[0]
    stored = [values[None].astype(np.float32) for values in tip.contact(tip.draw(rng, rng))]
    forcelaw.largest_attractions(*stored, starts, 1e-10, (1e-9, 1e6))


def full_contact_kernels() -> None:
    """Run the kernels of full elastic contact on a small problem."""
    heights = stream(0).normal(0.0, 1e-9, (32, 32)).astype(np.float32)
    space = HalfSpace(heights.shape, 1e-8, 1e11)
    adhesion = Adhesion(2e-9, 1e7, 1e7, 1e-9, work=np.linspace(1e-3, 0.0, GAPS.size))
    for solve in (elements.equilibrium, descent.equilibrium):
        state = solve(space, heights, 1e-9, adhesion)
    state.energy(heights, adhesion)
    _ = state.residual


def chaos_kernels() -> None:
    """Run the kernels of the chaos model on a small problem."""
    vectors = np.exp(0.1 * stream(0).standard_normal((50, 4))) * [7e-3, 2e6, 8e-9, 4e-9]
    chaos.draw_laws(chaos.fit(vectors, 2e6, 2, 1e-9), 200, stream(0))


def beam_kernels() -> None:
    """Run the kernels of the beams on a small problem."""
    release(Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 200), np.tile([2e6, 8e-9, 6e8, 5e8], (200, 1)), 300e-6)
    shortest_held(Beam(10e-6, 30e-6, 2.6e-6, 164e9, 2e-6, 20), np.tile([2e6, 8e-9, 6e8, 5e8], (20, 1)), 300e-6)
    end_stiffness(1.0)


#: Parts that may be compiled at the same time, the longest first.
PARTS = (beam_kernels, contact_kernels, full_contact_kernels, chaos_kernels)


class _NotCachedError(Exception):
    """Signal of a kernel without machine code in the cache."""


class _OnlyCached(Listener):
    """Refuses to compile."""

    def on_start(self, _event):
        """Refuse to compile."""
        raise _NotCachedError

    def on_end(self, _event):
        """Do nothing."""
        pass


def main() -> None:
    """Load all kernels. If one is not in the cache, compile each part in another process first."""
    try:
        with install_listener("numba:compile", _OnlyCached()):
            load()
    except _NotCachedError:
        context = get_context("fork" if sys.platform == "linux" else "spawn")
        compiling = [context.Process(target=kernels) for kernels in PARTS]
        for process in compiling:
            process.start()
        for process in compiling:
            process.join()
        load()  # a part whose process failed fails here as well, with its error


def load() -> None:
    """Run all parts in this process."""
    for kernels in PARTS:
        kernels()


if __name__ == "__main__":
    main()
