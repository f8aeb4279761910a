"""What a file may reach: only its own values, and no more of them than a scan has."""

import gzip
import io
import os
import time
import zipfile
import zlib

import numpy as np
import pytest
from test_formats import HEIGHTS, surf

from stiction.errors import ScanError
from stiction.formats import limits, packed
from stiction.scans.reading import Source, read

pytest.importorskip("SurfaceTopography")
h5py = pytest.importorskip("h5py")
GIVEN = Source(size=(6.4e-6, 4e-6), height_unit="nm")
Z = HEIGHTS / 1e-9


def external(file, secret):
    file.create_dataset("z", shape=Z.shape, dtype="f8", external=[(str(secret), 0, h5py.h5f.UNLIMITED)])


def linked(file, secret):
    file["z"] = h5py.ExternalLink(str(secret), "/z")


def behind_a_group(file, secret):
    file["group/z"] = h5py.ExternalLink(str(secret), "/z")
    file["z"] = h5py.SoftLink("/group/z")


def virtual(file, secret):
    layout = h5py.VirtualLayout(Z.shape, "f8")
    layout[:] = h5py.VirtualSource(str(secret), "z", Z.shape)
    file.create_virtual_dataset("z", layout)


@pytest.mark.parametrize("ending", ["h5", "nc", "mat", "datx", "h5-jpk"])
@pytest.mark.parametrize("kind", [external, linked, behind_a_group, virtual])
def test_heights_in_another_file_are_refused_and_this_is_never_opened(tmp_path, kind, ending):
    os.mkfifo(tmp_path / "secret")  # whoever opens it waits without end
    with h5py.File(tmp_path / f"scan.{ending}", "w", userblock_size=512 if ending == "mat" else 0) as file:
        kind(file, tmp_path / "secret")
    with pytest.raises(ScanError, match=r"keeps (group/)?z in another file: save all values in one"):
        read(tmp_path / f"scan.{ending}", GIVEN)


def test_links_within_a_file_are_no_links_to_others(tmp_path):
    with h5py.File(tmp_path / "scan.h5", "w") as file:
        file["z"] = Z
        file["again"], file["nowhere"], file["group/loop"] = h5py.SoftLink("/z"), h5py.SoftLink("/none"), file["/"]
    found = read(tmp_path / "scan.h5", Source(channel="z", size=GIVEN.size, height_unit="nm"))
    np.testing.assert_allclose(found.scan.heights, HEIGHTS)


def bomb(size):
    """Zeros packed to a thousandth of their size."""
    return gzip.compress(bytes(size))


def nested(times):
    content = b"1 2 3\n" * 9
    for _ in range(times):
        content = gzip.compress(content)
    return content


PACKED = {
    "gz": bomb,
    "gz of two streams": lambda size: bomb(size // 2 + 1) * 2,
    "zip": lambda size: deflated({"scan.txt": bytes(size)}),
    "zip of many": lambda size: deflated({f"{k}.txt": bytes(size // 4 + 1) for k in range(4)}),
    "sur": lambda size: surf(np.ones((64, 40), "<i4"), b"DSCOMPRESSED", streams_of(size)),
}


def deflated(members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()


def streams_of(size):
    """Directory of one stream that says it is small, and the stream."""
    packing = zlib.compress(bytes(size))
    return b"\1\0\0\0" + (10240).to_bytes(4, "little") + len(packing).to_bytes(4, "little") + packing


@pytest.mark.parametrize("kind", PACKED)
def test_a_content_beyond_the_limit_is_refused_before_it_is_unpacked(tmp_path, monkeypatch, kind):
    monkeypatch.setattr(limits, "MOST_BYTES", 2**20)
    (tmp_path / "scan.dat").write_bytes(PACKED[kind](2**12))
    with pytest.raises(ScanError, match="^files: scan.dat (?!holds more)"):  # zeros are no map, but may be unpacked
        read(tmp_path / "scan.dat", GIVEN)
    (tmp_path / "scan.dat").write_bytes(PACKED[kind](2**21))
    with pytest.raises(ScanError, match="^files: scan.dat holds more than 1 MB, save the map of heights alone$"):
        read(tmp_path / "scan.dat", GIVEN)


def test_files_packed_in_one_another_have_an_end():
    assert packed.unpacked("a.gz", nested(3))[1].startswith(b"1 2 3")
    with pytest.raises(ScanError, match="is packed more than 3 times: unpack it"):
        packed.unpacked("a.gz", nested(4))


def test_an_array_of_too_many_points_is_refused_before_it_is_read(tmp_path):
    with h5py.File(tmp_path / "scan.h5", "w") as file:
        file.create_dataset("z", shape=(2**20, 2**20), dtype="f8", chunks=(1024, 1024), fillvalue=1.0)
    started = time.process_time()
    with pytest.raises(ScanError, match="has more than 134217728 points, save a smaller map"):
        read(tmp_path / "scan.h5", GIVEN)
    assert time.process_time() - started < 5


def test_a_pipe_is_no_scan(tmp_path):
    os.mkfifo(tmp_path / "scan.h5")
    with pytest.raises(ScanError, match="it is a pipe, must be a regular file"):
        read(tmp_path / "scan.h5", GIVEN)
