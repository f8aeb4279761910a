"""Files of scans, written by the library that reads them, and configurations that use them."""

import numpy as np
from drawn_scans import published
from topographies import SurfaceTopography

from stiction.config.merging import merged

#: Side of the scans of B2, 9.5 wavelengths of its corner [m].
SIDE = 5e-6
#: Few model scans, so that an estimate takes a second.
QUICK = {"scans": {"model_scans": 8}}


def write(path, heights, size=(SIDE, SIDE)):
    """Write a map of heights [m], NaN where undefined, in the format of the ending of the file."""
    masked = np.ma.masked_invalid(heights) if np.isnan(heights).any() else heights
    topography = SurfaceTopography.Topography(masked, size, unit="m")
    getattr(topography, {".gwy": "to_gwy", ".x3p": "to_x3p", ".nc": "to_netcdf"}[path.suffix])(str(path))
    return path


def scans_of(folder, name="B2", count=1, ending="gwy", side=SIDE):
    """Files of scans of a published surface."""
    folder.mkdir(exist_ok=True)
    drawn = published(name, side, count)
    return [write(folder / f"{name}-{k}.{ending}", scan.heights, scan.size) for k, scan in enumerate(drawn)]


def etched(*files, **keys):
    """Changes of a configuration: a measured surface under the beam of pair b, which runs alone."""
    reading = {key: keys.pop(key) for key in list(keys) if key not in ("heights", "psd", "beyond")}
    entry = {"scans": {"files": [str(file) for file in files]} | reading} | keys
    changes = {"surfaces": {"Etched": entry}, "pairs": {"b": {"beam": "Etched"}}, "run": {"pairs": ["b"]}}
    return merged(changes, QUICK)


_HEIGHTS = np.random.default_rng(1).standard_normal((64, 64))
_GIVEN = {"size_um": [1, 1], "height_unit": "nm"}


def bad_files(folder, good):
    """Write unusable files: name to (keys of scans, files besides, key, part of the sentence)."""
    content = good.read_bytes()
    half, damaged = content[: len(content) // 2], bytearray(content)
    damaged[4:64] = bytes(60)
    z = published("B2", SIDE, 1)[0].heights
    holes = z.copy()
    for shift in range(4):
        holes[shift::30, :], holes[:, shift::30] = np.nan, np.nan
    texts = {
        "empty.spm": b"",
        "half.gwy": half,
        "damaged.gwy": bytes(damaged),
        "nonsense.txt": b"nothing in here is a height\n" * 9,
        "cut.di": b"\\*File list\r\n\\Version: 0x05120130\r\n\\*File list end\r\n\x1a" + bytes(2000),
        "profile.xyz": "\n".join(f"{x} {x**2}" for x in range(40)).encode(),
    }
    for name, text in texts.items():
        (folder / name).write_bytes(text)
    np.save(folder / "bare.npy", _HEIGHTS)
    write(folder / "holes.gwy", holes)
    write(folder / "tiny.gwy", z[:40, :40], (0.8e-6, 0.8e-6))
    damage = "which cannot be read as any known format, or is damaged"
    return {
        "missing.spm": ({}, "files[0]", "is 'missing.spm', which cannot be opened: No such file or directory"),
        "empty.spm": ({}, "files[0]", "is 'empty.spm', which is empty"),
        "half.gwy": ({}, "files[0]", f"is 'half.gwy', {damage}"),
        "damaged.gwy": ({}, "files[0]", f"is 'damaged.gwy', {damage}"),
        "nonsense.txt": (_GIVEN, "files[0]", f"is 'nonsense.txt', {damage}"),
        "cut.di": (
            {},
            "files[0]",
            "is 'cut.di', which holds no map with units of length: set them in the program that",
        ),
        "profile.xyz": (
            _GIVEN,
            "files[0]",
            "is 'profile.xyz', which is a profile: list it under profiles, in place of scans",
        ),
        "bare.npy": ({"height_unit": "nm"}, "size_um", "is missing: bare.npy has no size in a unit of length"),
        "bare.npy ": ({"size_um": [1, 1]}, "height_unit", "is missing: bare.npy has no unit; give one of m, mm"),
        "holes.gwy": ({}, "files[0]", "is 'holes.gwy', which has 26.7 % of its points undefined (72 empty"),
        "tiny.gwy": ({}, "files[0]", "is 'tiny.gwy', which cannot give a spectrum: 8 rings are needed"),
        "B2-0.gwy": ({"channel": "Phase"}, "channel", "is 'Phase': B2-0.gwy has no channel Phase, only: "),
        "B2-0.gwy ": ({"size_um": [6, 5]}, "size_um", "is [6, 5]: B2-0.gwy has a size of 5 x 5 µm, which differs by"),
    }


#: Names of unusable files; a space tells apart two configurations of the same file.
BAD = [
    *(
        "missing.spm",
        "empty.spm",
        "half.gwy",
        "damaged.gwy",
        "nonsense.txt",
        "cut.di",
        "profile.xyz",
        "bare.npy",
        "bare.npy ",
    ),
    *("holes.gwy", "tiny.gwy", "B2-0.gwy", "B2-0.gwy "),
]
