"""Views of the page of a device over the voltage that is on while it touches, from the runs of its page alone."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config.units import to_si
from stiction.contact.voltage import BREAKDOWN, Capacitor, Dielectric
from stiction.devices.risk import quantiles, sampled_bound, samples_for
from stiction.life import holding
from stiction.report.devices import levels
from stiction.report.devices.explorer import View, alone, humidity_axis, share_axis, size_axis
from stiction.report.devices.grid import Grid, GridAxis
from stiction.report.format import UM
from stiction.stages.devices.safe_lengths import chosen_share

#: Voltage that frees a stopper which sticks without one, in a scale of logarithms [V].
_NEVER = float(np.finfo(float).tiny)
#: Number of voltages at which lengths are computed.
_POINTS = 41


def _offset(section):
    """Offset of a voltage [V], and the voltage at which the dielectric breaks down with it [V]."""
    offset = abs(section.get("offset_V", 0.0))
    return offset, BREAKDOWN * to_si(section["dielectric"]["thickness_nm"], "nm") - offset


def stopper_view(name: str, section: Mapping[str, Any], biased: xr.Dataset) -> View:
    """View of a stopper over the voltage that is on: its section, dataset of stage stoppers_at_voltage.

    The voltage is that without the offset, which counts against the stopper, and below the breakdown of the dielectric.
    """
    biased, (offset, limit) = biased.sortby("humidity"), _offset(section)
    volts = np.maximum(biased.freeing_potential.values - offset, 0.0)
    scored = np.array([quantiles(row) for row in np.maximum(volts, _NEVER)])
    scored[scored > limit] = np.nan
    enough = np.array([share for share in biased.share.values if volts.shape[1] >= samples_for(share)])
    safe = np.array([[sampled_bound(row, share)[0] for share in enough] for row in volts])
    freed = safe.all(axis=0)
    if not freed.any():
        enough, safe, freed = biased.share.values[:1], np.full((len(volts), 1), np.nan), np.array([True])
    order = np.argsort(enough[freed])
    safe, shares = np.minimum(safe[:, freed], limit)[:, order], enough[freed][order]
    worst = float(biased.humidity[int(np.argmin(np.median(volts, axis=1)))])
    start = abs(section.get("voltage_V", 0.0)) or float(np.nanmin(volts[volts > 0], initial=limit))
    grid = Grid(
        (humidity_axis(biased.humidity.values, worst, f"devices.{name}.humidities", False),),
        share_axis(shares, shares[0], ""),
        size_axis("voltage_V", "voltage", "V", (safe, scored[scored > _NEVER]), start),
        safe,
        levels.counted(scored, volts.shape[1]),
        volts.shape[1],
        falls=False,
    )
    words = {
        "what": "voltage",
        "safe": "Voltage that simulation alone allows",
        "stick": "Stoppers that stick while this voltage is on",
        "bound": "limit",
        "none": "none: too few patches, or its spring does not free them without voltage",
    }
    return View("voltage", grid, words)


def beam_view(name: str, section: Mapping[str, Any], safe_lengths: Mapping[float, xr.Dataset]) -> View:
    """View of a cantilever over the voltage that is on, whose surfaces count as flat and in contact.

    Its lengths are the bound *at least* of stage life: that of a tip in `stiction.life.holding`. The
    section has the modulus of the beam as well.
    """
    joined, (offset, limit) = alone(section, safe_lengths).isel(thickness=0, gap=0), _offset(section)
    oxide = Dielectric(to_si(section["dielectric"]["thickness_nm"], "nm"), section["dielectric"]["permittivity"])
    volts = [float(f"{value:.9g}") for value in np.linspace(0, limit, _POINTS)]
    sizes = (section[key] * UM for key in ("width_um", "thickness_um"))
    beam = Beam(1.0, *sizes, to_si(section["young_modulus_GPa"], "GPa"), section["gap_um"] * UM, 1)
    added = [holding.energy_of_voltage(Capacitor(oxide, voltage, offset), beam.gap) for voltage in volts]
    safe, scored = (
        np.array([holding.tip_length_at_voltage(lengths.values, beam, energy) for energy in added]) / UM
        for lengths in (joined.safe_length, joined["quantile"])
    )
    key, share = f"devices.{name}", chosen_share(next(iter(safe_lengths.values())))
    worst = int(np.argmin(safe[0].min(axis=-1)))
    reason = f"beyond {limit:g} V the dielectric breaks down; {key}.dielectric changes this"
    start = min(abs(section.get("voltage_V", 0.0)), volts[-1])
    axes = (
        GridAxis("voltage_V", "voltage", "V", "linear", tuple(volts), start, True, reason, "voltage_V"),
        humidity_axis(joined.humidity.values, float(joined.humidity[worst]), f"{key}.humidities", False),
    )
    length = section.get("length_um", float(safe[0, worst].min()))
    grid = Grid(
        axes,
        share_axis(joined.share.values, share, "shares"),
        size_axis("length_um", "length", "µm", (safe, scored), length),
        safe,
        levels.counted(scored, int(joined.beams)),
        int(joined.beams),
        falls=False,
    )
    words = {
        "what": "length",
        "safe": "Length that simulation alone allows with this voltage on, surfaces flat",
        "stick": "Devices of this length that stick with this voltage on, surfaces flat",
        "bound": "limit",
    }
    return View("voltage", grid, words)
