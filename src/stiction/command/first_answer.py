"""First safe length of a run, said as soon as it exists while the run goes on."""

from pathlib import Path

import numpy as np

from stiction.config.cases import Air, Case
from stiction.config.units import from_si
from stiction.devices.risk import one_in
from stiction.run import storage
from stiction.stages.devices.safe_lengths import chosen_share

#: Folder of the logs of datasets, and of the datasets.
_LOGS, _RESULTS = "results/logs/", "results/"


def first_answer(log: str, folder: Path) -> str:
    """Safe length of a device at a humidity and its error in a sentence, from the log of its job in a folder of a run.

    It is the one against all shapes, for the middle share of stuck devices.

    Raises
    ------
    DataError
        If the dataset of the job cannot be read.
    """
    path = folder / log.replace(_LOGS, _RESULTS, 1).removesuffix(".log")
    dataset = storage.load(path.with_name(f"{path.name}.nc"), "safe_lengths")
    found = dataset.isel(shape=-1).sel(share=chosen_share(dataset))
    length, estimate = (from_si(float(found[name]), "um") for name in ("safe_length", "estimate"))
    error = from_si(float(np.hypot(found.beams_error, found.surfaces_error.fillna(0))), "um")
    known = f" (estimate {estimate:.0f} ± {error:.2g} µm)" if np.isfinite(error) else ""
    case = Case(path.name)
    return (
        f"First safe length: {case.device} {Air(case.humidity).where} can be {length:.0f} µm long{known} if at most "
        f"{one_in(float(found.share))} may stick. The run goes on."
    )
