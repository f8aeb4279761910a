"""Predict the rows of one experiment: ``python prediction.py validation/NAME.yaml NAME.json``.

Each of `DRAWS` draws takes all assumed inputs from their ranges and surfaces from a seed of its own, so that scatter
between draws contains the inputs and the simulation. No draw sees what was measured.
"""

import json
import sys
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
import pandas as pd
from experiment import Experiment, Row, read
from scipy.stats import qmc

import stiction
from stiction.analysis.prediction import Discrepancy
from stiction.config.cases import case_id
from stiction.config.kinds import KINDS
from stiction.config.units import in_si
from stiction.contact.meniscus import film
from stiction.plan.graph import Results
from stiction.progress import without_progress
from stiction.stages.devices import stoppers
from stiction.stages.devices.contact_names import contact_of
from stiction.stages.devices.prediction import MEASURED, PAPER_LENGTHS, TOUCHING
from stiction.streams import stream

SEED = 76
#: Draws of the assumed inputs: one more draw would lie in their range in 18 of 20 cases.
DRAWS = 19
#: Patches of each draw, length of a patch [µm], temperature [K].
STRIPS, LENGTH, TEMPERATURE = 24, 1.5, 300.0
#: Gap of the pair [µm], which changes no patch: room for films in saturated air.
GAP = 100
#: Decimals of the sides of a patch [µm], as of the grid of 10 nm.
DECIMALS = 2
#: Names of the pair and of a probe on it, and keys of its shape.
PAIR, PROBE, OF_PROBE = "mine", "Probe", KINDS["probe"].shape
UM = 1e-6


def main(path, result):
    """Write the draws of each row in SI units, and their relative Monte-Carlo errors."""
    with without_progress():
        rows = predicted(read(path))
    result.parent.mkdir(parents=True, exist_ok=True)
    result.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def predicted(experiment: Experiment, draws: int = DRAWS) -> list[dict]:
    """Draws of each row of an experiment [SI] and their median relative Monte-Carlo error."""
    if experiment.not_computed:
        return []
    found = [drawn(experiment, inputs, number) for number, inputs in enumerate(assumed(experiment, draws))]
    return [
        {"draws": [row[0] for row in rows], "monte_carlo": float(np.median([row[1] for row in rows]))}
        for rows in zip(*found, strict=True)
    ]


def assumed(experiment: Experiment, draws: int = DRAWS) -> list[dict]:
    """Values of the assumed inputs of each draw, evenly spread (Halton, scrambled)."""
    names = list(experiment.assumed)
    rng = stream(SEED, "validation", experiment.name)
    quantiles = qmc.Halton(max(1, len(names)), rng=rng).random(draws)
    return [{name: experiment.assumed[name].at(at) for name, at in zip(names, row, strict=False)} for row in quantiles]


def drawn(experiment: Experiment, inputs: dict, number: int) -> list[tuple[float, float]]:
    """Quantity of each row under one draw of the inputs, and its relative Monte-Carlo error."""
    states = [experiment.states(row, inputs) for row in experiment.rows]
    contacts = Contacts([state for of_row in states for state in of_row], SEED + number)
    quantities = []
    for row, of_row in zip(experiment.rows, states, strict=True):
        values, errors = zip(*(value(state, contacts) for state in of_row), strict=True)
        quantities.append((law(row, np.array(values)), float(np.hypot.reduce(errors))))
    return quantities


def law(row: Row, values: np.ndarray) -> float:
    """Quantity of a row from the values of its states.

    Examples
    --------
    >>> areas = np.array([1.0, 4.0, 9.0])
    >>> exponent = Row("", "exponent", "-", along={"name": "area", "values": tuple(areas)})
    >>> round(law(exponent, 3 * areas**0.5), 12)
    0.5
    """
    along = row.along.get("values", ())
    if row.kind == "level":
        return float(values[0])
    if row.kind == "ratio":
        return float(np.exp(np.dot(row.powers, np.log(values))))
    if row.kind == "exponent":
        return float(np.polyfit(np.log(along), np.log(values), 1)[0])
    if row.kind == "maximum":
        return float(along[int(np.argmax(values))])
    return crossing(np.array(along, float), values / values[0], row.falls_to)


def crossing(at: np.ndarray, values: np.ndarray, level: float) -> float:
    """Place at which falling values cross a level, between places by powers; the last place if they stay above."""
    below = np.flatnonzero(values < level)
    if not below.size:
        return float(at[-1])
    k = max(1, below[0])
    part = np.log(values[k - 1] / level) / np.log(values[k - 1] / values[k])
    return float(np.exp(np.log(at[k - 1]) + part * np.log(at[k] / at[k - 1])))


def value(state: dict, contacts: "Contacts") -> tuple[float, float]:
    """Observable of one state [SI], and its relative Monte-Carlo error."""
    factor, observable = state.get("factor", 1.0), state["observable"]
    if observable == "film":
        return factor * film(state["air"], state.get("temperature_K", TEMPERATURE))[0], 0.0
    if observable == "crack":
        return factor * crack(state["pair"], state["air"], state["quantile"]), 0.0
    of_patches = contacts.of(state)
    devices = of_patches[: state.get("devices", len(of_patches))]
    error = of_patches.std(ddof=1) / of_patches.mean() / np.sqrt(len(devices))
    return factor * float(devices.mean()), float(error)


def crack(pair: str, humidity: float, quantile: float) -> float:
    """Quantile of a crack length of the paper's beams [m], from the model and how it errs on the other two pairs."""
    lengths = paper_lengths()
    own = lengths[lengths.pair == pair]
    others = [of for name, of in lengths.groupby("pair") if name != pair]
    discrepancy = Discrepancy.learnt([(of[TOUCHING].values, of[MEASURED].values) for of in others])
    row = own[np.isclose(own.relative_humidity, humidity)]
    place = np.log(row[TOUCHING].values) - np.log(own[TOUCHING]).mean()
    (width,) = discrepancy.half_widths(place, np.zeros(1), abs(2 * quantile - 1))
    return UM * float(row[TOUCHING].iloc[0] * np.exp(np.sign(quantile - 0.5) * width))


@cache
def paper_lengths() -> pd.DataFrame:
    """Measured and computed lengths of the paper's beams [µm]."""
    return pd.read_csv(PAPER_LENGTHS, dtype={"pair": str})


@dataclass(frozen=True)
class Contacts:
    """Contacts of all states of a draw. States that differ in their air share their surfaces."""

    states: list
    seed: int

    def of(self, state: dict) -> np.ndarray:
        """Observable of the patches of a state (strips,) [SI]."""
        results = _results(surfaces(state), tuple(sorted(self._airs(state), key=str)), self.seed)
        return _OBSERVED[state["observable"]](results, state)

    def _airs(self, state):
        """Airs of all states on the same surfaces."""
        same = surfaces(state)
        return {other["air"] for other in self.states if surfaces(other) == same}


def energies(results: Results, state: dict) -> np.ndarray:
    """Adhesion energies of the patches of a state [J m⁻²]."""
    return _study(results).energies(state["air"])


def pressures(results: Results, state: dict) -> np.ndarray:
    """Pull-off forces per area of the patches of a state [Pa]."""
    return _study(results).forces(state["air"]).pull_off.values


def forces(results: Results, state: dict) -> np.ndarray:
    """Pull-off forces of the patches of a state [N]."""
    return state["area_um2"] * UM**2 * pressures(results, state)


def forces_of_probe(results: Results, state: dict) -> np.ndarray:
    """Pull-off forces of the places of a device of the kind probe [N]."""
    settings = in_si(stoppers.Settings, results.graph.job(f"devices/stoppers/{PROBE}").settings)
    case = case_id(PROBE, state["air"])
    return stoppers.forces(results[contact_of(results.graph.plan, case)], case.humidity, settings)


_OBSERVED = {"energy": energies, "pressure": pressures, "force": forces, "probe": forces_of_probe}


def surfaces(state: dict) -> str:
    """What determines the contact of a state apart from its air."""
    keys = ("faces", "area_um2", *OF_PROBE, "strips", "temperature_K", "settings")
    return json.dumps({key: state[key] for key in keys if key in state}, sort_keys=True)


@lru_cache(16)
def _results(same: str, airs: tuple, seed: int) -> Results:
    """Results on drawn surfaces in some airs."""
    return Results.of(stiction.load(configuration(json.loads(same), airs, seed)))


def _study(results):
    """Flat patches."""
    return stiction.PairStudy(PAIR, "NG", results)


def configuration(state: dict, airs: tuple, seed: int) -> dict:
    """Changes of the paper's configuration for the patches of one state."""
    names, of_patches = ("Upper", "Lower"), under_probe if "radius_um" in state else in_strips
    return {
        "seed": seed,
        "surfaces": dict(zip(names, state["faces"], strict=True)),
        "pairs": {
            PAIR: dict(zip(("beam", "substrate"), names, strict=True)) | {"gap_um": GAP, "humidities": list(airs)}
        },
        "water": {"temperature_K": state.get("temperature_K", TEMPERATURE)},
        "contact": {"samples": state.get("strips", STRIPS), "chunks": 1, "model": "summits"},
        "chaos": {"order": 1},
        **of_patches(state, airs),
    } | state.get("settings", {})


def in_strips(state: dict, _airs: tuple) -> dict:
    """Sections of a flat patch."""
    area = state.get("area_um2", LENGTH**2)
    length = round(min(LENGTH, float(np.sqrt(area))), DECIMALS)
    return {
        "run": {"pairs": [PAIR], "studies": []},
        "sampling": {"strip_length_um": length},
        "beam": {"width_um": round(area / length, DECIMALS)},
    }


def under_probe(state: dict, airs: tuple) -> dict:
    """Sections of a probe. No spring frees it, whose force is stated because one must be."""
    shape = {key: state[key] for key in OF_PROBE if key in state}
    probe = {"kind": "probe", "pair": PAIR, "humidities": list(airs), "restoring_force_uN": 1} | shape
    return {"run": {"pairs": [], "studies": []}, "devices": {PROBE: probe}}


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
