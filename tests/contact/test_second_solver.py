"""Full contact by a second route: another algorithm, another wall and another grid of waves than the package.

The gaps minimise the whole energy by a quasi-Newton method, without contact conditions: solids are Lennard-Jones walls,
whose potential repels at contact and attracts across gaps, in place of hard elements under a Dugdale stress. Waves have
the stiffness of a continuous half-space.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest
from plans import job_settings
from scipy import fft, optimize
from small import heights_of, spectrum_of

from stiction.analysis.levels import FINE, SUMMITS
from stiction.config.cases import case_id
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.full import elements
from stiction.contact.gaps import work_across_film
from stiction.plan.plan import Plan
from stiction.stages.contact import full_contact, full_energy, tips_in_full_contact
from stiction.stages.contact.curves import curve_of_tip
from stiction.stages.contact.pairs import streams_of_sides

#: Width of the edge of the film, which is a step in the package [m].
EDGE = 2e-11
#: Deepest overlap for which a wall keeps its potential, which goes on as a line beyond [m].
DEEPEST = -0.08e-9
#: Stiffness added to every wave, so that the descent moves gaps as a whole as well [Pa m⁻¹].
SPRINGS = 2e17


@dataclass(frozen=True)
class Walls:
    """Rough strip of heights z (n1, n2) [m] against a flat, under a film and the potential of its solids."""

    heights: np.ndarray
    spacing: float  #: [m]
    modulus: float  #: E' [Pa]
    film: tuple[float, float]  #: height [m] and tension [Pa]
    work: object  #: of the solids from a gap on [J m⁻²], also below zero

    @property
    def stiffness(self):
        """Stiffness of each wave [Pa m⁻¹], E' k / 2."""
        n1, n2 = self.heights.shape
        waves = np.hypot(fft.fftfreq(n1, self.spacing)[:, None], fft.rfftfreq(n2, self.spacing))
        return np.pi * self.modulus * waves

    def filtered(self, values, factor):
        """Values with every wave times a factor."""
        return fft.irfft2(fft.rfft2(values) * factor, s=values.shape)

    def potential(self, gap):
        """Work of film and solids from gaps on [J m⁻²], and its derivative [Pa]."""
        (height, tension), step = self.film, 1e-13
        depth = (height - gap) / EDGE
        wet = tension * EDGE * np.logaddexp(0, depth)
        pull = tension / (1 + np.exp(-np.clip(depth, -500, 500)))
        low = np.maximum(gap, DEEPEST)
        slope = (self.work(low + step) - self.work(low - step)) / (2 * step)
        return wet + self.work(low) + slope * (gap - low), -pull + slope

    def energy(self, gap):
        """Energy [J m⁻²] and its gradient [Pa] at gaps."""
        displacement = gap + self.heights
        traction = self.filtered(displacement, self.stiffness)
        work, slope = self.potential(gap)
        return np.mean(displacement * traction / 2 - work), traction - slope

    def minimum(self, gap, is_free=True):
        """Gaps with the least energy near others, with a free mean or theirs, and the energy [J m⁻²]."""
        waves = self.stiffness + SPRINGS
        waves[0, 0] = SPRINGS if is_free else np.inf
        mean, unit = 0.0 if is_free else gap.mean(), 1e-9 * np.sqrt(self.stiffness[0, 1])

        def of(scaled):
            """Gaps of waves in units of their stiffness, which the descent takes for a sphere."""
            return mean + unit * self.filtered(scaled.reshape(gap.shape), waves**-0.5)

        def energy(scaled):
            """Energy and gradient in units of the descent."""
            value, gradient = self.energy(of(scaled))
            return 1e6 * value, 1e6 * unit * self.filtered(gradient, waves**-0.5).ravel() / gap.size

        start = self.filtered(gap - mean, np.where(np.isfinite(waves), waves, 0) ** 0.5).ravel() / unit
        options = {"maxiter": 4000, "maxfun": 6000, "ftol": 1e-11, "gtol": 1e-10, "maxcor": 20}
        found = optimize.minimize(energy, start, jac=True, method="L-BFGS-B", options=options)
        return of(found.x), found.fun / 1e6

    def largest_attraction(self, gap, step):
        """Largest attraction [Pa] of gaps at rest, in steps of their mean [m], as a separation meets it."""
        forces = [0.0]
        while forces[-1] == min(forces):
            gap, _ = self.minimum(gap + step, is_free=False)
            forces.append(self.potential(gap)[1].mean())
        return -min(forces)


PLAN = Plan(
    load(
        {
            "run": {"pairs": ["b"]},
            "beam": {"width_um": 4},
            "character": {"strips": 3},
            "identification": {"patches": 2, "patch_um": 2},
            "studies": {"iteration": {"iterations": 2, "fields": 2}},
        }
    )
)


def strips_at(humidity):
    """Strips of pair b like those of stage full_energy."""
    settings = in_si(full_energy.Settings, job_settings(PLAN, "studies/full_contact/energy/b_rh044"))
    settings = replace(settings, humidities=(humidity,))
    if not humidity:
        settings = replace(settings, van_der_waals="dry", water=settings.water.at(0.0))
    strips = full_energy.strips_of([(heights_of(name), spectrum_of(name)) for name in PLAN.sides("b")], "b", settings)
    strips.energy(SUMMITS, 0)
    return strips, strips.heights(strips.resisting[0])


def walls_like(strips, heights):
    """Walls with the surfaces, water and solids of some strips."""
    film, gaps, space = strips.water.film(strips.humidity), strips.water.gaps, strips.levels[FINE].space
    flats = gaps.through(gaps.summits), gaps.through("dry")
    work = partial(work_across_film, height=film[0], wet=flats[0], dry=flats[1])
    return Walls(heights.astype(float), space.spacing, space.modulus, film, work)


@pytest.mark.slow
@pytest.mark.parametrize("humidity", [0.44, 0.67, 0.9, 0.0])
def test_another_solver_with_another_wall_has_the_energy_of_full_contact_and_not_that_of_summits(humidity):
    strips, heights = strips_at(humidity)
    level = strips.levels[FINE]
    state = level.at_rest(heights, strips.curves[0])
    without_attraction = elements.equilibrium(level.space, heights, state.distance).gap
    _, energy = walls_like(strips, heights).minimum(np.maximum(without_attraction, 0).astype(float))
    assert -energy == pytest.approx(level.energy(state, heights), rel=0.02)
    assert -energy != pytest.approx(strips.energy(SUMMITS, 0), rel=0.04)


@pytest.mark.slow
def test_another_solver_has_the_largest_attraction_of_full_contact():
    strips, heights = strips_at(0.67)
    level = strips.levels[FINE]
    separation = elements.separation(level.space, heights, level.adhesion, strips.curves[0])
    walls = walls_like(strips, heights)
    gap, _ = walls.minimum(np.maximum(separation.closed.gap, 0).astype(float))
    attraction = walls.largest_attraction(gap, 0.25e-9)
    assert attraction == pytest.approx(separation.pull_off, rel=0.04)
    assert attraction != pytest.approx(strips.pull_off(SUMMITS, 0), rel=0.04)


def tips_at(humidity, slope):
    """Tips of narrow beams on pair b at a slope, and the heights of one of them."""
    lever = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 4}
    plan = Plan(load(PLAN.config, {"devices": {"C1": lever | {"humidities": [humidity]}}}))
    name = f"studies/full_contact/tips/devices/{case_id('b', humidity)}"
    settings = in_si(full_contact.Settings, job_settings(plan, name))
    surfaces = [(heights_of(name), spectrum_of(name)) for name in PLAN.sides("b")]
    (tips,) = tips_in_full_contact._at_slope(surfaces, settings, slope)
    return tips, tips.draw(*streams_of_sides(settings.seed, "b")(0))


@pytest.mark.slow
@pytest.mark.parametrize("humidity", [0.44, 0.67])
def test_another_solver_has_the_largest_attraction_of_a_tip_and_not_that_of_its_summits(humidity):
    tips, heights = tips_at(humidity, 0.08)
    tilted, curve = tips.tilted(heights), curve_of_tip(tips._contact(heights), humidity, tips.water)
    separation = tips.separated(tilted, curve)
    film, gaps = tips.water.film(humidity), tips.water.gaps
    work = partial(work_across_film, height=film[0], wet=gaps.through(gaps.summits), dry=gaps.through("dry"))
    walls = Walls(tilted.astype(float), tips.space.spacing, tips.space.modulus, film, work)
    gap, _ = walls.minimum(np.maximum(separation.closed.gap, 0).astype(float))
    attraction = walls.largest_attraction(gap, 0.1e-9)
    assert attraction == pytest.approx(separation.pull_off, rel=0.07)
    on_summits = tips.on_summits(heights) / (tips.space.spacing * len(heights))
    assert attraction != pytest.approx(on_summits, rel=0.3)
