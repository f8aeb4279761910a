"""`stiction.open`: the tree has the numbers of all files at their places, and reads them when they are used."""

import numpy as np
import pytest
import xarray as xr

import stiction
from stiction.plan.stage import At
from stiction.run import opened, storage
from stiction.run.atomic import DataError

#: Pair, humidity, model and number of points of each file; two combinations have none.
FILES = [("a", 0.45, "G", 3), ("a", 0.45, "NG", 4), ("a", 0.67, "NG", 5), ("b", 0.67, "G", 2), ("b", 0.45, "NG", 5)]
FILES += [("b", 0.67, "NG", 1)]


def forces(points, rng):
    """A dataset like that of stage forces, with as many distances as there are points."""
    return xr.Dataset(
        {
            "adhesion_energy": ("strip", rng.random(4)),
            "force": (("curve", "distance"), rng.random((2, points)).astype(np.float32)),
            "limit": float(rng.random()),
        },
        coords={"strip": np.arange(4), "distance": rng.random(points)},
    )


@pytest.fixture(autouse=True)
def written(tmp_path):
    """Datasets of all files by pair, humidity and model, in a folder of results with files that nothing tells apart."""
    rng, made = np.random.default_rng(1), {}
    for pair, humidity, model, points in FILES:
        at = At(case=stiction.case_id(pair, humidity), model=model)
        made[pair, humidity, model] = forces(points, rng).assign_coords(at.identity)
        storage.save(made[pair, humidity, model], tmp_path / f"forces/{at.case}_{model}.nc", "forces", {})
    for name in ("b_rms", "b_skewness"):
        dataset = xr.Dataset({"slope": ("humidity", [1.0, 2.0])}, {"humidity": [0.4, 0.5], "pair": "b"})
        storage.save(dataset, tmp_path / f"studies/sensitivity/{name}.nc", "sensitivity", {})
    return made


def test_every_number_is_at_its_place_and_missing_files_are_nan(tmp_path, written):
    tree = stiction.open(tmp_path)
    node = tree["forces"].dataset
    assert node.adhesion_energy.dims == ("pair", "relative_humidity", "model", "strip")
    for pair, humidity, model in np.ndindex(2, 2, 2):
        place = node.isel(pair=pair, relative_humidity=humidity, model=model)
        found = written.get((str(place.pair.values), float(place.relative_humidity), str(place.model.values)))
        if found is None:
            assert np.isnan(place.adhesion_energy).all()
            assert np.isnan(place.limit)
        else:
            for name in ("adhesion_energy", "limit"):
                np.testing.assert_array_equal(place[name], found[name])
            points = found.sizes["distance"]
            np.testing.assert_array_equal(place.force[:, :points], found.force)
            np.testing.assert_array_equal(place.distance[:points], found.distance)
            assert np.isnan(place.force[:, points:]).all()
            assert np.isnan(place.distance[points:]).all()


def test_parts_are_those_of_the_whole(tmp_path):
    force = stiction.open(tmp_path)["forces"].force
    whole = force.values
    for key in [
        np.s_[1, 0],
        np.s_[:, 1, ::-1],
        np.s_[0, [1, 0, 1], 1:, :, 2],
        np.s_[..., [3, 0]],
        np.s_[1, 1, 1, 0, 0],
    ]:
        parts = key if isinstance(key, tuple) else (key,)
        lazy = stiction.open(tmp_path)["forces"].force[parts]
        np.testing.assert_array_equal(lazy.values, force.copy(data=whole)[parts].values)


def test_opening_reads_no_numbers_and_a_part_reads_only_its_files(tmp_path, monkeypatch):
    read, part = [], opened._Joined._filled
    monkeypatch.setattr(
        opened._Joined, "_filled", lambda self, path: read.append((self.name, path)) or part(self, path)
    )
    energies = stiction.open(tmp_path)["forces"].adhesion_energy
    assert read == []
    energies.sel(pair="b", relative_humidity=0.45, model="NG").load()
    assert {path.stem for _, path in read} == {"b_rh045_NG"}


def test_units_and_titles_are_those_of_the_files(tmp_path):
    node = stiction.open(tmp_path)["forces"]
    assert node.adhesion_energy.attrs["units"] == "J m-2"
    assert node.attrs["title"] == storage.load(tmp_path / "forces/b_rh067_G.nc", "forces").attrs["title"]
    assert set(node.attrs) == {"title", "Conventions", "source", "references"}


def test_files_that_nothing_tells_apart_are_nodes_of_their_own(tmp_path):
    tree = stiction.open(tmp_path)
    assert tree["studies/sensitivity/b_rms"].slope.values.tolist() == [1.0, 2.0]
    assert {node.name for node in tree["studies/sensitivity"].children.values()} == {"b_rms", "b_skewness"}


def test_an_empty_folder_is_one_sentence(tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(DataError, match="holds no datasets; give the folder results of a finished run"):
        stiction.open(tmp_path / "empty")


def test_a_folder_of_another_version_or_program_is_one_sentence(tmp_path):
    path = tmp_path / "forces/b_rh067_G.nc"
    old = xr.load_dataset(path)
    for attributes, message in (({"stage": "forces", "name": "b_rh067_G"}, "another version"), ({}, "another program")):
        old.drop_attrs().assign_attrs(attributes).to_netcdf(path)
        with pytest.raises(DataError, match=rf"b_rh067_G\.nc was written by {message}; give"):
            stiction.open(tmp_path)


def test_a_damaged_file_is_one_sentence(tmp_path):
    path = tmp_path / "forces/b_rh067_G.nc"
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(DataError, match=r"b_rh067_G\.nc cannot be read .*; delete it and start again"):
        stiction.open(tmp_path)
