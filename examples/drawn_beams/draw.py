"""Draw test beams and a device from a truth that differs from what is stated about them: ``python draw.py FOLDER``.

Writes ``wafer.csv``, the single test beams that ``mine.yaml`` reads, and ``truth.csv``, the true lengths of the device.
"""

import csv
import sys
from functools import partial
from pathlib import Path

import numpy as np

import stiction
from stiction.config.reading import read
from stiction.config.test_beams import COLUMNS
from stiction.estimates import mean_with_error
from stiction.report.format import UM
from stiction.stages.devices import cracks as stage_cracks
from stiction.stages.devices.opening import EITHER

#: What is true instead of what ``mine.yaml`` states, within its uncertainties; the surfaces are drawn anew.
TRUTH = {"seed": 7, "solid": {"young_modulus_GPa": 158}, "surfaces": {"B2": {"rms_nm": 3.35}}}
SIZES = {"wafer": {"thickness_um": 2.57, "gap_um": 20.2}, "C1": {"thickness_um": 2.63, "gap_um": 19.9}}
AIR = 0.008  #: true less stated humidity [-]
#: Humidities at which cracks of beams of one length are measured [µm], and number of beams at each.
MEASURED, LENGTH, NUMBER = (0.5, 0.7, 0.85), 1500, 12
#: Humidity and lengths at which stuck beams are counted [µm], and number of beams of each.
AT, COUNTED, OF = 0.7, (350, 450), 20


def main(folder):
    """Write both files; existing ones are kept."""
    if (folder / "truth.csv").exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    stated = read(Path(__file__).with_name("mine.yaml"))
    own = stated["devices"]["C1"]
    humidities = {"wafer": MEASURED, "C1": own["humidities"]}
    shared = {key: own[key] for key in ("kind", "pair", "width_um")}
    devices = {name: shared | SIZES[name] | {"humidities": [*map(true, humidities[name])]} for name in SIZES}
    numbers = {key: stated[key] for key in ("run", "contact", "chaos", "design")}
    device = stiction.Device.of(stiction.load(numbers, TRUTH, {"devices": devices}), "C1")
    wafer = stiction.Device("wafer", device.results)
    write(folder / "wafer.csv", COLUMNS, [*measured(wafer), *counted(wafer)])
    write(folder / "truth.csv", ("humidity", "crack_length_um", "se_um"), [*lengths(device, own["humidities"])])


def true(humidity):
    """Humidity that a hygrometer shows as another one [-]."""
    return round(humidity + AIR, 4)


def measured(wafer):
    """Rows of beams with crack lengths."""
    for humidity in MEASURED:
        cracks = stage_cracks.lengths(wafer.cracks(true(humidity)))
        yield from ([humidity, LENGTH, f"{crack / UM:.1f}", ""] for crack in cracks[:NUMBER])


def counted(wafer):
    """Rows of counted beams, drawn from the true P(stuck)."""
    stuck = wafer.safe_lengths(true(AT)).stuck.sel(shape=EITHER)
    rng = stiction.stream(TRUTH["seed"], "example", "counts")
    for length in COUNTED:
        draws = rng.random(OF) < float(stuck.interp(length=length * UM))
        yield from ([AT, length, "", "yes" if one else "no"] for one in draws)


def lengths(device, humidities):
    """Rows with the true mean crack lengths of the device and the standard errors of their computation."""
    for humidity in humidities:
        computed = device.cracks(true(humidity))
        mean, own = mean_with_error(stage_cracks.lengths(computed))
        surfaces = stage_cracks.surfaces_of(computed).error(partial(_mean_length, computed))
        yield [humidity, mean / UM, np.hypot(own, surfaces) / UM]


def _mean_length(computed, move):
    """Mean length as on other samples of the surfaces [m]."""
    return move(stage_cracks.lengths(computed)).mean()


def write(path, columns, rows):
    """Write a table."""
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([columns, *rows])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
