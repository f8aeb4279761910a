"""Stage forces (Sec. III-B1): the force curves at one humidity and the vectors of their parameters."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from stiction.contact.environment import Water
from stiction.contact.forcelaw import admissible
from stiction.plan.stage import Stage, select
from stiction.stages.contact import corrections
from stiction.stages.contact.curves import force_curves, parametrised

#: Components of v, Eq. (11).
COMPONENTS = ("adhesion_energy", "pull_off", "pull_off_distance", "limit_distance")
#: Components and f_limit on summits, in datasets of what is corrected to full elastic contact.
_ON_SUMMITS = {name: f"summit_{name}" for name in ("adhesion_energy", "pull_off", "limit")}
#: Number of curves stored for Fig. 12.
_KEPT = 200


@dataclass(frozen=True)
class Settings:
    """Settings of the forces, without the contact."""

    water: Water
    humidity: float  #: [-]


def compute(contact: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Add the water to the solid contact of every sample and compute e, f_max, d_max and d_limit.

    Returns
    -------
    Dataset
        Components of v(sample), Eq. (11), f_limit, and the first few curves.
    """
    sampled = force_curves(contact, settings.humidity, settings.water)
    vectors, limit = parametrised(sampled, settings.humidity, settings.water)
    shown = [sampled.curve(k).copy() for k in range(min(_KEPT, sampled.samples))]
    dataset = layout(vectors, limit, sampled.distance, shown)
    if settings.water.correction is None:
        return dataset
    on_summits = replace(settings.water, correction=None)
    plain = layout(*parametrised(sampled, settings.humidity, on_summits), sampled.distance, shown)
    return dataset.assign({key: plain[name] for name, key in _ON_SUMMITS.items()})


def layout(vectors: np.ndarray, limit: float, distance: np.ndarray, curves: Sequence[np.ndarray]) -> xr.Dataset:
    """Dataset of the vectors v(sample, component) of Eq. (11), f_limit, and the first few curves.

    Vectors (n, 4) [SI], f_limit [Pa], distances (n_d,) [m] and forces of the first samples (k, n_d) [Pa].
    """
    return xr.Dataset(
        {name: ("strip", column) for name, column in zip(COMPONENTS, vectors.T, strict=True)}
        | {"limit": limit, "force": (("curve", "distance"), np.asarray(curves, np.float32))},
        coords={"distance": distance, "strip": np.arange(len(vectors), dtype=np.int32)},
    )


def vectors(forces: xr.Dataset) -> tuple[np.ndarray, float]:
    """Vectors v (m, 4) [SI] and f_limit [Pa]."""
    return np.column_stack([forces[name].values for name in COMPONENTS]), float(forces.limit)


def vectors_of_curves(forces: xr.Dataset) -> tuple[np.ndarray, float]:
    """Vectors of the curves themselves: of the sum over summits, without a correction to full elastic contact."""
    on_summits = {name: forces[key] for name, key in _ON_SUMMITS.items() if key in forces}
    return vectors(forces.assign(on_summits))


def energies(forces: xr.Dataset) -> np.ndarray:
    """Adhesion energies e of all samples (m,) [J m⁻²]."""
    return forces.adhesion_energy.values


def typical(forces: xr.Dataset) -> int:
    """Number of the sample of median energy e among those with a stored curve and a force law of Eq. (12)."""
    samples, limit = vectors(forces)
    lawful = np.flatnonzero(admissible(samples[: forces.sizes["curve"]], limit))
    return int(lawful[np.argsort(samples[lawful, 0])[len(lawful) // 2]])


def curves(forces: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Distance (n_d,) [m] and the force curves of the first samples (k, n_d) [Pa]."""
    return forces.distance.values, forces.force.values


STAGES = (
    Stage.writing(
        "forces",
        "forces/{case}_{model}",
        inputs=lambda plan, at: (
            {"contact": f"contact/{plan.contact(at.case)}_{at.model}"}
            | corrections.corrections_of_laws(plan, at.case.pair, [at.case.humidity], at.model)
        ),
        settings=lambda plan, at: select(Settings, plan.at(at.case)),
        kind=Settings,
        complete=corrections.with_correction,
        compute=compute,
        message="Force curves of {case}, {model} (Sec. III-B1).",
    ),
)
