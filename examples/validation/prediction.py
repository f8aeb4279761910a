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
from stiction.contact.meniscus import film
from stiction.progress import without_progress
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
NM, UM = 1e-9, 1e-6


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
    energies, pressures = contacts.of(state)
    of_strips = energies if observable in ("energy", "sphere") else pressures
    devices = of_strips[: state.get("devices", len(of_strips))]
    error = of_strips.std(ddof=1) / of_strips.mean() / np.sqrt(len(devices))
    return factor * scale(state) * float(devices.mean()), float(error)


def scale(state: dict) -> float:
    """Factor from the energy or pressure of patches to the observable of a state [SI]."""
    if state["observable"] == "force":
        return state["area_um2"] * UM**2
    return derjaguin(state) if state["observable"] == "sphere" else 1.0


def derjaguin(state: dict) -> float:
    """Force of a sphere over the energy of flats, 2πR [m].

    Raises
    ------
    ValueError
        If the zone in which the gap grows by one rms, of radius √(2 R rms), is narrower than the correlation length.
    """
    radius = state["radius_um"] * UM
    zone = np.sqrt(2 * radius * NM * np.hypot(*(face["rms_nm"] for face in state["faces"])))
    if zone < NM * max(face.get("correlation_length_nm", 0.0) for face in state["faces"]):
        raise ValueError(
            f"a sphere of {radius / UM:g} µm touches a zone of {zone / NM:.0f} nm, narrower than the correlation "
            "length: Derjaguin's approximation fails, write not_computed"
        )
    return 2 * np.pi * radius


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
    """Energies and pull-off pressures of all states of a draw. States that differ in their air share their surfaces."""

    states: list
    seed: int

    def of(self, state: dict) -> tuple[np.ndarray, np.ndarray]:
        """Energies [J m⁻²] and pull-off pressures [Pa] of the patches of a state, (strips,) each."""
        study = _study(surfaces(state), tuple(sorted(self._airs(state), key=str)), self.seed)
        return study.energies(state["air"]), study.forces(state["air"]).pull_off.values

    def _airs(self, state):
        """Airs of all states on the same surfaces."""
        same = surfaces(state)
        return {other["air"] for other in self.states if surfaces(other) == same}


def surfaces(state: dict) -> str:
    """What determines the contact of a state apart from its air."""
    keys = ("faces", "area_um2", "strips", "temperature_K", "settings")
    return json.dumps({key: state[key] for key in keys if key in state}, sort_keys=True)


@lru_cache(16)
def _study(same: str, airs: tuple, seed: int) -> stiction.PairStudy:
    """Pair of drawn surfaces in some airs."""
    return stiction.PairStudy.of(stiction.load(configuration(json.loads(same), airs, seed)), "mine")


def configuration(state: dict, airs: tuple, seed: int) -> dict:
    """Changes of the paper's configuration for the patches of one state."""
    area = state.get("area_um2", LENGTH**2)
    length = round(min(LENGTH, float(np.sqrt(area))), DECIMALS)
    names = ("Upper", "Lower")
    return {
        "seed": seed,
        "run": {"pairs": ["mine"], "studies": []},
        "surfaces": dict(zip(names, state["faces"], strict=True)),
        "pairs": {
            "mine": dict(zip(("beam", "substrate"), names, strict=True)) | {"gap_um": GAP, "humidities": list(airs)}
        },
        "sampling": {"strip_length_um": length},
        "beam": {"width_um": round(area / length, DECIMALS)},
        "water": {"temperature_K": state.get("temperature_K", TEMPERATURE)},
        "contact": {"samples": state.get("strips", STRIPS), "chunks": 1, "model": "summits"},
        "chaos": {"order": 1},
    } | state.get("settings", {})


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
