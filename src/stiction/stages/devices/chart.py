"""Stage chart: safe lengths of beams of other thicknesses and gaps than those of a device, at one humidity of an axis.

Beams are computed by finite elements. Between the smallest and the largest thickness and gap, a power law is used if it
predicts beams in the middle, to which it was not fitted, within 1 %. Beams of all sizes are released at the driest, the
middle and the wettest humidity. Between them those of one size are released, and the ratios to it are interpolated.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from stiction.beam.foundation import foundation_length
from stiction.config.cases import case_id
from stiction.contact.air import is_humid
from stiction.contact.environment import Water
from stiction.devices import risk
from stiction.devices.chart import (
    ALLOWED,
    checked_power_law,
    error_between,
    of_sizes,
    parabola,
    rescaled,
    spread_of,
)
from stiction.plan.names import by_case
from stiction.plan.stage import Running, Stage, select, subsection
from stiction.stages.contact.corrections import with_correction
from stiction.stages.devices import sticking
from stiction.stages.devices.contact_names import corrected_tips_of
from stiction.stages.devices.ground import ground_from, ground_inputs
from stiction.stages.devices.opening import DesignedBeam, settings_of_beam


@dataclass(frozen=True)
class Settings:
    """Settings of a chart at one humidity, without its ground and the contact of tips."""

    seed: int
    water: Water
    humidity: float  #: [-]
    device: DesignedBeam
    beams: int
    shares: tuple[float, ...]  #: [-]
    thicknesses: tuple[float, ...]  #: increasing [m]
    gaps: tuple[float, ...]  #: increasing [m]
    edge_radius: float  #: of tips, for the bound of flats [m]

    @property
    def flats(self) -> tuple[Water, float, float]:
        """Water, humidity and edge, on which lengths of flats depend."""
        return self.water, self.humidity, self.edge_radius


@dataclass(frozen=True)
class Filled:
    """Lengths of beams of all sizes, and their source."""

    lengths: np.ndarray  #: (sizes, ...) [m]
    by_elements: np.ndarray  #: whether each size was computed by finite elements (sizes,) bool
    error: float  #: largest error of the power laws at the sizes in the middle [-]; 0 if none is used


#: Power law and error of a quantile that is not known.
_UNKNOWN = (lambda thickness, _gap: np.full(len(thickness), np.nan)), 0.0


def compute(
    ground: xr.Dataset,
    settings: Settings,
    tips: xr.Dataset | None = None,
    all_sizes: Sequence[xr.Dataset] = (),
) -> xr.Dataset:
    """Safe lengths and quantiles of all thicknesses and gaps. Inputs as in the stages cracks and safe_lengths.

    ``all_sizes`` are charts at the humidities of `stiction.devices.chart.of_sizes`, if this one is between them.
    """
    below = sticking.with_tips(ground_from(ground, settings), tips, settings.humidity, settings.water)
    chart = between(all_sizes, below, settings) if all_sizes else None
    chart = chart or filled(
        settings.thicknesses, settings.gaps, lambda *size: _lengths_of(_release(size, below, settings), settings)
    )
    longest = [settings.device.opening.longest_strip(device, below.laws) for device in _beams_of_chart(settings)]
    return layout(chart, float(ground.rms), longest, settings).assign(ground[["resampled", "repetition"]])


def _release(size, below, settings):
    """Released beams of one size, a thickness and a gap [m]."""
    return sticking.release_beams(_resized(settings, *size), below, settings)


def _lengths_of(beams, settings):
    """Safe lengths of beams and their quantiles (shapes, shares and scores) [m]."""
    bounds = sticking.lengths_without_samples(beams.device, *settings.flats, beams.reach)
    safe = sticking.by_shape(beams, settings, bounds)
    of_shares = [[bound.length for bound in of_shape] for of_shape in safe.values()]
    return np.hstack([of_shares, [risk.quantiles(values, beams.reach) for values in beams.lengths.values()]])


def _resized(settings, thickness, gap):
    """The designed beam with another thickness and gap [m]."""
    return replace(settings.device, thickness=float(thickness), gap=float(gap))


def _beams_of_chart(settings):
    """Beams of all sizes, in the order of `filled`."""
    return [_resized(settings, *size) for size in product(settings.thicknesses, settings.gaps)]


def filled(
    thicknesses: Sequence[float], gaps: Sequence[float], by_elements: Callable[[float, float], np.ndarray]
) -> Filled:
    """Lengths of beams of all sizes: computed by finite elements where a power law is not good enough.

    The sizes are the products of increasing thicknesses and gaps, in this order [m]; ``by_elements`` gives lengths of
    beams of one size by finite elements, of any shape [m].
    """
    sizes = np.array(list(product(thicknesses, gaps)))
    corner, test = corners_and_tests(len(thicknesses), len(gaps))
    by_number = {k: by_elements(*sizes[k]) for k in np.flatnonzero(corner | test)}
    if laws := _power_laws(sizes, by_number, test):
        between = np.array([law(*sizes.T) for law, _ in laws]).T.reshape(-1, *by_number[0].shape)
        lengths = [by_number.get(k, length) for k, length in enumerate(between)]
        return Filled(np.array(lengths), corner | test, max(error for _, error in laws))
    lengths = [by_number[k] if k in by_number else by_elements(*size) for k, size in enumerate(sizes)]
    return Filled(np.array(lengths), np.full(len(sizes), True), 0.0)


def between(charts: Sequence[xr.Dataset], below: sticking.Ground, settings: Settings) -> Filled | None:
    """Lengths of beams of all sizes at a humidity between those of three charts. None if their ratios vary too much.

    Beams of the size in the middle are released. Those of another size have the same order, and lengths whose median
    and scatter keep an interpolated ratio to them. Tips are those of each size.
    """
    sizes, middle = list(product(settings.thicknesses, settings.gaps)), _middle(settings)
    spreads = np.array([spread_of(_quantiles_of_beams(chart), risk.SCORES) for chart in charts])
    ratios, errors = parabola(
        [float(chart.humidity) for chart in charts], spreads - spreads[:, [middle]], settings.humidity
    )
    error = float(np.expm1(errors.max())) + max(float(chart.power_law_error) for chart in charts)
    if not error <= ALLOWED:
        return None
    of_middle = _release(sizes[middle], below, settings)
    alone = next(iter(of_middle.lengths.values()))
    spread = spread_of(risk.quantiles(alone, of_middle.reach), risk.SCORES)
    if not spread[0] - spread[1] > np.abs(np.diff(ratios)).max():  # too few stick, or all at the same length
        return None
    rescale = [partial(rescaled, spread=spread, ratios=of_size) for of_size in ratios]
    resized = [_resized_beams(of_middle, *case, below) for case in zip(sizes, rescale, strict=True)]
    lengths = [_lengths_of(of_middle if k == middle else beams, settings) for k, beams in enumerate(resized)]
    return Filled(np.array(lengths), np.arange(len(sizes)) == middle, error)


def _middle(settings):
    """Place of the size in the middle of both axes."""
    grid = len(settings.thicknesses), len(settings.gaps)
    return np.ravel_multi_index([number // 2 for number in grid], grid)


def _quantiles_of_beams(chart):
    """Quantiles of the lengths of a chart without tips (sizes, scores) [m]."""
    quantiles = chart["quantile"].isel(shape=0).transpose("thickness", "gap", "score").values
    return quantiles.reshape(-1, quantiles.shape[-1])


def _resized_beams(beams, size, rescale, below):
    """Released beams of another size [m], from those of one and the function that changes their lengths."""
    device = replace(beams.device, thickness=float(size[0]), gap=float(size[1]))
    hold = 0.0 if below.tips is None else risk.HOLD * foundation_length(device.beam, below.laws)
    alone = next(iter(beams.lengths.values()))
    return sticking.released(device, below, rescale(alone) - hold, float(rescale(beams.reach)))


def corners_and_tests(thicknesses: int, gaps: int) -> tuple[np.ndarray, np.ndarray]:
    """Sizes for the fit of a power law and for its test, (thicknesses * gaps,) bool each.

    It is tested in the middle of both axes, and in the middle of each along the least value of the other: departures
    along the two axes may cancel where both are met. No corner tests it.
    """
    corner, test = np.zeros((2, thicknesses, gaps), bool)
    corner[np.ix_([0, -1], [0, -1])] = True
    middle = thicknesses // 2, gaps // 2
    test[middle] = test[middle[0], 0] = test[0, middle[1]] = True
    return corner.ravel(), (test & ~corner).ravel()


def _power_laws(sizes, by_number, test):
    """Power law of each shape and share with its error. None if no size is left or one of them errs too much.

    A quantile that is not known at all sizes is not known between them.
    """
    numbers = list(by_number)
    if len(numbers) == len(sizes):
        return []
    columns = np.reshape([by_number[k] for k in numbers], (len(numbers), -1)).T
    try:
        return [
            checked_power_law(*sizes[numbers].T, column, test[numbers]) if np.isfinite(column).all() else _UNKNOWN
            for column in columns
        ]
    except ValueError:
        return []


def layout(filled: Filled, rms: float, longest_strips: Sequence[float], settings: Settings) -> xr.Dataset:
    """Dataset of safe lengths and quantiles (sizes, shapes, shares and scores) [m] over thickness and gap.

    The rms is that of the sum of both surfaces [m], and the longest strips (sizes,) resolve the cracks [m].
    """
    grid, size = (len(settings.thicknesses), len(settings.gaps)), ("thickness", "gap")
    shapes, shares = list(settings.device.opening.shapes), len(settings.shares)
    lengths = filled.lengths.reshape(*grid, len(shapes), -1)
    limits = [sticking.flooded_lengths(device, *settings.flats) for device in _beams_of_chart(settings)]
    return xr.Dataset(
        {
            "safe_length": ((*size, "shape", "share"), risk.in_order(lengths[..., :shares], settings.shares)),
            "quantile": ((*size, "shape", "score"), lengths[..., shares:]),
            "beams": ((), settings.beams),
            "flooded_length": ((*size, "shape"), np.reshape(limits, (*grid, -1))),
            "longest_strip": (size, np.reshape(longest_strips, grid)),
            "by_elements": (size, filled.by_elements.reshape(grid).astype(np.int8)),
            "power_law_error": ((), filled.error),
            "film": ((), settings.water.film(settings.humidity)[0]),
            "rms": ((), rms),
            "humidity": ((), settings.humidity),
        },
        coords={
            "thickness": ("thickness", list(settings.thicknesses)),
            "gap": ("gap", list(settings.gaps)),
            "shape": shapes,
            "share": list(settings.shares),
            "score": risk.SCORES,
        },
    )


def _settings(plan, at):
    """Settings of the cracks and the safe lengths, for all thicknesses and gaps of the chart of a device."""
    section = plan.config["devices"][at.case.device]
    sizes = {"gaps_um": [section["gap_um"]]} | subsection(section["chart"], ("thicknesses_um", "gaps_um"))
    return select(Settings, settings_of_beam(plan, at.case) | sizes)


def _all_sizes(plan, case):
    """Charts at the humidities with beams of all sizes, for one between them."""
    axis = plan.devices.axis(case.device)
    humidities = of_sizes(axis)
    if case.humidity in humidities or case.humidity not in axis:
        return {}
    return {"all_sizes": [f"devices/chart/{case_id(case.device, humidity)}" for humidity in humidities]}


def axes(datasets: Mapping[tuple[str, float], xr.Dataset]) -> dict[str, xr.Dataset]:
    """Chart of each device along ``relative_humidity``, from its datasets by device and humidity."""
    devices = {}
    for (name, humidity), dataset in sorted(datasets.items()):
        devices.setdefault(name, []).append(dataset.expand_dims(relative_humidity=[humidity]))
    joint = {"data_vars": "minimal", "coords": "minimal", "compat": "equals", "join": "exact"}
    return {name: xr.concat(datasets, "relative_humidity", **joint) for name, datasets in devices.items()}


def largest_error_between(chart: xr.Dataset) -> float:
    """Largest error of the cubic between the humidities of a chart, NaN with too few of them [-].

    The dataset has all humidities along ``relative_humidity``; dry air is apart.
    """
    humid = chart.safe_length.isel(relative_humidity=is_humid(chart.relative_humidity.values))
    if not humid.size:
        return np.nan
    curves = humid.transpose(..., "relative_humidity").values.reshape(-1, humid.sizes["relative_humidity"])
    errors = [error_between(humid.relative_humidity.values, lengths) for lengths in curves]
    return max(filter(np.isfinite, errors), default=np.nan)


def charts(plan: Any) -> dict[str, dict]:
    """Datasets of all charts by device and humidity, as inputs of a stage."""
    cases = [case for name in plan.devices.with_chart for case in plan.devices.chart_cases(name)]
    return {"charts": by_case("devices/chart", cases)}


STAGES = (
    Stage.writing(
        "chart",
        "devices/chart/{case}",
        inputs=lambda plan, at: (
            ground_inputs(plan, at.case) | corrected_tips_of(plan, at.case) | _all_sizes(plan, at.case)
        ),
        settings=_settings,
        kind=Settings,
        complete=with_correction,
        compute=compute,
        message="Chart of {case}.",
        running=Running(minutes=120),
    ),
)
