"""Study orders (App. B, Fig. 18): order of the polynomials for a converged chaos model."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

from stiction.analysis import convergence
from stiction.chaos import density
from stiction.chaos.model import truncated
from stiction.plan.stage import Running, Stage
from stiction.progress import progress
from stiction.stages.laws.forces import vectors
from stiction.stages.laws.stored_model import chaos_model
from stiction.streams import stream

#: Bins of the marginal densities.
_EDGES = np.linspace(-4, 4, 65)


def compute(forces: xr.Dataset, chaos: xr.Dataset, seed: int, draws: int, case: str) -> xr.Dataset:
    """Draw from the model truncated at each order. Compare the marginals with the kernel density and the samples.

    Returns
    -------
    Dataset
        Marginals of η drawn with orders 1 ... N_d, and their Kolmogorov distances.
    """
    fitted = chaos_model(chaos)
    eta = fitted.coordinates.reduce(vectors(forces)[0])[:, : fitted.dimension]
    kernels = density.kernel_density(eta)
    targets = [convergence.kernel_distribution(centres, kernels.bandwidth) for centres in kernels.centres]
    histogram = partial(np.histogram, bins=_EDGES, density=True)
    orders, densities, distances = range(1, fitted.order + 1), [], []
    for order in progress(orders, "orders"):
        xi = stream(seed, "orders", case).random((draws, fitted.dimension))
        sample = truncated(fitted, order)(xi)
        densities.append([histogram(column)[0] for column in sample.T])
        to_kernels = [convergence.distance_to(column, target) for column, target in zip(sample.T, targets, strict=True)]
        distances.append((to_kernels, list(map(convergence.distance_between, sample.T, eta.T))))
    distances = np.swapaxes(distances, 0, 1)
    sizes = len(eta), draws
    converged = [convergence.converged_order(orders, column, *sizes) for column in distances[0].T]
    of_input = [histogram(column)[0] for column in eta.T]
    return layout(_EDGES, of_input, densities, distances, sizes, converged)


def layout(
    edges: np.ndarray,
    input_density: Sequence,
    densities: Sequence,
    distances: np.ndarray,
    sizes: tuple[int, int],
    converged: Sequence[int],
) -> xr.Dataset:
    """Marginals of η drawn from polynomials of increasing order.

    Edges of the bins (n + 1,), marginal densities of the samples (N_g, n) and of the draws for orders 1 ... N_d (N_d,
    N_g, n), Kolmogorov distances of the draws to the kernel density and to the samples (2, N_d, N_g) [-]; numbers of
    samples and of draws; lowest order from which on a marginal is indistinguishable from the kernel density with as
    many draws as samples, 0 if none (N_g,).
    """
    count = len(densities)
    return xr.Dataset(
        {
            "density": (("order", "eta", "position"), densities),
            "input_density": (("eta", "position"), input_density),
            "distance": (("target", "order", "eta"), distances),
            "samples": ((), sizes[0]),
            "draws": ((), sizes[1]),
            "converged_order": ("eta", list(converged)),
        },
        coords={
            "order": np.arange(1, count + 1),
            "eta": np.arange(1, len(input_density) + 1),
            "target": ["kernels", "input"],
            "position": 0.5 * (edges[1:] + edges[:-1]),
        },
    )


STAGES = (
    Stage.writing(
        "orders",
        "studies/orders",
        inputs=lambda plan, at: {stage: f"{stage}/{plan.figure_case}_NG" for stage in ("forces", "chaos")},
        settings=lambda plan, at: {
            "seed": plan.config["seed"],
            "draws": plan.config["studies"]["orders"]["draws"],
            "case": plan.figure_case,
        },
        compute=compute,
        message="Convergence of the chaos model in the order of its polynomials (App. B).",
        running=Running(minutes=10),
    ),
)
