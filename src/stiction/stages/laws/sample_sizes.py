"""Study sample_sizes (App. B, Fig. 17a): convergence of the density of the adhesion energy in the number of samples."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from stiction.analysis import convergence
from stiction.plan.stage import Stage
from stiction.stages.laws import forces as stage_forces

#: Number of energies at which the density is given.
_POINTS = 200


def compute(forces: xr.Dataset, shares: Sequence[float]) -> xr.Dataset:
    """Compare the first samples, shares of all, with all samples: densities of ē and Kolmogorov distances."""
    energies = stage_forces.energies(forces)
    at = np.linspace(0, 1.2 * energies.max(), _POINTS)
    sizes = sorted({max(2, round(share * len(energies))) for share in shares} | {len(energies)})
    density = [convergence.kernel_estimate(energies[:size], at) for size in sizes]
    distances = [convergence.distance_of_parts(energies, size) for size in sizes]
    return layout(at, density, sizes, distances)


def layout(energy: np.ndarray, density: Sequence, sizes: Sequence[int], distances: Sequence) -> xr.Dataset:
    """Convergence of the density of ē in the number of samples.

    Densities (n_m, n_e) [m² J⁻¹] at energies (n_e,) [J m⁻²] for numbers of samples (n_m,), and their Kolmogorov
    distance to that of all samples with its standard error (n_m, 2) [-].
    """
    values, errors = np.transpose(distances)
    return xr.Dataset(
        {
            "density": (("size", "energy"), density),
            "distance": ("size", values),
            "distance_error": ("size", errors),
        },
        coords={"size": list(sizes), "energy": ("energy", energy)},
    )


STAGES = (
    Stage.writing(
        "sample_sizes",
        "studies/sample_sizes",
        inputs=lambda plan, at: {"forces": f"forces/{plan.figure_case}_NG"},
        settings=lambda plan, at: {"shares": plan.config["studies"]["sample_shares"], "case": plan.figure_case},
        compute=compute,
        message="Convergence of the adhesion energy in the number of samples (App. B).",
    ),
)
