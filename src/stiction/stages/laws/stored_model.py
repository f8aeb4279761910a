"""Chaos models in datasets: variables of a model, and the model of a dataset."""

import xarray as xr

from stiction.chaos.coordinates import PrincipalCoordinates
from stiction.chaos.model import ChaosModel


def model_variables(model: ChaosModel) -> dict[str, tuple]:
    """Variables of a dataset with a chaos model."""
    coordinates = model.coordinates
    return {
        "coefficient": (("eta", "term"), model.coefficients),
        "multi_index": (("term", "eta"), model.indices),
        "scale": ("component", coordinates.scale),
        "mean": ("component", coordinates.mean),
        "variance": ("axis", coordinates.variances),
        "axes": (("component", "axis"), coordinates.axes),
        "limit": ((), model.f_limit),
    }


def chaos_model(dataset: xr.Dataset) -> ChaosModel:
    """Chaos model from its dataset. It can draw force laws."""
    coordinates = PrincipalCoordinates(*(dataset[name].values for name in ("scale", "mean", "variance", "axes")))
    return ChaosModel(coordinates, dataset.coefficient.values, dataset.multi_index.values, float(dataset.limit))
