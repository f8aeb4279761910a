"""Damaged heads of the formats of this folder: the same rms as before, or one sentence; never another rms.

Every head is overwritten, emptied, doubled and cut at drawn places. What a head states only once, and nothing else in
the file repeats, no reader can check: then the rms is that of the stated value, or the file is refused.
"""

import struct

import numpy as np
import pytest
from test_formats import HEIGHTS, SIZE, asd, jpk, sxm

from stiction.errors import ScanError
from stiction.formats import high_speed
from stiction.scans.reading import read
from stiction.streams import stream

pytest.importorskip("SurfaceTopography")
h5py = pytest.importorskip("h5py")


def gsf(heights=HEIGHTS, unit="m", **changed):
    """Simple field of Gwyddion: rows from the top, and one to four zeros before them."""
    keys = {"XRes": heights.shape[0], "YRes": heights.shape[1], "XReal": SIZE[0], "YReal": SIZE[1]}
    keys |= {"XYUnits": "m", "ZUnits": unit, "Title": "Topography"} | changed
    head = "Gwyddion Simple Field 1.0\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
    return head.encode() + b"\0" * (4 - len(head) % 4) + heights[:, ::-1].T.astype("<f4").tobytes()


def rms_of(path, stored):
    """Rms of the heights in a file, or ``None`` if it is refused in one sentence."""
    path.write_bytes(stored)
    try:
        return float(np.nanstd(read(path).scan.heights))
    except ScanError as refusal:
        sentence = str(refusal)
    assert "\n" not in sentence
    return None


def damaged(stored, start, size, rng):
    """Content with other bytes at a place, or without them, or with them twice."""
    part = stored[start : start + size]
    kind = rng.integers(6)
    if kind < 3:
        part = [rng.bytes(size), bytes(size), b"\xff" * size][kind]
    elif kind == 3:
        part = bytes(rng.choice(list(b"0123456789 .EenmV\n"), size).tolist())
    return stored[:start] + (b"" if kind == 4 else part * (2 if kind == 5 else 1)) + stored[start + size :]


HEADS = {"sxm": (sxm(), sxm().index(b"\x1a\x04") + 2), "gsf": (gsf(), len(gsf()) - 4 * HEIGHTS.size)}


@pytest.mark.parametrize("ending", HEADS)
@pytest.mark.parametrize("number", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in range(1, 8))])
def test_a_text_before_the_heights_with_damage_gives_the_same_rms_or_a_refusal(tmp_path, ending, number):
    stored, end = HEADS[ending]
    rng, path = stream(1, "damage", ending, number), tmp_path / f"scan.{ending}"
    true, found = rms_of(path, stored), []
    for _ in range(60):
        size = int(rng.integers(4, 40))
        found.append(rms_of(path, damaged(stored, int(rng.integers(end - size)), size, rng)))
    np.testing.assert_allclose([rms for rms in found if rms is not None], true, rtol=1e-6)
    assert found.count(None) > 0, "damage is found"
    assert true > 0, "the whole file is read"


@pytest.mark.parametrize("ending", HEADS)
def test_heights_with_a_part_twice_or_without_one_are_refused(tmp_path, ending):
    stored, end = HEADS[ending]
    rng = stream(1, "parts", ending)
    for _ in range(20):
        start, size = end + int(rng.integers(5000)), 4 * int(rng.integers(1, 500))
        for times in (0, 2):
            changed = stored[:start] + stored[start : start + size] * times + stored[start + size :]
            assert rms_of(tmp_path / f"scan.{ending}", changed) is None


def fields(version):
    """Start, code and size of every value in the head of a movie, and its name if nothing else repeats it."""
    layout = high_speed._VERSION_0 if version == 0 else high_speed._VERSION_1
    places, start = high_speed._PLACES[min(version, 1)], 0
    once = dict.fromkeys(places["piezo"], "piezo") | {places["range"]: "range"}
    for number, (code, size) in enumerate(_sizes(layout)):
        yield start, code, size, once.get(number)
        start += size
    assert start == struct.calcsize(layout)


def _sizes(layout):
    """Code and size of every value of a layout of ``struct``."""
    number = ""
    for sign in layout[1:]:
        if sign.isdigit():
            number += sign
            continue
        repeated = int(number or 1)
        yield from [(sign, repeated)] if sign == "s" else [(sign, struct.calcsize("<" + sign))] * repeated
        number = ""


def allowed(true, once, before, after):
    """Rms that a damaged value of a movie may give, beside a refusal."""
    if once == "piezo":
        return true * after / before
    if once == "range":
        span = {code: abs(last - first) for code, (first, last) in high_speed._RANGES.items()}
        return true * span.get(after, np.nan) / span[before]
    return true


@pytest.mark.parametrize("version", [0, 1, 2])
def test_every_value_in_the_head_of_a_movie_with_damage_gives_the_same_rms_or_a_refusal(tmp_path, version):
    stored, path, rng = asd(version), tmp_path / "scan.asd", stream(1, "damage", "asd", version)
    true, refused, found = rms_of(path, stored), 0, []
    for start, code, size, once in fields(version):
        (before,) = struct.unpack_from(f"<{size if code == 's' else ''}{code}", stored, start)
        for _ in range(4):
            changed = damaged(stored, start, size, rng)
            rms = rms_of(path, changed)
            refused += rms is None
            if rms is not None:
                (after,) = struct.unpack_from(f"<{size if code == 's' else ''}{code}", changed, start)
                found.append((rms, allowed(true, once, before, after)))
    np.testing.assert_allclose(*np.transpose(found), rtol=1e-6)
    assert 0 < refused < refused + len(found)


@pytest.mark.parametrize("version", [0, 1, 2])
def test_a_movie_of_another_size_than_its_head_says_is_refused(tmp_path, version):
    stored, rng = asd(version), stream(1, "size", version)
    for _ in range(20):
        cut = int(rng.integers(400, len(stored)))
        size = 2 * int(rng.integers(1, 200))
        for changed in (stored[:cut], stored[:cut] + stored[cut : cut + size] + stored[cut:]):
            assert rms_of(tmp_path / "scan.asd", changed) is None


def test_a_movie_of_two_billion_frames_in_a_small_file_is_refused_at_once(tmp_path):
    places = list(fields(1))
    for number in (high_speed._PLACES[1]["frames"], high_speed._PLACES[1]["points"][0]):
        stored = bytearray(asd(1, frames=1))
        struct.pack_into("<i", stored, places[number][0], 2**31 - 1)
        assert rms_of(tmp_path / "scan.asd", bytes(stored)) is None
    empty = bytearray(asd(1, frames=1))
    for number in (2, *high_speed._PLACES[1]["points"], high_speed._PLACES[1]["frames"]):
        struct.pack_into("<i", empty, places[number][0], 0)
    struct.pack_into("<i", empty, places[high_speed._PLACES[1]["frames"]][0], 2**31 - 1)
    assert rms_of(tmp_path / "scan.asd", bytes(empty)) is None


#: Attributes of a scan of JPK that are stated once: the scale of its levels.
_SCALE = "net-encoder.scaling.multiplier"


def test_every_attribute_of_a_scan_of_jpk_with_damage_gives_the_same_rms_or_a_refusal(tmp_path):
    stored = jpk(tmp_path / "whole.h5-jpk", {("height", "false"): ("m", [HEIGHTS, HEIGHTS])}).read_bytes()
    true, rng = rms_of(tmp_path / "scan.h5-jpk", stored), stream(1, "damage", "jpk")
    for place in ("Measurement_000", "Measurement_000/Channel_000"):
        with h5py.File(tmp_path / "whole.h5-jpk") as file:
            names = sorted(set(file[place].attrs) - {_SCALE})
        for name in names:
            for value in (0, -1, 63, 65, 1e300, np.nan, np.bytes_(rng.bytes(6)), np.bytes_(b"V"), np.bytes_(b"nm")):
                (tmp_path / "scan.h5-jpk").write_bytes(stored)
                with h5py.File(tmp_path / "scan.h5-jpk", "r+") as file:
                    file[place].attrs[name] = value
                rms = rms_of(tmp_path / "scan.h5-jpk", (tmp_path / "scan.h5-jpk").read_bytes())
                assert rms is None or rms == pytest.approx(true, rel=1e-6), (name, value)
