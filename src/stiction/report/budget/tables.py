"""Tables of stoppers and of the uncertainty of devices: P(stuck) of patches, and advice on measurements."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr

from stiction.contact.air import Air, has_dry, is_humid
from stiction.devices.budget import advice
from stiction.devices.limits.limit import Limit
from stiction.devices.risk import Basis
from stiction.estimates import mean_with_error
from stiction.plan.names import by_name
from stiction.report.format import UN, bounding, fraction_with_band, humidity_text, number, signed, with_error
from stiction.report.limits import words
from stiction.report.model_error import column
from stiction.report.model_error import sentences as model_errors
from stiction.report.table import DEVICE, Line, Table, Term, as_text, table_stage, warned
from stiction.stages.devices import device_warnings
from stiction.stages.devices.budget import budget_of, budgets_of, groups_of, response_of, slope_errors_of
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import FORCE
from stiction.stages.devices.stoppers import ends, in_any_air, is_at_an_end, shares_stuck

#: Rows of a budget below those of its measurements.
TOTAL, INDEPENDENT, SCATTER = "total", "total, if all errors were independent", "scatter between devices"
#: These rows for readers.
_ROWS = {
    TOTAL: "total: all measurements together",
    INDEPENDENT: "for comparison: total without correlations",
    SCATTER: f"{SCATTER}, not in the total",
}
#: Parts that are the error of the model: computed at a humidity, or interpolated.
MODEL = ("model", "model, interpolated")
#: Other choices of the model in words for those who design.
_CHOICES = {
    "van_der_waals_dry": "van der Waals in dry gaps",
    "van_der_waals_water": "van der Waals in water",
    "van_der_waals_none": "no van der Waals",
    "psd_identified": "spectrum from summits",
    "psd_published": "published spectrum",
    "every": "1 in {} grid points",
    "spacing_nm": "grid of {} nm",
    "poisson_ratio": "Poisson's ratio {}",
}


def choice_label(name: str) -> str:
    """Another choice of the model in words.

    Examples
    --------
    >>> choice_label("van_der_waals_none"), choice_label("poisson_ratio_0.18")
    ('no van der Waals', "Poisson's ratio 0.18")
    """
    key, _, chosen = name.rpartition("_")
    return _CHOICES[name] if name in _CHOICES else _CHOICES[key].format(chosen)


# Stoppers


def stoppers(
    datasets: Mapping[str, xr.Dataset],
    warnings: Mapping[str, Sequence[Limit]],
    errors: Mapping[str, xr.Dataset] | None = None,
    not_modelled: str = "",
) -> Table:
    """Stoppers: pull-off force, P(stuck), force needed, humidity of the largest mean. Everything is by device.

    The caption ends with what is not in the model.
    """
    rows = [row for device, dataset in datasets.items() for row in _stopper_rows(device, dataset)]
    rows = [row | model_errors.device_change(errors, row["device"], row["relative_humidity"], FORCE) for row in rows]
    rows = [row | {"warnings": " ".join(words.texts(warnings[row["device"]]))} for row in rows]
    shows: list[str | Term | Line] = [
        "Stoppers: pull-off force of a patch, on average an upper bound if it tilts or bends, mean ± standard error "
        "and standard deviation over the patches; P(stuck): fraction of the patches with a pull-off force above the "
        "restoring force, with its 95 % band; simulated limit: restoring force exceeded by the pull-off force of at "
        "most this fraction of all patches, with 95 % confidence; fitted: by a line through the largest 5 % of the "
        "forces, if too few patches bound the fraction; extrapolated: by this line beyond its verified range; –: too "
        "few patches. One touchdown, no voltage, and all inputs exact: table devices has forces to build."
    ]
    humid = [dataset for dataset in datasets.values() if ends(dataset)]
    if humid:
        shows += ["The last row of a stopper has the largest values along a fine axis of humidities.", _WORST_RH]
    if any(has_dry(dataset.axis.values) for dataset in humid):
        shows.append("For a stopper in dry air as well, this is one of them.")
    if 0 < len(humid) < len(datasets):
        shows.append("One in a single air has no such row.")
    listed = [f"{device}: {sentence}" for device, of_device in warnings.items() for sentence in words.texts(of_device)]
    shows += [*([column.caption(errors)] if errors else []), not_modelled, *warned(listed)]
    columns = _columns_of_stoppers(rows) | (_WORST if humid else {}) | (column.COLUMN if errors else {})
    return Table.from_rows(rows, shows, columns)


def _stopper_rows(device, dataset):
    """Numbers of one stopper at each of its humidities and, in humid air, the largest along its fine axis."""
    for humidity, *stuck in shares_stuck(dataset):
        forces = dataset.pull_off.sel(humidity=humidity).values / UN
        mean, error = mean_with_error(forces)
        error = np.hypot(error, mean * float(dataset.full_contact_error.sel(humidity=humidity)))
        pull = mean, error, forces.std(ddof=1)
        safe = dataset.safe_force.sel(humidity=humidity, part="safe")
        yield {"device": device, "relative_humidity": humidity} | _stopper(dataset, pull, stuck, safe)
    if not ends(dataset):
        return
    worst = dataset.isel(axis=int(dataset.mean_along.argmax("axis")))
    pull = float(worst.mean_along) / UN, float(worst.mean_along_error) / UN, np.nan
    yield {"device": device, "relative_humidity": np.nan} | _stopper(dataset, pull, *in_any_air(dataset))


def _stopper(dataset, pull, stuck, safe):
    """Numbers of a row: pull-off force with its error and standard deviation, P(stuck) with its band, safe forces."""
    row = dict(zip(("pull_off_uN", "pull_off_se_uN", "pull_off_std_uN"), pull, strict=True))
    row |= {"restoring_force_uN": float(dataset.restoring_force) / UN}
    row |= dict(zip(("share_stuck", "share_stuck_low", "share_stuck_high"), stuck, strict=True))
    for force, basis in zip(safe, dataset.basis.values, strict=True):
        share = f"{float(force.share):g}"
        row |= {f"safe_force_uN_{share}": float(force) / UN, f"safe_force_basis_{share}": str(basis)}
    row |= {"lowest_humidity": float(dataset.axis[0]), "highest_humidity": float(dataset.axis[-1])}
    row |= {"worst_humidity": float(dataset.worst_humidity)}
    return row | {"worst_humidity_se": float(dataset.worst_humidity_error), "worst_is_an_end": is_at_an_end(dataset)}


def _columns_of_stoppers(rows):
    """Columns for reading. The columns of the safe forces depend on the fractions."""
    shares = dict.fromkeys(name.rpartition("_")[2] for row in rows for name in row if name.startswith("safe_force_uN"))
    return DEVICE | {
        "RH": (_humidities, "relative_humidity", "lowest_humidity", "highest_humidity"),
        "pull-off force [µN]": (with_error, "pull_off_uN", "pull_off_se_uN"),
        "std [µN]": (".3g", "pull_off_std_uN"),
        "restoring force [µN]": ("g", "restoring_force_uN"),
        "P(stuck) [%]": (fraction_with_band, "share_stuck", "share_stuck_low", "share_stuck_high"),
        **{
            f"simulated limit, {share} [µN]": (_with_basis, f"safe_force_uN_{share}", f"safe_force_basis_{share}")
            for share in shares
        },
    }


def _with_basis(force, basis):
    """Safe force, rounded up, and its basis unless it is sampled patches."""
    return bounding(force, 3, up=True) + (f" ({basis})" if basis in (Basis.FITTED, Basis.EXTRAPOLATED) else "")


def _humidities(humidity, lowest, highest):
    """Humidity of a row, or the range of all, possibly after dry air."""
    if np.isnan(humidity):
        return " to ".join(dict.fromkeys(map(humidity_text, (lowest, highest))))
    return humidity_text(humidity)


def worst_humidity(humidity: float, error: float, is_an_end: bool) -> str:
    """Humidity of the largest mean force as text, marked at an end of the computed humidities.

    Examples
    --------
    >>> worst_humidity(0.901, 0.0021, False), worst_humidity(0.98, 0.0, True)
    ('0.9010 ± 0.0021', '0.98 or beyond')
    """
    if not is_humid(humidity):
        return humidity_text(humidity)
    return f"{humidity:g} or beyond" if is_an_end else with_error(humidity, error)


_WORST_RH = Term(
    "RH of largest mean",
    "humidity of the largest mean pull-off force along this axis. Rare places can hold most in other air.",
)
_WORST = {"RH of largest mean": (worst_humidity, "worst_humidity", "worst_humidity_se", "worst_is_an_end")}


# Budget


def budget(budgets: Mapping[tuple, xr.Dataset], errors: Mapping[str, xr.Dataset] | None = None) -> Table:
    """Uncertainty of every device: effect of each measurement, total, scatter, choices of the model.

    The numbers hold every input with its slope, and whole surfaces in place of assumed ones. The text is by
    measurement, with a sentence on what to measure better.
    The budgets are by device, humidity and, for those of tips, ``tip``; the errors of the model by device.
    """
    frame = _frame(budgets, errors)
    sentences = [
        f"{device}, {Air(humidity).words}: {what_to_measure(dataset)}"
        for (device, humidity, *_), dataset in budgets.items()
    ]
    devices = dict.fromkeys(device for device, *_ in budgets)
    omitted = [
        f"{name}: {counted_as_exact(*(dataset for (device, *_), dataset in budgets.items() if device == name))}"
        for name in devices
    ]
    shows = [
        "Relative standard uncertainty of a result due to each measurement, if all others were exact, ± standard error "
        "of the simulation. The result is the mean length of beams stuck as S-shapes, the length at which few stick "
        "at their tip, the mean length of bridges stuck at their middle, or the mean pull-off force of stoppers.",
        Term(
            "Remaining",
            "the uncertainty left if the measurement were exact. Scatter between devices and other choices of the "
            "model, with the sign of their effect, are no part of the total.",
        ),
        Term(
            "Total",
            "the uncertainty by all measurements together. Answers count errors in this way: quantities of one "
            "measurement, such as rms and skewness, are correlated. The total without correlations is no part of them.",
        ),
        *([column.caption(errors)] if errors else []),
        *map(Line, [*sentences, *omitted]),
    ]
    return Table(frame, shows, _cells(frame))


def cells_of_page(budgets: Mapping[tuple, xr.Dataset], errors: Mapping[str, xr.Dataset] | None = None) -> pd.DataFrame:
    """Text of the budgets of one device, as in its table, without the total that is for comparison alone."""
    frame = _frame(budgets, errors)
    return _cells(frame[frame.name != INDEPENDENT])


def _frame(budgets, errors):
    """Numbers of all budgets, and of the errors of the model."""
    return pd.DataFrame(
        [
            row
            for (device, rh, *_), dataset in budgets.items()
            for row in [*_budget_rows(device, rh, dataset), *_model_rows(device, rh, dataset, errors)]
        ]
    )


def _cells(frame):
    """Rows of measurements and all below them for reading."""
    return as_text(frame[~frame.part.isin(["input", "member"])], _BUDGET)


def what_to_measure(dataset: xr.Dataset) -> str:
    """Sentence on the most useful measurement."""
    uncertainty = budget_of(dataset)
    if np.isnan(uncertainty.total):
        return "Too few of the simulated devices stick to show the effect of an input."
    if uncertainty.total == 0:
        return f"No input with a stated uncertainty acts on the {response_text(dataset)}."
    return advice(uncertainty, groups_of(dataset), response_text(dataset))


def response_text(dataset: xr.Dataset) -> str:
    """Quantity changed by the inputs, in words."""
    response, share = response_of(dataset)
    return END_STATES[response].budget.format(f"{1 / share:g}" if share else "")


def counted_as_exact(*datasets: xr.Dataset) -> str:
    """Sentence on inputs without a stated uncertainty in budgets of a device: those of most, then of the others."""
    longest_first = sorted(datasets, key=lambda dataset: -dataset.sizes["exact"])
    names = dict.fromkeys(str(name) for dataset in longest_first for name in dataset.exact.values)
    return f"Counted as exact: {', '.join(names)}."


def _budget_rows(device, humidity, dataset):
    """Numbers of one device at one humidity: inputs, measurements, totals, scatter, choices."""
    uncertainty, errors = budget_of(dataset), slope_errors_of(dataset)
    head = {"device": device, "relative_humidity": humidity, "held_by": END_STATES[response_of(dataset)[0]].by}
    yield from (head | row for row in _input_rows(uncertainty, errors))
    for name, inputs in groups_of(dataset).items():
        left = {"remaining_percent": 100 * uncertainty.remaining(inputs)}
        yield head | {"part": "measurement", "name": name} | _effect(uncertainty, inputs, errors) | left
    for name, total in ((TOTAL, uncertainty), (INDEPENDENT, uncertainty.uncorrelated)):
        yield head | {"part": "total", "name": name} | _effect(total, uncertainty.names, errors)
    yield head | {"part": "scatter", "name": SCATTER, "effect_percent": 100 * float(dataset.scatter)}
    for name in dataset.choice.values:
        effect, error = (100 * float(dataset[key].sel(choice=name)) for key in ("effect", "effect_error"))
        yield head | {"part": "choice", "name": str(name), "effect_percent": effect, "effect_se_percent": error}


def _input_rows(uncertainty, errors):
    """Numbers of all inputs, and of whole surfaces, whose slopes are their shifts."""
    members, deviations = sum(uncertainty.kinds, ()), np.sqrt(np.diag(uncertainty.covariance))
    for name, slope, error, deviation in zip(uncertainty.names, uncertainty.slopes, errors, deviations, strict=True):
        row = {"part": "input", "name": name, "slope": slope, "slope_se": error}
        if name in members:
            yield row | {"part": "member"}
        else:
            yield row | {"standard_uncertainty": deviation} | _effect(uncertainty, [name], errors)


def _model_rows(device, humidity, dataset, errors):
    """Row of the error of the model, if it is stated."""
    response, _ = response_of(dataset)
    head = {"device": device, "relative_humidity": humidity, "held_by": END_STATES[response].by}
    if device in (errors or {}):
        error = model_errors.device_change(errors, device, humidity, response)
        effect = {"effect_percent": error["model_error_percent"], "effect_se_percent": error["model_error_se_percent"]}
        yield head | {"part": MODEL[error["interpolated"]], "name": "model error: full elastic contact"} | effect


def _effect(budget, inputs, slope_errors):
    """Effect of some inputs and its standard error [%]."""
    error = budget.error_of_effect(inputs, slope_errors)
    return {"effect_percent": 100 * budget.effect(inputs), "effect_se_percent": 100 * error}


def _effect_as_text(share, effect, error):
    """Effect with its standard error, if it has one. Effects of a choice, or of the model, have a sign."""
    if share in MODEL:
        return column.marked_change(effect, error, share == MODEL[1])
    if not error > 0 or np.isnan(effect):
        return number(effect, ".2g")
    return (signed if share == "choice" else with_error)(effect, error)


_BUDGET = DEVICE | {
    "held by": (str, "held_by"),
    "what": (
        lambda share, name: f"choice: {choice_label(name)}" if share == "choice" else _ROWS.get(name, name),
        "part",
        "name",
    ),
    "effect [%]": (_effect_as_text, "part", "effect_percent", "effect_se_percent"),
    "remaining [%]": (".2g", "remaining_percent"),
}


STAGES = (
    table_stage(
        "stoppers",
        "P(stuck) of stoppers",
        inputs=lambda plan, at: (
            {
                "stoppers": by_name("devices/stoppers", plan.devices.stoppers),
                "warnings": device_warnings.files_of(*plan.devices.stoppers),
            }
            | model_errors.error_inputs(plan, *plan.devices.stoppers)
        ),
        settings=lambda plan, at: {"not_modelled": device_warnings.not_modelled(plan, *plan.devices.stoppers)},
        compute=lambda data, settings: stoppers(
            data["stoppers"],
            device_warnings.read(data["warnings"]).patches,
            data.get("errors"),
            words.not_modelled(**settings["not_modelled"]),
        ),
        jobs=lambda plan: [{}] if plan.devices.stoppers else [],
        targets=("devices",),
    ),
    table_stage(
        "budget",
        "uncertainty of devices, and what to measure better",
        inputs=lambda plan, at: (
            {"budgets": budgets_of(plan, *plan.devices.with_budget)}
            | model_errors.error_inputs(plan, *plan.devices.with_budget)
        ),
        compute=budget,
        jobs=lambda plan: [{}] if plan.devices.with_budget else [],
        targets=("devices",),
    ),
)
