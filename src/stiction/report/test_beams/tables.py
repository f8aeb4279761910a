"""Tables of test beams: their evidence about a device, in numbers and sentences."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stiction.answer.sought import PULL_OFF
from stiction.contact.air import humid
from stiction.devices import inference
from stiction.devices.limits.limit import Limit, Side
from stiction.plan.names import by_name
from stiction.report.format import TO_UM, airs, number, safe_size, with_error
from stiction.report.limits import words
from stiction.report.table import DEVICE, Line, Table, table_stage
from stiction.rounding import in_percent
from stiction.stages.devices.end_states import END_STATES
from stiction.stages.devices.opening import ARC, MIDDLE, S_SHAPE, SOUGHT_BY
from stiction.stages.test_beams.inference import BEAM_SIZES, UNLIKELY, is_reliable, shape_of

#: Number of standard deviations beyond which an input counts as wrong; ratio of dimensions beyond which a prediction
#: counts as extrapolated. ASSUME: a factor of two.
LARGE, SIZES = 2.0, 2.0
#: Difference of ln l of equal beams beyond which it counts as extrapolated. ASSUME: 10 % of the length, over which the
#: standard deviation of the slope of the model is 3 %.
ADHESION = 0.1
#: Combinations whose standard deviation falls to less than this part count as determined; inputs with a correlation of
#: less than this part of the largest one are not named.
DETERMINED, NAMED = 0.5, 0.25
#: Smallest factor of the adhesion that is worth a sentence.
NOTICED = 1.01
#: Standard errors beyond which the linear update and its rerun count as different.
DIFFERENT = 3.0
_MORE = {True: "more", False: "less"}
#: Why nothing is known of a result, or of what test beams say.
_FEW = "so few of the simulated devices stick that they do not show what an input changes"
#: P(stuck) before and after, and its scale.
_STUCK = ("expected_stuck", "updated_stuck", 100)


# Sentences


def combinations(update: xr.Dataset) -> list[str]:
    """Inputs determined by the test beams, and inputs not told apart by them."""
    names = update.input.values
    sentences = []
    for remaining, correlations in zip(update.remaining.values, update.correlation.values, strict=True):
        if remaining < DETERMINED:
            used = [
                i for i in np.argsort(-np.abs(correlations)) if abs(correlations[i]) >= NAMED * max(abs(correlations))
            ]
            listed = [f"{_MORE[correlations[i] > 0]} {names[i]} ({correlations[i]:+.2f})" for i in used]
            apart = "They do not tell these apart" if len(used) > 1 else "It is mostly this input"
            sentences.append(
                f"The test beams determine one combination of the inputs {1 / remaining:.2g} times better than before: "
                f"{', '.join(listed)}. {apart} (in brackets: correlation with the combination)."
            )
    return sentences or ["The test beams determine no combination of the inputs twice as well as before."]


def beams_to_add(update: xr.Dataset) -> str:
    """Most useful further test beams, at the least known result of the device; empty if no cracks are known."""
    if update.result_after.isnull().all():
        return f"Which further test beams would help is not known: {_FEW}."
    if not update.sizes["further"]:
        return ""
    worst = int(np.nanargmax(update.result_after.values))
    deviations = update.result_after_further.isel(result=worst)
    best = int(np.nanargmin(deviations.isel(beams=0).values))
    after = [
        f"{in_percent(deviation)} with {int(deviation.beams)} beams" for deviation in deviations.isel(further=best)
    ]
    return (
        f"Further test beams would help most with the dimensions and in the air of {update.further.values[best]}, at "
        f"least {TO_UM * float(update.further_length[best]):.0f} µm long: the standard uncertainty of the result for "
        f"{update.result.values[worst]} would fall from {100 * float(update.result_after[worst]):.2g} to "
        f"{', to '.join(after)}."
    )


def agreement(update: xr.Dataset) -> str:
    """Agreement of the data with the model."""
    left_out = f"Left out are {update.attrs['left_out']}: {_FEW}." if update.attrs["left_out"] else ""
    forces = _forces_in(update)
    if not (update.sizes["datum"] or forces):
        return left_out
    together, of_inputs = float(update.p_value), float(update.p_value_of_inputs)
    agree = "The test beams are as computed, within the stated errors. " * (min(together, of_inputs) >= UNLIKELY)
    return (
        f"{agree}Differences from the computed {'lengths, counts and forces' if forces else 'lengths and counts'} as "
        f"large as measured, or larger, have a probability of {together:.2g} if inputs and model err as stated, and of "
        f"{of_inputs:.2g} if the inputs alone do." + f" {left_out}".rstrip()
    )


def _forces_in(update):
    """Number of means of pull-off forces."""
    return update.sizes.get("force", 0)


def notes(update: xr.Dataset) -> str:
    """What the test beams say about the answer apart from its number, or why they say nothing."""
    responses = list(map(str, update.response.values))
    sought = SOUGHT_BY[responses[0]]
    none = f"With the test beams, no {sought.name} is stated"
    if not is_reliable(update):
        return f"{none}. {words.text(contradiction(update))}"
    if update.result_after.isnull().any():
        return f"{none}: {_FEW}."
    if sought.more_is_better:
        return "Cracks do not say how much the model errs at stoppers."
    if not update.sizes["datum"] and _forces_in(update):
        return "The answer contains the error of the model as stated: pull-off forces say nothing about it."
    beyond = ", but not where the middle of a bridge holds" if MIDDLE in responses else ""
    sentence = f"The answer contains the error of the model as far as the test beams show it{beyond}."
    return sentence + _beyond_cracks(update)


def _beyond_cracks(update):
    """Evidence of the cracks on errors of the model elsewhere in the device, empty without crack lengths."""
    if MIDDLE in update.response.values:
        return " Cracks do not say how much the model errs at bridges."
    if ARC not in update.response.values or update.measured.isnull().all():
        return ""
    more = float(update.adhesion_of_tips.max())
    if more < NOTICED:
        return " Cracks show no more adhesion than the inputs explain, and tips are taken to adhere as these say."
    shown = f" Cracks show up to {more:.3g} times the adhesion that the inputs explain"
    return f"{shown}: tips are taken to adhere as much more."


def again(update: xr.Dataset) -> str:
    """Comparison of the linear update with results computed again at its inputs."""
    if update.attrs["refused"]:
        return f"At the inputs that the test beams suggest, nothing can be computed again: {update.attrs['refused']}."
    return (
        "Computed again at the inputs that the test beams suggest, the results change by (in brackets: by the linear "
        f"update) {', '.join(map(_change, _again(update)))}. Errors of the model and lengths that tips hold are left "
        "out."
    )


def _again(update):
    """Each recomputed result that is known."""
    return [update.isel(again=k) for k in range(update.sizes["again"]) if np.isfinite(update.linear[k])]


def _change(result):
    """Both changes of a result in words."""
    linear, rerun = (
        with_error(100 * float(result[name]), 100 * float(result[f"{name}_error"])) for name in ("linear", "rerun")
    )
    return f"{result['again'].values}: {rerun} % (linear {linear} %)"


def stuck_sentences(update: xr.Dataset) -> list[str]:
    """P(stuck) before and after the measurement at every humidity, averaged over the uncertainty of the inputs.

    Nothing, where nothing explains the test beams.
    """
    if not is_reliable(update):
        return []
    shape = shape_of(min(map(str, update.response.values), key=list(reversed(END_STATES)).index))
    chosen = update.sel(shape=shape)
    if "share" in chosen.expected_stuck.dims:
        chosen = chosen.isel(share=update.sizes["share"] // 2)
    sentences, sought = [], SOUGHT_BY[shape]
    every = (chosen.sel(humidity=humidity) for humidity in update.humidity.values)
    for at in (in_air for in_air in every if np.isfinite(in_air.updated_stuck)):
        stated = f"at its {sought.label}"
        size = stated if sought.more_is_better else f"of {safe_size(float(at.safe), sought)}, the simulated limit,"
        sentences.append(
            f"{airs([float(at.humidity)]).capitalize()}, {in_percent(at.expected_stuck)} of the devices {size} are "
            f"expected to stick without the test beams and {in_percent(at.updated_stuck)} with them, averaged over the "
            "uncertainty of the inputs."
        )
    return sentences


# Table


def test_beams(datasets: Mapping[str, xr.Dataset]) -> Table:
    """Test beams and the lengths of their devices, by name of the device, before and after the measurement."""
    parts = _data, _force_rows, _results, _safe_sizes, _input_rows
    rows = [row for device, update in datasets.items() for rows_of in parts for row in rows_of(device, update)]
    sentences = [
        f"{device}: {sentence}"
        for device, update in datasets.items()
        for sentence in [
            agreement(update),
            *combinations(update),
            beams_to_add(update),
            again(update),
            *stuck_sentences(update),
            *words.texts(warnings(update)),
        ]
        if sentence
    ]
    caption = (
        "Test beams: measured crack lengths with the standard errors of their means, counts of stuck beams, and "
        "lengths of test beams and devices before and after the measurement, with standard deviations due to the "
        "inputs and, of crack lengths and of tips, due to the model. Inputs in their standard "
        "uncertainties."
    )
    missing = {"measured"} - {name for row in rows for name in row}
    columns = {name: column for name, column in _COLUMNS.items() if name not in missing}
    return Table.from_rows(rows, [caption, *map(Line, sentences)], columns)


def _data(device, update):
    """Crack lengths and counts."""
    for datum in update.datum.values:
        at = update.sel(datum=datum)
        computed = TO_UM * float(at.computed)
        numbers = _length_numbers(computed, *(float(at[f"datum_{key}"]) for key in ("before", "shift", "after")))
        error = float(at.measured * at.datum_measured_error)
        measured = {"measured": TO_UM * float(at.measured), "measured_se": TO_UM * error} if error > 0 else {}
        head = {"device": device, "relative_humidity": float(at.datum_humidity), "part": "crack length [µm]"}
        yield head | {"name": str(at.array.values)} | numbers | measured
    for k in range(update.sizes["count"]):
        at = update.isel(count=k)
        label = f"stuck of {int(at.counted)}, {TO_UM * float(at.length_of_count):g} µm long"
        head = {"device": device, "relative_humidity": float(at.humidity_of_count), "part": label}
        shares = {name: float(at.counted * at[f"stuck_{name}"]) for name in ("before", "after")}
        yield (
            head | {"name": str(at.array_of_count.values), "measured": float(at.stuck), "measured_se": np.nan} | shares
        )


def _force_rows(device, update):
    """Pull-off forces. Errors of measured ones contain those of computed ones."""
    for k in range(_forces_in(update)):
        at = update.isel(force=k)
        computed, measured = (float(at[f"{name}_force"]) / PULL_OFF.scale for name in ("computed", "measured"))
        numbers = _length_numbers(computed, *(float(at[f"force_{key}"]) for key in ("before", "shift", "after")))
        label = f"mean {PULL_OFF.label} [{PULL_OFF.shown}]"
        head = {"device": device, "relative_humidity": float(at.humidity_of_force), "part": label}
        of_measurement = {"measured": measured, "measured_se": measured * float(at.force_error)}
        yield head | {"name": str(at.array_of_force.values)} | numbers | of_measurement


def _results(device, update):
    """Results of the budgets of the device."""
    for result in update.result.values:
        at = update.sel(result=result)
        length = TO_UM * float(at.centre)
        numbers = _length_numbers(length, *(float(at[f"result_{key}"]) for key in ("before", "shift", "after")))
        head = {"device": device, "relative_humidity": float(at.humidity_of_result)}
        yield head | {"part": END_STATES[str(at.response.values)].result, "name": device} | numbers


def _safe_sizes(device, update):
    """Safe lengths or forces, and P(stuck)."""
    for humidity in update.humidity.values:
        head = {"device": device, "relative_humidity": float(humidity), "name": device}
        for shape in map(str, update["shape"].values):
            of_shape, unit = update.sel(humidity=humidity, shape=shape), SOUGHT_BY[shape].shown
            for share in update.share.values:
                at = of_shape.sel(share=share)
                label = f"{END_STATES[shape].safe}, p = {share:g}"
                yield head | {"part": f"{label} [{unit}]"} | _compared(at, "safe", "updated_safe", TO_UM)
                if "share" in update.expected_stuck.dims:
                    yield head | {"part": f"stuck at the {label}, of column before [%]"} | _compared(at, *_STUCK)
            if "share" not in update.expected_stuck.dims:
                yield head | {"part": "stuck at the restoring force [%]"} | _compared(of_shape, *_STUCK)


def _input_rows(device, update):
    """Inputs in their standard uncertainties."""
    for name in update.input.values:
        at = update.sel(input=name)
        scale = float(at.prior_deviation) or np.nan
        head = {"device": device, "relative_humidity": np.nan, "part": "input [standard uncertainties]", "name": name}
        after = {"after": float(at["shift"]) / scale, "after_std": float(at.deviation) / scale}
        yield head | {"before": 0.0, "before_std": 1.0} | after


def _compared(update, before, after, scale):
    """Numbers before and after the measurement, the latter only if they are to be relied on."""
    updated = float(update[after]) if is_reliable(update) else np.nan
    return {"before": scale * float(update[before]), "after": scale * updated}


def _length_numbers(length, before, shift, after):
    """Length before and after the measurement, with standard deviations, from its logarithm's."""
    updated = length * np.exp(shift)
    return {"before": length, "before_std": length * before, "after": updated, "after_std": updated * after}


def _number(value, deviation):
    """Number, with its standard deviation if it has one."""
    return with_error(value, deviation) if deviation > 0 else number(value, ".1f" if abs(value) >= 1 else ".2g")


_COLUMNS = DEVICE | {
    "what": (lambda share, name: f"{name}: {share}", "part", "name"),
    "before": (_number, "before", "before_std"),
    "after": (_number, "after", "after_std"),
    "measured": (
        lambda value, error: number(value, "g") if np.isnan(error) else with_error(value, error),
        *("measured", "measured_se"),
    ),
}


# Limits


def warnings(update: xr.Dataset) -> list[Limit]:
    """Contradictions of the test beams, and predictions beyond them."""
    return [*_contradictions(update), *_moved_inputs(update), *_nonlinear(update), *_beyond_test_beams(update)]


def _contradictions(update):
    """Data not explained by the inputs, or by inputs and model together."""
    of_inputs = float(update.p_value_of_inputs)
    if not is_reliable(update):
        yield contradiction(update)
    elif of_inputs < UNLIKELY:
        factor, slope = (float(update["shift"].sel(input=name)) for name in (inference.FACTOR, inference.SLOPE))
        numbers = {"p_value": of_inputs, "factor": float(np.exp(factor)), "slope": slope}
        yield Limit("model_explains_test_beams", Side.EITHER, True, numbers=numbers)
    for datum in map(str, update.datum.values[update.computed.values > update.beam_length.values]):
        at = update.sel(datum=datum)
        numbers = {"datum": datum, "computed": float(at.computed), "beam_length": float(at.beam_length)}
        yield Limit("cracks_beyond_test_beams", Side.SAFE, False, numbers=numbers)


def contradiction(update: xr.Dataset) -> Limit:
    """Test beams that neither inputs nor model explain: lengths may be too long by any amount."""
    return Limit("test_beams_contradict", Side.UNSAFE, False, numbers={"p_value": float(update.p_value)})


def _moved_inputs(update):
    """Inputs, and rests of the model, with errors beyond their standard deviations."""
    uncertain = update.isel(input=np.flatnonzero(update.prior_deviation.values > 0))
    for name, score in zip(
        uncertain.input.values, (uncertain["shift"] / uncertain.prior_deviation).values, strict=True
    ):
        if abs(score) > LARGE:
            yield Limit("moved_input", Side.EITHER, True, numbers={"name": str(name), "score": float(score)})
    for datum, residual in zip(update.datum.values, update.datum_rest.values, strict=True):
        if abs(residual) > LARGE * update.attrs["rest"]:
            numbers = {"datum": str(datum), "rest": float(residual)}
            yield Limit("left_to_the_model", Side.EITHER, True, numbers=numbers)


def _nonlinear(update):
    """Results with other changes than in the linear update."""
    different = []
    for result in _again(update):
        apart = float(result.rerun - result.linear)
        error = float(np.hypot(result.linear_error, result.rerun_error))
        if abs(apart) > DIFFERENT * error:
            different.append([str(result["again"].values), apart, error])
    if different:
        yield Limit("nonlinear_update", Side.EITHER, True, numbers={"different": different})


def _beyond_test_beams(update):
    """Conditions of the device beyond those of its test beams, if any of these say something."""
    if not (update.sizes["datum"] or _forces_in(update)):
        return
    of_forces = update.humidity_of_force.values.tolist() if _forces_in(update) else []
    measured = sorted({*update.datum_humidity.values.tolist(), *of_forces})
    wet = humid(measured) or [np.inf]
    results = sorted(set(update.humidity_of_result.values.tolist()) - set(measured))
    beyond = [humidity for humidity in results if not wet[0] <= humidity <= wet[-1]]
    if beyond:
        numbers = {"measured": measured, "beyond": beyond}
        yield Limit("beyond_humidities_of_test_beams", Side.EITHER, False, numbers=numbers)
    if not update.sizes["datum"]:
        return
    yield from _beyond_in_adhesion(update)
    for size in BEAM_SIZES if "own_thickness" in update else ():
        device = float(update[f"own_{size}"][0])
        nearest = min(update[size].values.tolist(), key=lambda value: abs(np.log(device / value)))
        if abs(np.log(device / nearest)) > np.log(SIZES):
            numbers = {"size": size, "device": device, "nearest": nearest, "factor": SIZES}
            yield Limit("beyond_sizes_of_test_beams", Side.EITHER, False, numbers=numbers)


def _beyond_in_adhesion(update):
    """Cracks of the device longer, or shorter, than equal beams would have under the conditions of the test beams."""
    least, most = (float(update.datum_reduced.quantile(end)) for end in (0, 1))
    for result, response, reduced in zip(
        update.result.values, update.response.values, update.result_reduced.values.tolist(), strict=True
    ):
        beyond = max(reduced - most, least - reduced)
        if response == S_SHAPE and beyond > ADHESION:
            numbers = {"result": str(result), "change": float(np.expm1(beyond if reduced > most else -beyond))}
            yield Limit("beyond_adhesion_of_test_beams", Side.EITHER, False, numbers=numbers)


STAGES = (
    table_stage(
        "test_beams",
        "what test beams say about devices",
        inputs=lambda plan, at: {"test_beams": by_name("devices/test_beams/rerun", plan.devices.with_test_beams)},
        compute=lambda data: test_beams(data["test_beams"]),
        jobs=lambda plan: [{}] if plan.devices.with_test_beams else [],
        targets=("devices",),
    ),
)
