"""Files of earlier runs: those of other settings and damaged ones are recognised, all others are not."""

import json
import os
import re
from pathlib import Path
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
import xarray as xr

from stiction.run import labels, stale_results, storage
from stiction.run.atomic import DataError
from stiction.run.disk_cache import DiskCache
from stiction.run.logs import checksum, logged, note_origin, recorded_checksums

HEIGHTS, SPECTRUM = {"rms_nm": 3.4, "kurtosis": 3.9}, {"spacing_nm": 7.5, "psd": {"floor_nm4": 0.8}}


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Settings of two datasets, of which one depends on the other, by file."""
    monkeypatch.chdir(tmp_path)
    wanted = {"heights/B2.nc": HEIGHTS, "spectrum/B2.nc": SPECTRUM}
    storage.save(xr.Dataset(), "heights/B2.nc", "heights", HEIGHTS)
    storage.save(xr.Dataset(), "spectrum/B2.nc", "spectrum", SPECTRUM, ["heights/B2.nc"])
    return wanted


def reasons(wanted, **changed):
    """Files that a run with these settings cannot use; a plan knows the labels that those before it have read."""
    remember = DiskCache("labels.json")
    found = dict(stale_results.foreign(["heights/B2.nc", "spectrum/B2.nc"], (wanted | changed).get, remember))
    remember.save()
    return found


def damaged():
    """Files that are not as their jobs wrote them; a plan knows the checksums that those before it have computed."""
    remember = DiskCache("labels.json")
    found = dict(stale_results.damaged("logs", remember))
    remember.save()
    return found


def rule(pattern, settings):
    """A rule with one output, as Snakemake describes it."""
    return SimpleNamespace(output=[re.compile(pattern)], params=SimpleNamespace(settings=settings))


def test_the_label_of_an_unchanged_file_is_read_once(files, monkeypatch):
    assert reasons(files) == {}
    read, seen = labels.read, []
    monkeypatch.setattr(labels, "read", lambda path: seen.append(path) or read(path))
    assert reasons(files) == {}
    assert not seen
    storage.save(xr.Dataset(), "heights/B2.nc", "heights", HEIGHTS)
    assert reasons(files) == {}
    assert [path.as_posix() for path in seen] == ["heights/B2.nc"], "its time is another"


def test_a_changed_file_of_the_same_size_and_time_is_read_again(files):
    assert reasons(files) == {}
    path = Path("heights/B2.nc")
    times = path.stat()
    other = path.read_bytes().replace(b"3.4", b"3.5")
    assert len(other) == times.st_size
    path.write_bytes(other)
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert path.stat().st_mtime_ns == times.st_mtime_ns
    assert reasons(files) == {"heights/B2.nc": "cannot be read"}, "its format has a checksum"


def test_a_dataset_names_the_settings_of_all_stages_before(files):
    storage.save(xr.Dataset(), "contact/b_NG.nc", "contact", {"samples": 9}, ["spectrum/B2.nc"])
    assert labels.read("contact/b_NG.nc").before == files


def test_a_file_that_is_no_dataset_is_reported_with_the_remedy(tmp_path):
    path = tmp_path / "heights.nc"
    path.write_bytes(b"no dataset")
    with pytest.raises(DataError, match="heights.nc cannot be read .*; delete it and start again"):
        labels.read(path)


def test_the_order_of_keys_does_not_change_a_label():
    one, other = ({"b": 1, "a": {"d": 1, "c": 2}}, {"a": {"c": 2, "d": 1}, "b": 1})
    labelled = [labels.DatasetLabel("s", "x", settings, {"f": settings}).attributes for settings in (one, other)]
    assert labelled[0] == labelled[1]


@pytest.mark.usefixtures("files")
def test_chunks_of_a_dataset_are_not_listed():
    for chunk in ("0-of-2", "1-of-2"):
        storage.save(xr.Dataset(), f"contact/{chunk}.nc", "contact", {"samples": 9}, ["heights/B2.nc"])
    storage.save(xr.Dataset(), "contact/b.nc", "contact", {"samples": 9}, ["contact/0-of-2.nc", "contact/1-of-2.nc"])
    assert labels.read("contact/b.nc").before == {"heights/B2.nc": HEIGHTS}


def test_datasets_of_the_same_settings_are_used(files):
    assert reasons(files) == {}
    assert reasons({}) == {}, "not files of this run"


@pytest.mark.usefixtures("files")
def test_lists_and_tuples_are_the_same_setting():
    storage.save(xr.Dataset(), "heights/B2.nc", "heights", {"at": (1, [2.0, (3,)])})
    assert reasons({"heights/B2.nc": {"at": [1, (2, [3])]}}) == {}
    assert reasons({"heights/B2.nc": {"at": [1, [2, [4]]]}}) != {}


@pytest.mark.parametrize(
    ("other", "difference"),
    [
        ({"rms_nm": 3.4, "kurtosis": 4.6}, "kurtosis: 3.9 instead of 4.6"),
        ({"rms_nm": 3.4}, "kurtosis: 3.9 instead of nothing"),
        ({"rms_nm": 3.4, "kurtosis": 3.9, "skewness": 0}, "skewness: nothing instead of 0"),
    ],
)
def test_other_settings_are_named_here_and_in_all_that_depends_on_them(files, other, difference):
    found = reasons(files, **{"heights/B2.nc": other})
    assert found["heights/B2.nc"] == f"was computed with {difference}"
    assert found["spectrum/B2.nc"] == f"depends on heights/B2.nc with {difference}"


def test_the_key_of_a_section_is_named_with_its_section(files):
    other = {"spacing_nm": 7.5, "psd": {"floor_nm4": 0.9}}
    assert reasons(files, **{"spectrum/B2.nc": other}) == {
        "spectrum/B2.nc": "was computed with psd.floor_nm4: 0.8 instead of 0.9"
    }
    assert "psd: {'floor_nm4': 0.8} instead of identified" in str(
        reasons(files, **{"spectrum/B2.nc": SPECTRUM | {"psd": "identified"}})
    )


@pytest.mark.usefixtures("files")
def test_a_dataset_that_depends_on_what_this_run_does_not_compute_is_not_used():
    assert "depends on heights/B2.nc" in str(reasons({"spectrum/B2.nc": SPECTRUM}))


def test_files_of_another_name_without_a_label_or_cut_off_are_not_used(files, tmp_path):
    other = tmp_path / "heights" / "Sub1.nc"
    (tmp_path / "heights" / "B2.nc").rename(other)
    assert reasons({}, **{"heights/B2.nc": HEIGHTS}) == {"heights/B2.nc": "cannot be read"}
    wanted = {"heights/Sub1.nc": HEIGHTS}
    assert dict(stale_results.foreign([other.relative_to(tmp_path)], wanted.get, DiskCache("none.json"))) == {
        "heights/Sub1.nc": "holds heights of B2"
    }
    xr.Dataset().to_netcdf("heights/B2.nc")
    assert reasons(files)["heights/B2.nc"] == "holds no result of this study"
    whole = (tmp_path / "spectrum" / "B2.nc").read_bytes()
    (tmp_path / "spectrum" / "B2.nc").write_bytes(whole[:-1])
    assert reasons(files)["spectrum/B2.nc"] == "cannot be read"


def test_a_changed_label_is_recognised_whatever_the_numbers(files):
    with netCDF4.Dataset("spectrum/B2.nc", "r+") as file:
        file.setncattr("before", json.dumps({"heights/B2.nc": HEIGHTS | {"rms_nm": 3.5}}))
    assert set(reasons(files)) == {"spectrum/B2.nc"}


@pytest.mark.parametrize("kind", ["csv", "md", "html", "png", "pdf"])
def test_a_result_that_was_cut_off_or_changed_after_its_job_is_recognised(tmp_path, monkeypatch, kind):
    monkeypatch.chdir(tmp_path)
    result, other = tmp_path / f"table 1.{kind}", tmp_path / f"other.{kind}"
    with logged("logs/tables/table_1.log", [result.name, other.name]):
        result.write_bytes(b"a,b\n1,2\n3,4\n")
        other.write_bytes(b"a,b\n")
    assert set(recorded_checksums("logs")) == {result.name, other.name}
    assert damaged() == {}
    for content in (b"a,b\n1,2\n", b"", b"a,b\n1,2\n3,5\n"):
        result.write_bytes(content)
        assert damaged() == {result.name: "is not as its job wrote it"}
    result.unlink()
    assert damaged() == {}, "Snakemake sees that a file is missing"


#: Where a byte of a dataset is flipped: in its numbers, as a share of their length.
PLACES = [0.0, 0.3, 0.999]


@pytest.mark.parametrize("place", PLACES)
def test_a_byte_of_a_dataset_that_changed_at_the_same_time_and_size_is_noticed(tmp_path, monkeypatch, place):
    monkeypatch.chdir(tmp_path)
    path, numbers = Path("forces/b.nc"), np.linspace(1, 2, 500)
    with logged("logs/forces/b.log", [path]):
        storage.save(xr.Dataset({"force": ("sample", numbers)}), path, "forces", {"samples": 500})
    assert damaged() == {}
    before, content = path.stat(), bytearray(path.read_bytes())
    content[content.index(numbers.tobytes()) + int(place * numbers.nbytes)] ^= 1
    path.write_bytes(content)
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert path.stat().st_mtime_ns == before.st_mtime_ns
    assert reasons_of(path) == {}, "neither format nor label show it"
    assert not np.array_equal(storage.load(path, "forces").force, numbers), "it would be used"
    assert damaged() == {"forces/b.nc": "is not as its job wrote it"}


def reasons_of(path):
    """Whether labels alone refuse a dataset with its own settings."""
    settings = {path.as_posix(): labels.read(path).settings}
    return dict(stale_results.foreign([path], settings.get, DiskCache("none.json")))


def test_the_checksum_of_an_unchanged_file_is_computed_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with logged("logs/x.log", ["x.csv"]):
        Path("x.csv").write_text("1")
    seen = []
    monkeypatch.setattr(stale_results, "checksum", lambda path: seen.append(path) or checksum(path))
    assert damaged() == damaged() == {}
    assert seen == [Path("x.csv")]
    Path("x.csv").write_text("2")
    assert damaged() != {}
    assert len(seen) == 2


def test_a_failed_job_records_no_checksum(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit), logged("logs/x.log", ["x.csv"]):
        raise ValueError
    assert recorded_checksums("logs") == {}


def test_the_summary_has_one_line_per_folder():
    found = {"a/z.nc": "cannot be read", "a/b/1.nc": "is foreign", "a/1.nc": "holds forces", "a/a.nc": "cannot be read"}
    assert list(stale_results.summary(found)) == [
        "a/1.nc holds forces; this run does not use it (nor 2 more of this folder).",
        "a/b/1.nc is foreign; this run does not use it.",
    ]


def test_results_without_a_label_are_judged_by_the_origin_in_their_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, written in (("a.md", "1"), ("b.md", "2"), ("c.md", None), ("gone.md", "1"), ("unknown.md", "1")):
        Path(name).touch()
        with logged(f"logs/{name}.log", [name]):
            if written:
                note_origin(written * 64)
    Path("gone.md").unlink()
    expected = dict.fromkeys(["a.md", "b.md", "c.md", "gone.md"], "1" * 64).get
    assert dict(stale_results.made_otherwise("logs", expected)) == {"b.md": "was made with other settings"}
