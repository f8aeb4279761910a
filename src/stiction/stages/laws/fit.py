"""Study fit (Sec. III-B1, Fig. 5): relative errors of Eq. (12) with respect to the computed force curves."""

import numpy as np
import xarray as xr

from stiction.contact.forcelaw import admissible, fit_errors
from stiction.plan.stage import Stage, select
from stiction.stages.contact.curves import force_curves
from stiction.stages.laws import forces as stage_forces

#: Everything that the fit depends on apart from the contact and the forces.
Settings = stage_forces.Settings


def compute(contact: xr.Dataset, forces: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Compare every curve with the force law of its vector v, if there is one."""
    vectors, limit = stage_forces.vectors_of_curves(forces)
    samples = np.flatnonzero(admissible(vectors, limit))
    distance, curve, *_ = force_curves(contact, settings.humidity, settings.water)
    errors = fit_errors(distance, curve, samples, vectors[samples], limit)
    return layout(samples, errors, len(vectors))


def layout(samples: np.ndarray, errors: tuple[np.ndarray, np.ndarray], total: int) -> xr.Dataset:
    """Dataset of the relative errors of Eq. (12) with respect to the curves of lawful samples.

    Numbers of these samples (n,), out of ``total``, and errors of the curve and of the adhesion energy, (n,) each [-].
    """
    columns = zip(("curve_error", "energy_error"), errors, strict=True)
    return xr.Dataset(
        {name: ("strip", error) for name, error in columns} | {"without_law": ((), 1 - len(samples) / total)},
        coords={"strip": samples},
    )


STAGES = (
    Stage.writing(
        "fit",
        "fit/{case}_{model}",
        inputs=lambda plan, at: {
            "contact": f"contact/{plan.contact(at.case)}_{at.model}",
            "forces": f"forces/{at.case}_{at.model}",
        },
        settings=lambda plan, at: select(Settings, plan.at(at.case)),
        kind=Settings,
        compute=compute,
        message="Errors of Eq. (12) in {case}, {model} (Sec. III-B1).",
    ),
)
