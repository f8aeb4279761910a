"""Files of a finished run, as people and programs read them that know nothing of this package."""

import numpy as np
import pytest
import xarray as xr
from conventions import faults

import stiction


def files(folder, stage):
    """Files of a stage in the results of a run."""
    return sorted((folder / "results" / stage).glob("*.nc"))


def test_all_files_follow_the_conventions(smoke):
    paths = sorted((smoke / "results").rglob("*.nc"))
    assert len({path.parent for path in paths}) > 10
    assert {path.name: found for path in paths if (found := faults(path))} == {}


def test_joined_files_keep_their_pair_humidity_and_model(smoke):
    joined = [xr.load_dataset(path) for path in files(smoke, "beams")]
    found = xr.concat([one[["crack_length"]] for one in joined], "case", coords=["pair", "relative_humidity", "model"])
    names = zip(found.pair.values, found.relative_humidity.values, found.model.values, strict=True)
    cases = [f"{stiction.case_id(str(pair), float(humidity))}_{model}" for pair, humidity, model in names]
    assert cases == [path.stem for path in files(smoke, "beams")]


def test_strips_and_beams_of_a_case_merge(smoke):
    parts = [xr.load_dataset(smoke / "results" / stage / "b_rh067_NG.nc") for stage in ("forces", "beams")]
    merged = xr.merge(parts, compat="no_conflicts", combine_attrs="drop", join="exact")
    assert merged.adhesion_energy.dims == ("strip",)
    assert merged.apparent_energy.dims == ("beam",)
    assert merged.deflection.dims == ("shape", "node")


@pytest.mark.parametrize("stage", ["beams", "forces", "chaos", "contact", "heights", "character", "fit"])
def test_the_tree_has_the_numbers_of_every_file(smoke, stage):
    node = stiction.open(smoke / "results")[stage].dataset
    for path in files(smoke, stage):
        dataset = xr.load_dataset(path)  # closed: the library crashes where one file is open twice
        axes = {axis: dataset[axis].item() for axis in node.dims if axis in dataset.coords and not dataset[axis].ndim}
        place = node.sel(axes)
        for name, values in dataset.data_vars.items():
            part = place[name].values[tuple(map(slice, values.shape))]
            np.testing.assert_array_equal(part, values.values, err_msg=f"{name} of {path.name}")
