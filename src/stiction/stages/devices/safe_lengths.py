"""Stage safe_lengths: P(stuck) over the length of a device at a humidity, and its safe lengths."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.config.cases import case_id
from stiction.contact.air import humid
from stiction.contact.environment import Water
from stiction.devices import arcs, risk
from stiction.devices.risk import LengthBounds, SafeLength, in_order
from stiction.estimates import mean_with_error
from stiction.life.freeing import probability_for
from stiction.plan.stage import Running, Stage, select, subsection
from stiction.stages.contact import curves
from stiction.stages.contact.corrections import with_correction
from stiction.stages.contact.error_notes import on_patch
from stiction.stages.devices import cracks as stage_cracks
from stiction.stages.devices import prediction
from stiction.stages.devices.contact_names import contact_of, corrected_tips_of, corrections_of
from stiction.stages.devices.opening import S_SHAPE, DesignedBeam, at_voltage, settings_of_beam
from stiction.stages.devices.sticking import Released, by_shape, lengths_without_samples

#: Points along the axis of the lengths.
_POINTS = 300


@dataclass(frozen=True)
class Settings:
    """Settings of the safe lengths, without the cracks and the contact of the tips."""

    seed: int
    water: Water
    humidity: float  #: [-]
    device: DesignedBeam
    shares: tuple[float, ...]  #: p [-]
    edge_radius: float  #: of its tip, for the bound of flats [m]
    length: float | None = None  #: of the device, at which P(stuck) is stated [m]


def compute(cracks: xr.Dataset, settings: Settings, tips: xr.Dataset | None = None) -> xr.Dataset:
    """P(stuck) and safe lengths. Each beam has one of the tips, and a bridge has none."""
    device, arc_lengths = settings.device, None
    if tips is not None:
        arc_lengths = arcs.longest_free(*curves.tip_forces(tips, settings.humidity, settings.water), device.beam)
    beams = stage_cracks.beams_of(cracks, device, arc_lengths)
    air = settings.water, settings.humidity
    without_samples = lengths_without_samples(device, *air, settings.edge_radius, beams.reach)
    dataset = layout(beams.lengths, by_shape(beams, settings, without_samples), without_samples, settings).assign(
        cracks[["rms", "share_flat", "longest_strip", "resampled", "repetition", "size_error", "mean_energy"]]
    )
    dataset = dataset.assign(_thresholds(beams.lengths, without_samples) | _in_register(beams, cracks))
    return dataset if settings.length is None else dataset.assign(at_length(beams, settings.length))


def _in_register(beams, cracks):
    """Variable of the sticking lengths of all devices along the beam in register, none without play."""
    if "register_length" not in cracks:
        return {}
    along = next(iter(replace(beams, arrested=cracks.register_length.values).lengths.values()))
    return {"register_sticking_length": ("device", np.sort(along))}


def _thresholds(sticking, without_samples):
    """Variables of the sticking lengths of all devices, and of lengths that no surfaces hold, by shape."""
    ordered, floors = np.sort(list(sticking.values())), [bounds.safe for bounds in without_samples.values()]
    return {"sticking_length": (("shape", "device"), ordered), "floor": ("shape", floors)}


def no_longer_than_in_drier_air(dataset: xr.Dataset, drier: xr.Dataset | None) -> xr.Dataset:
    """Dataset whose safe lengths are no longer than those of the same device in drier humid air, if there is some.

    Cracks are as long as the energy of their strips allows, so that they are shorter where the mean energy is larger;
    longer bounds are errors of the simulation. ASSUME: nothing of the kind for tips and bridges, which the largest
    attraction holds as well: it falls in wet air. What holds a crack holds a beam whose tip may touch, too.
    """
    if drier is None or not float(drier.mean_energy) <= float(dataset.mean_energy):
        return dataset
    limit = drier.safe_length.where(drier["shape"] == S_SHAPE)
    shortened = np.fmin(dataset.safe_length, limit).transpose("shape", "share")
    return dataset.assign(safe_length=dataset.safe_length.copy(data=in_order(shortened.values, dataset.share.values)))


def compute_at_voltage(
    contact: xr.Dataset, cracks: xr.Dataset, settings: Settings, tips: xr.Dataset | None = None
) -> xr.Dataset:
    """Safe lengths at a voltage, from the contact of the strips and the cracks without voltage, see `compute`.

    Tips are held by the attraction across their gaps, and cracks by the mean energy that it adds to the strips
    (`stiction.life.holding`). ASSUME: strips gain the same, as far as cracks are concerned.
    """
    device, waters = settings.device, (replace(settings.water, capacitor=None), settings.water)
    with on_patch(device.strip, device.width):
        without, at = (curves.vectors(contact, settings.humidity, water)[0][:, :2] for water in waters)
    means = without.mean(axis=0), at.mean(axis=0)
    moved = stage_cracks.with_lengths(cracks, lambda lengths: device.opening.at_voltage(lengths, *means, device.beam))
    added, error = mean_with_error(at[:, 0] - without[:, 0])
    energies = {"voltage_energy": ((), added), "voltage_error": ((), error)}
    return compute(moved, settings, tips).assign(energies)


def at_length(beams: Released, length: float) -> dict[str, tuple]:
    """Variables of P(stuck) at one length [m], by shape, with its band and the error by the number of sampled surfaces.

    Beyond the reach, the upper end of the band counts devices that did not stick there as stuck.
    """
    shares = [risk.stuck_share(np.array([length]), values, beams.reach) for values in beams.lengths.values()]

    def stuck(move):
        """Fractions of devices stuck by shape (shapes,) [-]."""
        return np.array([np.mean(values < length) for values in beams.moved(move).lengths.values()])

    error = beams.surfaces.error(stuck)
    return {
        "length_of_device": ((), length),
        "stuck_at_length": (("shape", "end"), np.array(shares)[..., 0]),
        "stuck_surfaces_error": ("shape", np.where(error > 0, error, np.nan)),
        "end": ["estimate", "low", "high"],
    }


def layout(
    sticking: Mapping[str, np.ndarray],
    safe: Mapping[str, Sequence[SafeLength]],
    without_samples: Mapping[str, LengthBounds],
    settings: Settings,
) -> xr.Dataset:
    """Dataset of P(stuck) and of the safe lengths, by shape.

    Sticking lengths (n,) [m], safe lengths for every share, and what is known without samples.
    """
    reach = min(bounds.reach for bounds in without_samples.values())
    axis = _axis(sticking, reach)
    stuck = np.array([risk.stuck_share(axis, values) for values in sticking.values()])
    shortest = [np.min(values, where=values <= reach, initial=np.inf) for values in sticking.values()]
    film, flat = settings.water.film(settings.humidity)[0], [bounds.flat for bounds in without_samples.values()]
    most, number = [risk.most_stuck(values, reach) for values in sticking.values()], len(next(iter(sticking.values())))
    return xr.Dataset(
        {
            "stuck": (("shape", "length"), stuck[:, 0]),
            "stuck_band": (("shape", "bound", "length"), stuck[:, 1:]),
            "flooded_length": ("shape", flat),
            "shortest": ("shape", shortest),
            "most_stuck": ("shape", most),
            "reach": ((), reach),
            "beams": ((), number),
            "film": ((), film),
        }
        | _of_shares(safe.values()),
        coords={
            "shape": list(sticking),
            "share": list(settings.shares),
            "bound": ["lower", "upper"],
            "length": ("length", axis),
        },
    )


#: Fields of the variables of safe lengths.
_LENGTHS = {
    "safe_length": "length",
    "estimate": "estimate",
    "beams_error": "error",
    "surfaces_error": "surfaces_error",
}


def _of_shares(safe):
    """Variables of safe lengths in rows of shapes (shapes, shares)."""

    def column(field):
        """Values of a field."""
        return ("shape", "share"), [[getattr(length, field) for length in row] for row in safe]

    over, bases = column("basis")
    lengths = {name: column(field) for name, field in _LENGTHS.items()}
    return {"basis": (over, [list(map(str, row)) for row in bases])} | lengths


def _axis(sticking, reach):
    """Lengths of the curves of P(stuck), from below the shortest stuck one to all stuck or the last simulated."""
    lengths = np.concatenate(list(sticking.values()))
    ends = lengths[np.isfinite(lengths) & (lengths <= reach)]
    low, high = ends.min(initial=reach), 1.02 * ends.max(initial=0.0)
    return np.linspace(0.9 * low, min(high or reach, reach), _POINTS)


def chosen_share(dataset: xr.Dataset) -> float:
    """Fraction of stuck devices for lengths in sentences: the middle one [-]."""
    return float(dataset.share[dataset.sizes["share"] // 2])


def _for_touchdowns(plan, at):
    """Settings of the safe length of one touchdown for the middle fraction stuck after all of them."""
    settings, shares = settings_of_beam(plan, at.case), plan.config["design"]["shares"]
    touchdowns = plan.config["devices"][at.case.device]["touchdowns"]
    return select(Settings, settings, shares=[probability_for(shares[len(shares) // 2], touchdowns)])


def _in_drier_air(plan, case):
    """Safe lengths of a cantilever in the next drier of its humid airs, if there is one. Other airs are in no table."""
    airs = plan.config["devices"][case.device]["humidities"]
    drier = [rh for rh in humid(airs) if case.humidity in airs and rh < case.humidity]
    if not (drier and plan.devices.kind(case.device).has_tip):
        return {}
    return {"drier": f"devices/safe_lengths/{case_id(case.device, max(drier))}"}


_SAFE_LENGTHS = Stage.writing(
    "safe_lengths",
    "devices/safe_lengths/{case}",
    inputs=lambda plan, at: {"cracks": f"devices/cracks/{at.case}"} | corrected_tips_of(plan, at.case),
    settings=lambda plan, at: select(
        Settings, settings_of_beam(plan, at.case) | subsection(plan.config["devices"][at.case.device], ["length_um"])
    ),
    kind=Settings,
    complete=with_correction,
    compute=compute,
    message="Simulated limits of {case}.",
    running=Running(priority=1),
)
STAGES = (
    replace(
        _SAFE_LENGTHS,
        inputs=lambda plan, at: (
            _SAFE_LENGTHS.inputs(plan, at) | _in_drier_air(plan, at.case) | prediction.inputs(plan, at.case)
        ),
        compute=lambda data, settings: prediction.with_intervals(
            no_longer_than_in_drier_air(compute(data["cracks"], settings, data.get("tips")), data.get("drier")),
            data,
            settings,
        ),
    ),
    replace(
        _SAFE_LENGTHS,
        name="touchdowns",
        files={"dataset": "devices/touchdowns/{case}"},
        settings=_for_touchdowns,
        message="Simulated limits of {case} for many touchdowns.",
    ),
    Stage.writing(
        "at_voltage",
        "devices/at_voltage/{case}",
        inputs=lambda plan, at: (
            _SAFE_LENGTHS.inputs(plan, at)
            | {"contact": contact_of(plan, at.case)}
            | corrections_of(plan, at.case.device, at.case.humidity)
        ),
        settings=lambda plan, at: select(Settings, at_voltage(plan, at.case.device, settings_of_beam(plan, at.case))),
        kind=Settings,
        complete=with_correction,
        compute=compute_at_voltage,
        message="Simulated limits of {case} at its voltage.",
    ),
)
