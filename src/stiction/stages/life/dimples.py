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
from stiction.stages.life.inputs import BeamInUse

_SOURCE = "stiction.life.dimples"


def dimple_answers(of: BeamInUse, dimples: Mapping[float, xr.Dataset]) -> list[LifeRow]:
    """Answers about a beam on its dimples, from the forces of rows of them by humidity; none without any."""
    if not dimples:
        return []
    rows, way = rows_of(of), of.device.gap - of.dimples.height
    forces = {humidity: one.pull_off.values for humidity, one in dimples.items()}
    means = {humidity: tuple(map(float, mean_with_error(held.ravel()))) for humidity, held in forces.items()}
    worst = max(means, key=means.get)
    mean, error = means[worst]
    form = f"sum of {of.dimples.number} largest attractions x area"
    what = f"mean force on {'each of ' if len(of.dimples.at) > 1 else ''}its {rows} {Air(worst).where}"
    on_rows, sticking = states(of.beam(of.length), of.clamps, of.dimples.at), []
    for humidity, held in forces.items():
        stuck = holds(on_rows, way, held).astype(float)
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
        *_bent(of),
        *_brought_down(of),
        LifeRow(Name.DIMPLES, HOLD, what, mean, mean, error, "N", form, "stage dimples"),
        *sticking,
    ]


def rows_of(of: BeamInUse) -> str:
    """Rows of dimples of a beam in words."""
    return "row of dimples" if len(of.dimples.at) == 1 else f"{len(of.dimples.at)} rows of dimples"


def _brought_down(of):
    """Voltage and liquid below which a beam on its dimples does not touch beside them."""

    def limit(beam, power):
        """Largest load per length, times a power of the gap, that a beam on its dimples bears."""
        return least_load(states(beam, of.clamps, of.dimples.at), beam.gap - of.dimples.height, beam.gap, power)

    def voltage(beam):
        """Voltage that a beam bears [V]."""
        edge = edge_width(beam.gap, beam.thickness)
        width = _with_end(of, beam, beam.width + 2 * edge, edge)
        return float(np.sqrt(2 * limit(beam, 2) / (VACUUM_PERMITTIVITY * width)))

    def tension(beam):
        """Surface tension γ of a liquid that a beam bears [N m⁻¹]."""
        pull = float(pull_of_liquid(beam.width / beam.gap)) * beam.gap
        return limit(beam, 1) / _with_end(of, beam, pull, beam.gap * beam.width / pull)

    form = "loads as at the smallest gap, on the parts that bring it down; on all its rows or some of them"
    volts, error = of.number(voltage, of.length)
    what = "slowly raised voltage below which it does not touch beside its dimples"
    with_edges = f"{form}; with fringes"
    answers = [LifeRow(Name.VOLTAGE_BESIDE, TOUCH, what, volts, np.nan, error, "V", with_edges, _SOURCE)]
    most, error = of.number(tension, of.length)
    what = "surface tension up to which no liquid brings it down beside its dimples"
    with_edges = f"{form}; pinned at the edges"
    return [*answers, LifeRow(Name.TENSION_BESIDE, TOUCH, what, most, np.nan, error, "N m-1", with_edges, _SOURCE)]


def _with_end(of, beam, per_length, end):
    """Load per length on a beam that also bears one at its free end, as large as that on a length ``end`` [m].

    A force at the end of an arm bends it nowhere more than 8/3 of it spread along the arm.
    """
    return per_length * (1 + 8 / 3 * end / (beam.length - of.dimples.at[-1]) * (of.clamps == 1))


def _bent(of):
    """Gap that is left beside the dimples of a beam while they touch, and the force with which it pulls at them."""
    at, height = of.dimples.at, of.dimples.height

    def left(beam, most):
        """Part of the gap left at the deepest point beside the rows, for the state in which it is ``most`` [-]."""
        deepest = most(state.deepest for state in states(beam, of.clamps, at))
        return max(1 - deepest * (beam.gap - height) / beam.gap, 0.0)

    def pull(beam):
        """Force of the beam at a row, bent to the dimples' height [N]."""
        return least_pull(states(beam, of.clamps, at)) * (beam.gap - height)

    rest, rest_error = of.number(lambda beam: left(beam, max), of.length)
    force, error = of.number(pull, of.length)
    what, form = "part of the gap that is left beside its dimples", "bent by the forces on its rows alone"
    if len(at) > 1:
        form += "; on the rows that leave least (at least) and most (at most)"
    beside = LifeRow(Name.BESIDE, TOUCH, what, rest, left(of.beam(of.length), min), rest_error, "1", form, _SOURCE)
    what, form = f"force with which it pulls at its {rows_of(of)}", "k (h - h_d)"
    if len(at) > 1:
        form += "; largest on a row, at rest on those rows where this is least"
    most = force if of.clamps == 1 else np.nan  # rigid clamps stretch a bridge
    return [beside, LifeRow(Name.PULLED, FREE, what, force, most, error, "N", form, _SOURCE)]
