"""Study pressing: how much more the surfaces of a pair stick after they were pressed together until summits yield."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.contact import solids
from stiction.contact.full.elements import Adhesion, State, at_rest, equilibrium
from stiction.contact.full.halfspace import HalfSpace
from stiction.plan.stage import Running, Stage
from stiction.stages.contact import full_contact
from stiction.stages.contact.pairs import bodies
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs

#: Variables of a strip that is pressed.
_PRESSED = ("pressure", "separation", "contact_share", "hardness_share", "flattening")


@dataclass(frozen=True, kw_only=True)
class Settings(full_contact.Settings):
    """Settings of full elastic contact, and how close the surfaces are pressed."""

    distance: float  #: smallest distance between the mean planes [m]
    steps: int  #: number of distances to which strips are pressed


def compute(surfaces: Sequence[tuple[xr.Dataset, xr.Dataset]], pair: str, settings: Settings) -> xr.Dataset:
    """Energies of strips when they are fresh, after their own adhesion flattened them, and after pressing.

    Strips separate elastically after they were flattened.

    Raises
    ------
    ValueError
        As in study full_contact, and if a strip rests at the smallest distance without being pressed.
    """
    hardness = solids.softer_hardness(*bodies(settings))
    strips = [
        _strip_pressed(
            *strip, [case[:2] for case in cases], np.linspace(0, 1, settings.steps + 1), settings.distance, hardness
        )
        for *strip, cases in full_contact.strips(surfaces, pair, settings)
    ]
    return layout(*map(np.array, zip(*strips, strict=True)), settings.humidities)


def _strip_pressed(space, heights, cases, shares, closest, hardness):
    """Energies (2 + n_steps, n_humidity) and variables of the presses (n_steps, n_variables) of one strip."""
    fresh = [at_rest(space, heights, *each)[0] for each in cases]
    before = [state.energy(heights, adhesion) for state, (adhesion, _) in zip(fresh, cases, strict=True)]
    flattenings = [
        equilibrium(space, heights, state.distance, adhesion, state, hardness).flattening
        for state, (adhesion, _) in zip(fresh, cases, strict=True)
    ]
    at_rest_distance = min(state.distance for state in fresh)
    pressed = list(_pressed(space, heights, at_rest_distance + (closest - at_rest_distance) * shares, hardness))
    after = [
        [
            _energy(space, heights - by, *each) if by.any() else e
            for by, each, e in zip(flat, cases, before, strict=True)
        ]
        for flat in (flattenings, *([state.flattening] * len(cases) for state in pressed))
    ]
    return -np.array([before, *after]), [_press_variables(state) for state in pressed]


def _energy(space, heights, adhesion, curve):
    """Energy U of a strip without force [J m⁻²]."""
    return at_rest(space, heights, adhesion, curve)[0].energy(heights, adhesion)


def _pressed(space: HalfSpace, heights: np.ndarray, distances: np.ndarray, hardness: float) -> Iterator[State]:
    """Yield states of a strip at decreasing distances, all but the first.

    ASSUME: while surfaces are pressed, their attraction is left out, which is small against the pressure.
    """
    if not np.all(np.diff(distances) < 0):
        unpressed, requested = (from_si(distance, "nm") for distance in distances[[0, -1]])
        raise ValueError(
            f"studies.pressing.distance_nm: the surfaces rest {unpressed:.3g} nm apart without being pressed, which is "
            f"less than {requested:.3g} nm"
        )
    state = None
    for distance in distances[1:]:
        state = equilibrium(space, heights, distance, Adhesion(0.0, 0.0), state, hardness)
        yield state


def _press_variables(state):
    """Variables of a pressed strip."""
    touching = state.pressure > 0
    at_hardness = (state.pressure >= np.float32(state.hardness)).sum() / touching.sum()
    return [state.force, state.distance, touching.mean(), at_hardness, state.flattening.max()]


def layout(energies: np.ndarray, presses: np.ndarray, humidities: Sequence[float]) -> xr.Dataset:
    """Energies of every strip, and the states of its presses.

    Energies (n, 2 + n_steps, n_humidity) are those of fresh strips, after adhesion alone, and after each press [J m⁻²];
    presses (n, n_steps, n_variables) are in the order of the variables of this module [SI].
    """
    columns = {
        "fresh_energy": (("strip", "humidity"), energies[:, 0]),
        "adhered_energy": (("strip", "humidity"), energies[:, 1]),
        "pressed_energy": (("strip", "step", "humidity"), energies[:, 2:]),
    }
    for i, name in enumerate(_PRESSED):
        columns[name] = (("strip", "step"), presses[..., i])
    return xr.Dataset(columns, coords={"humidity": ("humidity", list(humidities))})


def _settings(plan, at):
    """Settings of study full_contact, with the number of strips and the distances of this one."""
    study = plan.config["studies"]["pressing"]
    size = {"strips": study["samples"], "distance_nm": study["distance_nm"][at.pair], "steps": study["steps"]}
    return full_contact.settings_of(plan, at) | size


STAGES = (
    Stage.writing(
        "pressed",
        "studies/pressing/{pair}",
        inputs=lambda plan, at: surface_inputs(plan, at.pair),
        settings=_settings,
        kind=Settings,
        compute=lambda data, at, settings: compute(sides_of(data), at.pair, settings),
        message="Pair {pair} after its surfaces were pressed together.",
        running=Running(minutes=60),
    ),
)
