"""Force curves at a humidity from the dataset of stage contact. Shared by several stages, not a stage itself."""

from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.contact import environment, forcelaw, gaps
from stiction.contact.correction import NONE
from stiction.contact.environment import ForceCurves, Water
from stiction.contact.forcelaw import extremum, resists
from stiction.contact.separation import keep_volume
from stiction.contact.voltage import freeing_potential
from stiction.devices.risk import CONFIDENCE
from stiction.stages.contact.contact import tables


def force_curves(contact: xr.Dataset, humidity: float, water: Water) -> ForceCurves:
    """Force curves at a relative humidity."""
    return environment.force_curves(*tables(contact), humidity, water)


def parametrised(sampled: ForceCurves, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of force curves (m, 4) [SI] and f_limit [Pa], corrected to full elastic contact if wanted.

    ASSUME: one change of e and one of f_max at a humidity hold for all samples, on strips and patches of any size.
    """
    vectors, limit = forcelaw.parametrise(*sampled)
    changes = [change.of(vectors[:, k]) for k, change in enumerate(water.changes(humidity))]
    changed = [change(vectors[:, k]) for k, change in enumerate(changes)]
    return np.column_stack([*changed, vectors[:, 2:]]), float(changes[1](limit))


def displacements(contact: xr.Dataset, samples: np.ndarray) -> np.ndarray | None:
    """Displacements from their register of those samples that are kept [m], none without play."""
    return contact.displacement.values[samples] if "displacement" in contact else None


def energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
    on_summits = forcelaw.adhesion_energies(*force_curves(contact, humidity, water))
    return water.changes(humidity)[0].of(on_summits)(on_summits)


def tip_forces(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, np.ndarray]:
    """Slopes of tips (s,) [-] and the largest attraction of each tip at each slope, per width of the beam (m, s) [N/m].

    Across gaps, wedge and edge below the stored heights attract like planes of their slopes. Full elastic contact
    changes mean and scatter as it does for `stiction.stages.contact.tips_in_full_contact`. ASSUME: of the errors of
    these changes, tips have the 95 % upper end.

    Raises
    ------
    ValueError
        If the film is higher than the contact of the tips reaches.
    """
    tips = _wedges(contact, humidity, water, endless=True)
    forces = forcelaw.largest_attractions(*tips) * float(contact.length)
    return contact.slope.values, _changed_tips(forces, forces, contact, humidity, water)


def fast_tip_forces(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """As the forces of `tip_forces`, of tips that separate faster than water evaporates, at least these (m, s) [N/m].

    They are infinite where no summits stop a tip.
    """
    slow = _wedges(contact, humidity, water, endless=True)
    solid, bearing, starts, step, layer = slow
    largest = forcelaw.largest_attractions(*slow).astype(float)
    on_summits, distance = largest.copy(), _distances(starts, step, solid)
    for each in np.ndindex(largest.shape):
        force = _apparent(solid[each], bearing[each], starts, step, layer)
        fast = keep_volume(force, distance, bearing[each], starts[1], layer)
        largest[each] = np.inf if fast is None else max(largest[each], -fast[0].min())
    return _changed_tips(largest, on_summits, contact, humidity, water) * float(contact.length)


def _distances(starts, step, solid):
    """Distances of the forces of tips (n_d,) [m]."""
    return starts[0] + step * np.arange(solid.shape[-1])


def _apparent(solid, bearing, starts, step, layer):
    """Force of one tip at one slope (n_d,) [Pa]."""
    force = np.empty(solid.size)
    forcelaw.apparent_force(solid, bearing, (*starts, starts[0]), step, *layer, force)
    return force


def _changed_tips(forces, slow, contact, humidity, water):
    """Forces of tips under full elastic contact beside those of slow tips on summits, (m, s) each [N/m]."""
    changes = water.changes_of_tips(humidity, contact.slope.values)
    at_slopes = [change.at_most(CONFIDENCE).of(slow[:, k])(forces[:, k]) for k, change in enumerate(changes)]
    return np.stack(at_slopes, axis=1)


def tilted_forces(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction of each tilted patch at each slope, per its width (m, s) [N/m]; errors as of `tip_forces`.

    ASSUME: full elastic contact changes them as it changes the pull-off forces of parallel patches.
    """
    forces = forcelaw.largest_attractions(*_wedges(contact, humidity, water, endless=False)) * float(contact.length)
    return water.changes(humidity)[1].of(forces)(forces)


def _wedges(contact, humidity, water, endless):
    """Arguments of `forcelaw.largest_attractions` of strips that go on below their stored heights or end there."""
    layer, reach = water.film(humidity), -float(contact.height[0])
    if layer[0] > reach:
        raise ValueError(
            f"the contact of the tips is for films of up to {from_si(reach, 'nm'):.3g} nm, and that at a relative "
            f"humidity of {humidity:g} is {from_si(layer[0], 'nm'):.3g} nm high: state this humidity with the device"
        )
    solid, bearing, starts, step = tables(contact)
    if water.reaches_across:
        work = partial(water.work_across, height=layer[0])
        pressure, _ = gaps.gap_pressures(bearing, starts[1], contact.distance.values, step, work)
        beyond = work(contact.distance.values + reach) * contact.ends.values[:, None] / float(contact.length)
        solid = solid + pressure - endless * beyond.astype(np.float32)
    return solid, bearing, starts, step, layer


def curve_of_tip(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, np.ndarray]:
    """Distances [m] and forces [Pa] of the first tip at its first slope, on a strip that ends (n_d,) each."""
    solid, bearing, starts, step, layer = _wedges(contact, humidity, water, endless=False)
    return _distances(starts, step, solid), _apparent(solid[0, 0], bearing[0, 0], starts, step, layer)


def pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Largest attraction f_max of all samples at a relative humidity (m,) [Pa]."""
    forces = _pull_offs_of(force_curves(contact, humidity, water))
    return water.changes(humidity)[1].of(forces)(forces)


def _pull_offs_of(sampled):
    """Largest attractions of all samples on summits (m,) [Pa]."""
    return forcelaw.pull_offs(*sampled[:3], sampled.flat)


def freeing_potentials(contact: xr.Dataset, humidity: float, water: Water, pull: float) -> np.ndarray:
    """Potentials below which a pull [Pa] frees each sample at a relative humidity, zero if it never does (m,) [V].

    The water has a capacitor. Its own voltage does not count.
    """
    unit, (_, bearing, starts, step) = water.capacitor.per_volt, tables(contact)
    without = replace(water, capacitor=replace(unit, voltage=0.0))
    sampled = force_curves(contact, humidity, without)
    distance, curve, samples, *_, flat = sampled
    pressure, _ = gaps.gap_pressures(bearing, starts[1], distance, step, unit.work)
    pulls, change = np.full(samples, pull), water.changes(humidity)[1]
    if change != NONE:
        on_summits = _pull_offs_of(sampled)
        pulls *= on_summits / change.of(on_summits)(on_summits)
    potentials = np.empty(samples)
    for k in range(samples):
        force, more = np.array(curve(k)), pressure[k].astype(float)

        def excess(squared, force=force, more=more, pull_off=pulls[k]):
            """Largest attraction at a squared potential less the needed pull [Pa]."""
            at = force + squared * more
            largest = extremum(distance, at)[1] if resists(at) else flat[1] + squared * unit.largest_pressure
            return largest - pull_off

        # Between points of the grid, the attraction is larger: a little less than this frees the sample.
        attracting = more < 0
        highest = ((pulls[k] + force[attracting]) / -more[attracting]).min()
        potentials[k] = freeing_potential(excess, (1 + 1e-9) * highest) if highest > 0 else 0.0
    return potentials


def fast_pull_offs(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Values of `pull_offs` in a separation faster than water evaporates, infinite without resistance of summits."""
    sampled, fast = _separations(contact, humidity, water)
    forces = np.array([np.inf if separation is None else -separation[0].min() for separation in fast])
    return _fast(forces, water.changes(humidity)[1], lambda: _pull_offs_of(sampled))


def fast_energies(contact: xr.Dataset, humidity: float, water: Water) -> np.ndarray:
    """Values of `energies` in a separation faster than water evaporates, infinite without resistance of summits."""
    sampled, fast = _separations(contact, humidity, water)
    beyond = np.zeros(sampled.samples) if sampled.beyond is None else sampled.beyond
    energies = [
        np.inf
        if separation is None
        else forcelaw.adhesion_energy(sampled.distance, separation[0], beyond[k] + separation[1])
        for k, separation in enumerate(fast)
    ]
    return _fast(np.array(energies), water.changes(humidity)[0], lambda: forcelaw.adhesion_energies(*sampled))


def _fast(values, change, slow):
    """Values of a fast separation (m,), changed as those of a slow one, which ``slow`` computes."""
    return values if change == NONE else change.of(slow())(values)


def _separations(contact, humidity, water):
    """Force curves at a relative humidity, and those of fast separations one by one."""
    sampled, (_, bearing, starts, _) = force_curves(contact, humidity, water), tables(contact)
    layer = water.film(humidity)
    return sampled, (
        keep_volume(sampled.curve(k), sampled.distance, bearing[k], starts[1], layer) for k in range(sampled.samples)
    )


def share_flat(contact: xr.Dataset, humidity: float, water: Water) -> float:
    """Fraction of the samples at a relative humidity to count as flat surfaces, not stopped by summits [-]."""
    sampled = force_curves(contact, humidity, water)
    return forcelaw.share_flat(sampled.curve, sampled.samples) if sampled.flat else 0.0


def vectors(contact: xr.Dataset, humidity: float, water: Water) -> tuple[np.ndarray, float]:
    """Vectors v of Eq. (11) of all samples at a relative humidity (m, 4) [SI], and f_limit [Pa]."""
    return parametrised(force_curves(contact, humidity, water), humidity, water)
