import os

import numpy as np
import pytest
import xarray as xr

from stiction.stages import data


def dataset():
    return xr.Dataset({"x": ("sample", np.linspace(0, 1, 20_000), {"units": "m"})})


def test_a_dataset_survives_the_file_with_its_settings(tmp_path):
    data.save(dataset(), tmp_path / "x.nc", "forces", {"seed": 1, "water": {"temperature_K": 300}})
    loaded = data.load(tmp_path / "x.nc", "forces")
    np.testing.assert_array_equal(loaded.x, dataset().x)
    assert loaded.attrs["settings"] == '{"seed": 1, "water": {"temperature_K": 300}}'


def test_equal_data_give_equal_bytes(tmp_path):
    for name, settings in (("one", {"b": 1, "a": 2}), ("two", {"a": 2, "b": 1})):
        data.save(dataset(), tmp_path / name / "a.nc", "forces", settings)
    assert (tmp_path / "one" / "a.nc").read_bytes() == (tmp_path / "two" / "a.nc").read_bytes()


def test_a_file_of_another_stage_is_refused_by_name(tmp_path):
    data.save(dataset(), tmp_path / "x.nc", "forces", {})
    with pytest.raises(data.DataError, match=r"x\.nc holds forces of x, not beams of x"):
        data.load(tmp_path / "x.nc", "beams")


def test_a_file_of_another_case_is_refused_by_name(tmp_path):
    data.save(dataset(), tmp_path / "b_rh067_NG.nc", "forces", {})
    (tmp_path / "b_rh067_NG.nc").rename(tmp_path / "b_rh088_NG.nc")
    with pytest.raises(data.DataError, match=r"holds forces of b_rh067_NG, not forces of b_rh088_NG"):
        data.load(tmp_path / "b_rh088_NG.nc", "forces")


@pytest.mark.parametrize("size", [0, 100, 5000])
def test_a_truncated_file_is_refused_by_name(tmp_path, size):
    data.save(dataset(), tmp_path / "x.nc", "forces", {})
    whole = (tmp_path / "x.nc").read_bytes()
    assert len(whole) > 5000
    (tmp_path / "x.nc").write_bytes(whole[:size])
    with pytest.raises(data.DataError, match=r"x\.nc cannot be read"):
        data.load(tmp_path / "x.nc", "forces")


def test_a_foreign_file_is_refused(tmp_path):
    dataset().to_netcdf(tmp_path / "x.nc")
    with pytest.raises(data.DataError, match="no result of this study"):
        data.load(tmp_path / "x.nc", "forces")


def test_a_failed_write_leaves_the_old_file_and_no_draft(tmp_path):
    data.save(dataset(), tmp_path / "x.nc", "forces", {})
    before = (tmp_path / "x.nc").read_bytes()
    unwritable = xr.Dataset({"x": ("sample", np.array([object()], object))})
    with pytest.raises((TypeError, ValueError)):
        data.save(unwritable, tmp_path / "x.nc", "forces", {})
    assert (tmp_path / "x.nc").read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["x.nc"]


def test_a_folder_that_cannot_be_is_named(tmp_path):
    (tmp_path / "results").write_text("mine")  # stops root as well, whom permissions do not
    with pytest.raises(data.DataError, match=r"folder .*results cannot be written .*; make it writable"):
        data.save(dataset(), tmp_path / "results" / "x.nc", "forces", {})


def test_a_disk_that_fails_at_the_last_moment_leaves_no_draft(tmp_path, monkeypatch):
    def fail(_):
        raise OSError("input/output error")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(data.DataError, match=r"x\.txt cannot be written \(input/output error\)"):
        data.save_text("Δ", tmp_path / "x.txt")
    assert not list(tmp_path.iterdir())


def test_files_have_the_permissions_that_the_user_gives_all_files(tmp_path):
    before = os.umask(0o027)
    try:
        data.save(dataset(), tmp_path / "x.nc", "forces", {})
        data.save_text("Δ", tmp_path / "x.txt")
    finally:
        os.umask(before)
    assert {path.stat().st_mode & 0o777 for path in tmp_path.iterdir()} == {0o640}
    assert (tmp_path / "x.txt").read_bytes() == b"\xce\x94"


def test_end_states_are_those_of_the_beam():
    from stiction.beam.cantilever import EndState

    assert [state.name.lower().replace("_", "-") for state in EndState] == [s.lower() for s in data.STATES]
