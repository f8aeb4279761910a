"""First answer of a run, said as soon as it exists while the run goes on."""

from pathlib import Path

import numpy as np

from stiction.config.cases import Case
from stiction.config.units import from_si
from stiction.contact.air import Air
from stiction.devices.risk import one_in
from stiction.report.format import bounding, fraction_with_band
from stiction.run import storage
from stiction.stages.devices.safe_lengths import chosen_share
from stiction.stages.devices.stoppers import shares_stuck

#: Folder of the logs of datasets, and of the datasets.
_LOGS, _RESULTS = "results/logs/", "results/"


def first_answer(log: str, folder: Path) -> str:
    """Safe length of a device at a humidity, or share of a stopper that sticks, with its error in a sentence.

    From the log of its job in a folder of a run. The length is the one against all shapes, for the middle share of
    stuck devices, and the humidity of a stopper the one where most stick.

    Raises
    ------
    DataError
        If the dataset of the job cannot be read.
    """
    path = folder / log.replace(_LOGS, _RESULTS, 1).removesuffix(".log")
    sentence = {"safe_lengths": _length, "stoppers": _share}[stage := path.parent.name]
    return f"{sentence(storage.load(path.with_name(f'{path.name}.nc'), stage), path.name)} The run goes on."


def _length(dataset, name):
    """Safe length of a case."""
    state = dataset.isel(shape=-1).sel(share=chosen_share(dataset))
    length, estimate = (from_si(float(state[name]), "um") for name in ("safe_length", "estimate"))
    error = from_si(float(np.hypot(state.beams_error, state.surfaces_error.fillna(0))), "um")
    with_estimate = f" (estimate {estimate:.0f} ± {error:.2g} µm)" if np.isfinite(error) else ""
    case, most = Case(name), bounding(length, 3, up=False)
    return (
        f"First number: by simulation alone, {case.device} {Air(case.humidity).where} can be {most} µm long"
        f"{with_estimate} if at most {one_in(float(state.share))} may stick."
    )


def _share(dataset, name):
    """Share of a stopper that sticks."""
    humidity, *stuck = max(shares_stuck(dataset), key=lambda row: row[1:])
    if np.isnan(float(dataset.restoring_force)):
        half = dataset.pull_off.median("sample").max("humidity")
        force = f"{from_si(float(half), 'nN'):.3g} nN"
        return f"First number: by simulation alone, half of the places under {name} hold more than {force}."
    force = from_si(float(dataset.restoring_force), "uN")
    return (
        f"First answer: of {name} with {force:.3g} µN, {fraction_with_band(*stuck, ' %')} stick {Air(humidity).where} "
        "(95 % confidence)."
    )
