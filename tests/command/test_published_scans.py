"""Containers written by SurfaceTopography, unpacked into scans: every map, its undefined points, no profile."""

from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
import yaml
from server import OK, page, server
from topographies import SurfaceTopography

from stiction.command import main, published
from stiction.command.last_lines import Status
from stiction.command.launch import RefusedError
from stiction.config import files
from stiction.config.messages import schema_problems
from stiction.config.relations import schema
from stiction.scans.published import unpack
from stiction.scans.reading import read
from stiction.streams import stream

#: Heights [µm] of a map of 6 x 4 µm, one of them undefined.
HEIGHTS = np.ma.masked_array(3e-3 * stream(1, "published").standard_normal((60, 40)), mask=False)
HEIGHTS[3, 4] = np.ma.masked
SIZE = (6.0, 4.0)


def map_of(factor=1.0, **info):
    return SurfaceTopography.Topography(factor * HEIGHTS, SIZE, unit="µm", info=info)


def container(path, surfaces):
    """Container of surfaces by name, each a list of measurements. The library leaves files open where it writes one."""
    described, files = [], {}
    for name, measurements in surfaces.items():
        about = []
        for measurement in measurements:
            stored = path.with_name(f"measurement_{len(files)}.nc")
            measurement.to_netcdf(str(stored))
            files[stored.name] = stored.read_bytes()
            stored.unlink()
            sizes = {"size": list(measurement.physical_sizes), "unit": "µm"}
            title = measurement.info.get("name", stored.stem)
            about.append({"name": title, "datafile": {"squeezed-netcdf": stored.name}} | sizes)
        described.append({"name": name, "topographies": about})
    with ZipFile(path, "w") as archive:
        archive.writestr("meta.yml", yaml.safe_dump({"surfaces": described}))
        for name, content in files.items():
            archive.writestr(name, content)
    return str(path)


@pytest.fixture
def two(tmp_path):
    line = SurfaceTopography.UniformLineScan(np.ravel(HEIGHTS[5]), 4.0, unit="µm", info={"name": "a line"})
    surfaces = {"Etched Si (100)": [map_of(name="first"), line, map_of(2.0, name="third")], "7 nm": [map_of(3.0)]}
    return container(tmp_path / "two.zip", surfaces)


def test_every_map_is_read_back_with_its_undefined_points(tmp_path, two):
    etched, other = unpack(Path(two).read_bytes(), two, tmp_path)
    assert (etched.name, etched.files) == ("Etched_Si_100", ("Etched_Si_100_1.nc", "Etched_Si_100_3.nc"))
    assert etched.left_out == ("a line is not used: it is no map of equal distances",)
    assert (other.name, other.left_out) == ("Surface_7_nm", ())
    for file, factor in zip((*etched.files, *other.files), (1, 2, 3), strict=True):
        scan = read(tmp_path / file).scan
        expected = np.ma.filled(factor * 1e-6 * HEIGHTS, np.nan)
        np.testing.assert_allclose(scan.heights - np.nanmean(scan.heights), expected - np.nanmean(expected), atol=1e-15)
        np.testing.assert_allclose(scan.size, [6e-6, 4e-6], rtol=1e-7)


def test_filled_points_of_a_map_are_told(tmp_path, two):
    with ZipFile(two) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    about = yaml.safe_load(content["meta.yml"])
    about["surfaces"][1]["topographies"][0]["fill_undefined_data_mode"] = "harmonic"
    with ZipFile(two, "w") as archive:
        for name, text in (content | {"meta.yml": yaml.safe_dump(about)}).items():
            archive.writestr(name, text)
    *_, filled = unpack(Path(two).read_bytes(), two, tmp_path)
    assert filled.left_out == ("measurement_3 has filled gaps (harmonic), which count as measured",)


def test_surfaces_of_equal_names_become_different_keys():
    from stiction.scans.published import _key

    names = []
    for name in ("dry", "dry_1", "ä", "x" * 40, "x" * 40, ""):
        names.append(_key(name, names))
    assert len(set(names)) == len(names)
    faults = schema_problems({"surfaces": {name: {"scans": {"files": ["x"]}} for name in names}}, schema())
    assert not [fault for fault in faults if fault.path[:1] == ("surfaces",)]


def test_the_study_names_the_scans_and_can_be_checked(tmp_path, two, capsys):
    assert main.main(["published", two, "--directory", str(tmp_path / "new")]) == Status.DONE
    assert "stiction scans" in capsys.readouterr().out
    study = yaml.safe_load((tmp_path / "new" / "published.yaml").read_text())
    assert list(study["surfaces"]) == ["Etched_Si_100", "Surface_7_nm"]
    config = files.joined(str(tmp_path / "new" / "published.yaml"))
    assert not schema_problems(config, schema())
    assert config["surfaces"]["Surface_7_nm"]["scans"]["files"] == [str(tmp_path / "new" / "Surface_7_nm_1.nc")]


def test_a_published_container_is_fetched_by_its_address(tmp_path, two, monkeypatch):
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    content = (tmp_path / "two.zip").read_bytes()
    with server(lambda request: page(request) or request.wfile.write(OK + content)) as address:
        published.written(address, tmp_path / "fetched")
    published.written(two, tmp_path / "read")
    fetched, stored = (maps_in(tmp_path / name) for name in ("fetched", "read"))
    assert fetched == stored
    assert len(stored) == 3


def maps_in(folder):
    """Content of all maps of a folder, by name."""
    return {path.name: path.read_bytes() for path in folder.glob("*.nc")}


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("missing.zip", "does not exist; give a container file, a DOI, or the address of its page"),
        ("text.zip", "is no container of contact.engineering, or damaged"),
        ("lines.zip", "holds no map of heights"),
        ("http://127.0.0.1:9/go/abc", "cannot be fetched"),
    ],
)
def test_other_sources_are_refused_in_one_sentence(tmp_path, source, said):
    (tmp_path / "text.zip").write_text("1 2 3")
    container(tmp_path / "lines.zip", {"Line": [SurfaceTopography.UniformLineScan(np.zeros(9), 1.0, unit="µm")]})
    with pytest.raises(RefusedError, match=said) as refusal:
        published.written(source if ":" in source else str(tmp_path / source), tmp_path)
    assert "\n" not in str(refusal.value)


def test_nothing_is_written_over(tmp_path, two):
    (tmp_path / "Surface_7_nm_1.nc").write_text("mine")
    with pytest.raises(RefusedError, match="Surface_7_nm_1.nc exists already: nothing was written"):
        published.written(two, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["Surface_7_nm_1.nc", "two.zip"]
