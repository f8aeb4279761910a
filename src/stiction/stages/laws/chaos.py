"""Stage chaos (App. B): the chaos model of the force law of one case, and its statistics compared with its input."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.chaos import model as chaos
from stiction.chaos.model import ChaosModel, Truncation
from stiction.plan.stage import Stage, select
from stiction.stages.laws.forces import COMPONENTS, vectors
from stiction.stages.laws.stored_model import chaos_model, model_variables
from stiction.streams import stream

#: Number of draws for the comparison of the model with its input.
_DRAWS = 100_000


@dataclass(frozen=True)
class Settings:
    """Settings of a chaos model, without the force laws."""

    chaos: Truncation
    seed: int


def compute(forces: xr.Dataset, case: str, model: str, settings: Settings) -> xr.Dataset:
    """Fit the chaos model and compare draws from it with its input.

    Case and model are parts of the addresses of random numbers.
    """
    samples, limit = vectors(forces)
    fitted = chaos.fit(samples, limit, settings.chaos.order, settings.chaos.dimension_tolerance)
    report = chaos.fit_report(fitted, samples, _DRAWS, stream(settings.seed, "chaos", case, model))
    _, rejected = chaos.draw(fitted, _DRAWS, stream(settings.seed, "rejection", case, model))
    return layout(fitted, report, rejected / (rejected + _DRAWS))


def layout(model: ChaosModel, report: tuple[np.ndarray, np.ndarray], rejected: float) -> xr.Dataset:
    """Dataset of the chaos model of the vector v of one case and of its comparison with the input.

    The report has statistics and correlations by source, input, kernel density and chaos, (3, 4, 4) each; ``rejected``
    is the share of draws without a force law [-].
    """
    statistics, correlations = report
    return xr.Dataset(
        model_variables(model)
        | {
            "dimension_error": ("axis", model.dimension_error),
            "truncation_error": ("eta", model.truncation_error),
            "rejected": ((), rejected),
            "statistics": (("source", "statistic", "component"), statistics),
            "correlation": (("source", "component", "other"), correlations),
        },
        coords={
            "component": list(COMPONENTS),
            "other": list(COMPONENTS),
            "axis": [1, 2, 3, 4],
            "source": ["input", "kernels", "chaos"],
            "statistic": ["mean", "standard deviation", "1 % quantile", "99 % quantile"],
        },
    )


def generated_laws(dataset: xr.Dataset, number: int, case: str, seed: int) -> np.ndarray:
    """Force laws of a case drawn from its chaos model, Eq. (12), for Fig. 12, (number, 4) [SI]."""
    return chaos.draw_laws(chaos_model(dataset), number, stream(seed, "figure 12", case))


STAGES = (
    Stage.writing(
        "chaos",
        "chaos/{case}_{model}",
        inputs=lambda plan, at: {"forces": f"forces/{at.case}_{at.model}"},
        settings=lambda plan, at: select(Settings, plan.config),
        kind=Settings,
        compute=compute,
        message="Chaos model of the force law of {case}, {model} (App. B).",
    ),
)
