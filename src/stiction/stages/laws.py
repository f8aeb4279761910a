"""Force laws from datasets: the way back from the files of stage chaos."""

from stiction.chaos.model import ChaosModel, PrincipalCoordinates


def chaos_model(dataset):
    """Chaos model from the dataset of stage chaos."""
    coordinates = PrincipalCoordinates(*(dataset[name].values for name in ("scale", "mean", "variance", "axes")))
    return ChaosModel(coordinates, dataset.coefficient.values, dataset.multi_index.values, float(dataset.limit))
