"""Beam on its rows of dimples: force, probability of sticking, and gap beside the rows."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.constants import VACUUM_PERMITTIVITY
from stiction.contact.air import Air
from stiction.devices.stoppers import stuck_patches
from stiction.estimates import mean_with_error
from stiction.life.dimples import holds, least_load, least_pull, states
from stiction.life.drying import pull_of_liquid
from stiction.life.fringes import edge_width
from stiction.stages.life.answers import FREE, HOLD, STICK, TOUCH, LifeRow, Name
from stiction.stages.life.inputs import BeamKeys

_SOURCE = "stiction.life.dimples"


def dimple_answers(keys: BeamKeys, dimples: Mapping[float, xr.Dataset]) -> list[LifeRow]:
    """Answers about a beam on its dimples, from the forces of rows of them by humidity; none without any."""
    if not dimples:
        return []
    rows, way = rows_of(keys), keys.device.gap - keys.dimples.height
    forces = {humidity: dataset.pull_off.values for humidity, dataset in dimples.items()}
    means = {humidity: tuple(map(float, mean_with_error(values.ravel()))) for humidity, values in forces.items()}
    worst = max(means, key=means.get)
    mean, error = means[worst]
    form = f"sum of {keys.dimples.number} largest attractions x area"
    subject = f"mean force on {'each of ' if len(keys.dimples.at) > 1 else ''}its {rows} {Air(worst).where}"
    on_rows, sticking = states(keys.beam(keys.length), keys.clamps, keys.dimples.at), []
    for humidity, values in forces.items():
        stuck = holds(on_rows, way, values).astype(float)
        sticking.append(
            LifeRow(
                f"{Name.ON_DIMPLES}_{humidity:g}",
                STICK,
                f"probability of sticking on its {rows} {Air(humidity).where}",
                *(float(end[0]) for end in stuck_patches(stuck, np.array([0.5]))[1:]),
                *(np.nan, "1", "fraction of random rows, 95 %", "stage dimples"),
            )
        )
    return [
        *_bent(keys),
        *_brought_down(keys),
        LifeRow(Name.DIMPLES, HOLD, subject, mean, mean, error, "N", form, "stage dimples"),
        *sticking,
    ]


def rows_of(keys: BeamKeys) -> str:
    """Rows of dimples of a beam in words."""
    return "row of dimples" if len(keys.dimples.at) == 1 else f"{len(keys.dimples.at)} rows of dimples"


def _brought_down(keys):
    """Voltage and liquid below which a beam on its dimples does not touch beside them."""

    def limit(beam, power):
        """Largest load per length, times a power of the gap, that a beam on its dimples bears."""
        return least_load(states(beam, keys.clamps, keys.dimples.at), beam.gap - keys.dimples.height, beam.gap, power)

    def voltage(beam):
        """Voltage that a beam bears [V]."""
        edge = edge_width(beam.gap, beam.thickness)
        width = _with_end(keys, beam, beam.width + 2 * edge, edge)
        return float(np.sqrt(2 * limit(beam, 2) / (VACUUM_PERMITTIVITY * width)))

    def tension(beam):
        """Surface tension γ of a liquid that a beam bears [N m⁻¹]."""
        pull = float(pull_of_liquid(beam.width / beam.gap)) * beam.gap
        return limit(beam, 1) / _with_end(keys, beam, pull, beam.gap * beam.width / pull)

    form = "loads as at the smallest gap, on the parts that bring it down; on all its rows or some of them"
    volts, error = keys.number(voltage, keys.length)
    subject = "slowly raised voltage below which it does not touch beside its dimples"
    with_edges = f"{form}; with fringes"
    answers = [LifeRow(Name.VOLTAGE_BESIDE, TOUCH, subject, volts, np.nan, error, "V", with_edges, _SOURCE)]
    most, error = keys.number(tension, keys.length)
    subject = "surface tension up to which no liquid brings it down beside its dimples"
    with_edges = f"{form}; pinned at the edges"
    return [*answers, LifeRow(Name.TENSION_BESIDE, TOUCH, subject, most, np.nan, error, "N m-1", with_edges, _SOURCE)]


def _with_end(keys, beam, per_length, end):
    """Load per length on a beam that also bears one at its free end, as large as that on a length ``end`` [m].

    A force at the end of an arm bends it nowhere more than 8/3 of it spread along the arm.
    """
    return per_length * (1 + 8 / 3 * end / (beam.length - keys.dimples.at[-1]) * (keys.clamps == 1))


def _bent(keys):
    """Gap that is left beside the dimples of a beam while they touch, and the force with which it pulls at them."""
    at, height = keys.dimples.at, keys.dimples.height

    def remaining_gap(beam, most):
        """Part of the gap left at the deepest point beside the rows, for the state in which it is ``most`` [-]."""
        deepest = most(state.deepest for state in states(beam, keys.clamps, at))
        return max(1 - deepest * (beam.gap - height) / beam.gap, 0.0)

    def pull(beam):
        """Force of the beam at a row, bent to the dimples' height [N]."""
        return least_pull(states(beam, keys.clamps, at)) * (beam.gap - height)

    remaining, remaining_error = keys.number(lambda beam: remaining_gap(beam, max), keys.length)
    force, error = keys.number(pull, keys.length)
    subject, form = "part of the gap that is left beside its dimples", "bent by the forces on its rows alone"
    if len(at) > 1:
        form += "; on the rows that leave least (at least) and most (at most)"
    beside = LifeRow(
        Name.BESIDE,
        TOUCH,
        subject,
        remaining,
        remaining_gap(keys.beam(keys.length), min),
        remaining_error,
        "1",
        form,
        _SOURCE,
    )
    subject, form = f"force with which it pulls at its {rows_of(keys)}", "k (h - h_d)"
    if len(at) > 1:
        form += "; largest on a row, at rest on those rows where this is least"
    most = force if keys.clamps == 1 else np.nan  # rigid clamps stretch a bridge
    return [beside, LifeRow(Name.PULLED, FREE, subject, force, most, error, "N", form, _SOURCE)]
