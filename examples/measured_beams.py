"""What the crack lengths that the paper measured say as test beams: ``python measured_beams.py FOLDER``.

Computes the budgets of the test beams of ``test_beams.yaml`` alone, without the tips of its devices. Writes
``measured.csv``, all numbers of the chapter by pair and name, and ``measured.md``, its table.
"""

import sys
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

import stiction
from stiction.config.units import in_si
from stiction.devices import inference
from stiction.plan.graph import Results
from stiction.report import published
from stiction.report.format import TO_UM, with_error
from stiction.stages.test_beams import inference as stage

#: Fewer samples and beams than in config.yaml. Computed lengths then have standard errors of about 0.5 %, far below the
#: differences from the measured ones.
FEW = {"contact": {"samples": 1000}, "chaos": {"order": 6}, "design": {"budget_beams": 100}}
#: Devices of the example by the pair of their test beams.
DEVICES = {"a": "onA", "b": "onB", "c": "onC"}
#: Numbers of every pair that are compared with those on the lengths that the paper computed.
COMPARED = ("slope", "line", "halves", "halves_of_factor", "median", "singles")
#: Rows of the table by the names of their numbers.
ROWS = {
    "rms": "rms of ln(measured / computed) [%]",
    "p_of_inputs": "p value, inputs alone",
    "p": "p value, inputs and model",
    "factor": "factor of the model",
    "slope": "slope of the model",
    "halves": "every second humidity from the others: rms error [%]",
    "halves_of_factor": "the same with a factor, but no slope [%]",
    "p_of_factor": "p value with a factor, but no slope",
}


@dataclass(frozen=True)
class Measured:
    """Test beams of one pair."""

    beams: list  #: results of stage test_beams
    settings: stage.Settings

    @classmethod
    def of(cls, results, device):
        """Those of a device."""
        job = results.graph.job(f"devices/test_beams/{device}")
        settings = in_si(stage.Settings, job.settings)
        budgets = {key: results[name] for key, name in job.inputs["test_beams"].items()}
        return cls([stage.Result(*key, budget, settings.arrays[key[0]]) for key, budget in budgets.items()], settings)

    def with_lengths(self, lengths):
        """The same test beams with other computed lengths, by humidity [µm]."""
        centres = (beam.budget.centre.copy(data=lengths[beam.humidity] / TO_UM) for beam in self.beams)
        budgets = (beam.budget.assign(centre=at) for beam, at in zip(self.beams, centres, strict=True))
        beams = [beam._replace(budget=budget) for beam, budget in zip(self.beams, budgets, strict=True)]
        return replace(self, beams=beams)

    @property
    def places(self):
        """Places of all beams."""
        return range(len(self.beams))

    def prior(self, others=(), slope=True, fitted=None):
        """Prior of inputs and model, and responses of beams and others; the slope is about the fitted beams."""
        stated = self.settings.discrepancy if slope else replace(self.settings.discrepancy, slope=0.0)
        results, places = [*self.beams, *others], self.places if fitted is None else fitted
        middle = float(np.mean([self.beams[k].reduced for k in places]))
        return stage.with_discrepancy(stage.common_inputs(results), results, middle, stated)

    def data(self, responses):
        """Measured crack lengths beside the computed ones."""
        return stage.length_data(self.beams, responses, self.settings.crack_lengths)

    def errors(self, fitted, slope=True):
        """Differences of the other beams from what the fitted ones predict, and their standard deviations [-]."""
        prior, responses = self.prior(slope=slope, fitted=fitted)
        data, others = self.data(responses), [k for k in self.places if k not in fitted]
        known = inference.update(prior, part(data, list(fitted)))
        shift, deviation = known.response_moments(data.responses[others])
        return data.differences[others] - shift, np.hypot(deviation, data.errors[others])


def main(folder):
    """Write numbers and table."""
    results = Results.of(stiction.load(Path(__file__).with_name("test_beams.yaml"), FEW))
    write({pair: Measured.of(results, device) for pair, device in DEVICES.items()}, folder)


def write(pairs, folder):
    """Numbers and table of all pairs."""
    texts = {pair: of_pair(array) for pair, array in pairs.items()} | {
        "ab": from_one_to_another(pairs["a"], pairs["b"]),
        "all": sizes_of_the_discrepancy(pairs.values()),
    }
    texts |= on_lengths_of_the_paper(pairs)
    folder.mkdir(parents=True, exist_ok=True)
    rows = [{"pair": pair, "name": name, "text": text} for pair, of in texts.items() for name, text in of.items()]
    pd.DataFrame(rows).to_csv(folder / "measured.csv", index=False, lineterminator="\n")
    cells = {"": ROWS.values()} | {f"pair {pair}": [texts[pair][name] for name in ROWS] for pair in pairs}
    (folder / "measured.md").write_text(
        pd.DataFrame(cells).to_markdown(index=False, disable_numparse=True) + "\n", encoding="utf-8"
    )


def of_pair(array):
    """Numbers of a pair as text by name."""
    prior, responses = array.prior()
    data, (without, its_responses) = array.data(responses), array.prior(slope=False)
    known = inference.update(prior, data)
    factor, slope = (known.names.index(name) for name in (inference.FACTOR, inference.SLOPE))
    halves = [range(0, 6, 2), range(1, 6, 2)]
    texts = {
        "rms": percent(data.differences),
        "p": f"{inference.p_value(prior, data):.2f}",
        "factor": with_error(np.exp(known.mean[factor]), np.exp(known.mean[factor]) * known.deviations[factor]),
        "slope": with_error(known.mean[slope], known.deviations[slope]),
        "slopes": f"{abs(known.mean[slope]) / prior.deviations[slope]:.1f}",
        "halves": percent(predicted(array, halves)[0]),
        "halves_stated": percent(predicted(array, halves)[1]),
        "halves_of_factor": percent(predicted(array, halves, slope=False)[0]),
        "p_of_factor": f"{inference.p_value(without, array.data(its_responses)):.1g}",
        "median": percent(np.median([rms(array.errors(half)[0]) for half in combinations(array.places, 3)])),
        "singles": percent(predicted(array, combinations(array.places, 5))[0]),
    }
    return texts | of_inputs_alone(array) | of_line(array, data) | lengths(array)


def of_inputs_alone(array):
    """What would have to be wrong if the model were exact, in standard uncertainties."""
    prior, responses = array.prior()
    inputs, count = stage.common_inputs(array.beams), len(prior.names) - 2 - len(array.beams)
    data = replace(array.data(responses), responses=responses[: len(array.beams), :count])
    best = inference.update(inputs, data)
    moved = dict(zip(inputs.names, np.abs(best.mean) / inputs.deviations, strict=True))
    numbers = {
        "humidity": moved["humidity"],
        "temperature": moved["temperature"],
        "modulus": moved["Young's modulus"],
        "gap": next(value for name, value in moved.items() if name.startswith("gap of")),
    }
    (measured,) = array.settings.crack_lengths.values()
    single = replace(data, errors=data.errors * np.sqrt(measured.beams))
    left = {"p_of_inputs": f"{inference.p_value(inputs, data):.0e}", "left": percent(residuals(data, best))}
    left |= {"p_of_single": f"{inference.p_value(inputs, single):.0e}"}
    return left | {f"{name}_alone": f"{value:.1f}" for name, value in numbers.items()}


def of_line(array, data):
    """Scatter of ln(measured / computed) around the best straight line in ln l."""
    _, away, scatter = line(array, data)
    most = {
        f"line_{round(100 * beam.humidity)}": f"{100 * at:+.1f}" for beam, at in zip(array.beams, away, strict=True)
    }
    return {"line": f"{100 * scatter:.1f}"} | most


def line(array, data):
    """Slope of the best straight line of ln(measured / computed) over ln l, distances from it, and their scatter."""
    reduced = np.array([beam.reduced for beam in array.beams])
    fitted = np.polyfit(reduced, data.differences, 1)
    away = data.differences - np.polyval(fitted, reduced)
    return fitted[0], away, np.sqrt(np.sum(away**2) / (len(away) - 2))


def sizes_of_the_discrepancy(arrays):
    """Root mean squares, over all pairs, of factor, slope and rest that describe ln(measured / computed)."""
    data = [array.data(array.prior()[1]) for array in arrays]
    slopes, _, rests = zip(*map(line, arrays, data), strict=True)
    sizes = {"factor": [one.differences.mean() for one in data], "slope": slopes, "rest": rests}
    return {name: f"{rms(values):.2f}" for name, values in sizes.items()}


def on_lengths_of_the_paper(pairs):
    """Numbers of pairs on the lengths that the paper computed, and by how much those computed here are shorter."""
    table, theirs, texts = published.read(published.file("table_3")), {}, {}
    for pair, array in pairs.items():
        lengths_of_paper = table[table.pair == pair].set_index("relative_humidity").ng
        theirs[pair] = array.with_lengths(lengths_of_paper)
        ratios = [TO_UM * float(beam.budget.centre) / lengths_of_paper[beam.humidity] for beam in array.beams]
        numbers = of_pair(theirs[pair])
        texts[f"paper_{pair}"] = {name: numbers[name] for name in COMPARED} | {
            "shorter": f"{100 * (1 - min(ratios)):.0f}"
        }
    return texts | {"paper_ab": from_one_to_another(theirs["a"], theirs["b"])}


def lengths(array):
    """Lengths of equal beams of another device before and after, whose dimensions and rests are its own [µm]."""
    others = [beam._replace(owner="C1") for beam in array.beams]
    prior, responses = array.prior(others)
    known, device = inference.update(prior, array.data(responses)), responses[len(array.beams) :]
    texts = {}
    for beam, row, error, difference in zip(
        array.beams, device, array.data(responses).errors, array.data(responses).differences, strict=True
    ):
        computed, (shift, after), (_, before) = (
            TO_UM * float(beam.budget.centre),
            known.response_moments(row),
            prior.response_moments(row),
        )
        measured, updated, end = computed * np.exp(difference), computed * np.exp(shift), round(100 * beam.humidity)
        texts |= {
            f"measured_{end}": with_error(measured, measured * error),
            f"before_{end}": with_error(computed, computed * before),
            f"after_{end}": with_error(updated, updated * after),
        }
    return texts


def from_one_to_another(array, other):
    """Errors at the humidities of another pair after the test beams of one, without and with a slope of the model."""
    texts = {}
    for name, slope in (("slope", True), ("factor", False)):
        prior, responses = array.prior(other.beams, slope)
        theirs = other.data(responses[len(array.beams) :])
        shift, deviation = inference.update(prior, array.data(responses)).response_moments(theirs.responses)
        away = theirs.differences - shift
        texts[f"rms_of_{name}"] = percent(away)
        if slope:
            stated = np.hypot(deviation, theirs.errors)
            texts |= {"stated": percent(stated), "most": f"{np.abs(away / stated).max():.1f}"}
    return texts


# Numbers


def predicted(array, halves, slope=True):
    """Errors of all beams that are predicted from several choices of the fitted ones, and their deviations [-]."""
    return np.concatenate([array.errors(half, slope) for half in halves], axis=1)


def part(data, places):
    """Some of the measured lengths."""
    return replace(data, **{name: getattr(data, name)[places] for name in ("responses", "differences", "errors")})


def residuals(data, known):
    """What the known errors of the inputs leave of the differences [-]."""
    return data.differences - data.responses @ known.mean


def rms(values):
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def percent(values):
    """Root of the mean square in percent."""
    return f"{100 * rms(values):.1f}"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
