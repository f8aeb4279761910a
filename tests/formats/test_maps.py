"""Maps in formats for any numbers, written by other libraries: units, coordinates, sizes, marks and masks."""

import numpy as np
import pytest
from test_damage import gsf
from test_formats import GIVEN, HEIGHTS, SIZE, same, sxm

from stiction.errors import ScanError
from stiction.formats.axes import without_axes
from stiction.formats.no_data import MARKS, require_no_mark, without_marks
from stiction.scans.reading import UNITS, Source, read
from stiction.streams import stream

SurfaceTopography = pytest.importorskip("SurfaceTopography")
xarray = pytest.importorskip("xarray")
tifffile = pytest.importorskip("tifffile")

# Simple fields of Gwyddion


@pytest.mark.parametrize("unit", ["m", "nm", "µm"])
def test_simple_fields(tmp_path, unit):
    for title in ("", "Z", "Höhe", "Heights 12"):  # every number of zeros before the heights
        head = gsf(HEIGHTS / UNITS[unit], unit, Title=title).split(b"\0")[0]
        data = (HEIGHTS / UNITS[unit])[:, ::-1].T.astype("<f4").tobytes()
        (tmp_path / "scan.gsf").write_bytes(head + b"\0" * (4 - len(head) % 4) + data)
        found = read(tmp_path / "scan.gsf")
        same(found.scan, 1e-15)
        assert found.unit == unit


def test_a_simple_field_without_units_asks_for_them(tmp_path):
    (tmp_path / "scan.gsf").write_bytes(gsf(HEIGHTS / 1e-9, ""))
    with pytest.raises(ScanError, match="height_unit: scan.gsf has no unit"):
        read(tmp_path / "scan.gsf")
    same(read(tmp_path / "scan.gsf", Source(height_unit="nm")).scan, 1e-15)
    (tmp_path / "scan.gsf").write_bytes(gsf(XYUnits="s"))
    with pytest.raises(ScanError, match="files: scan.gsf cannot be read"):
        read(tmp_path / "scan.gsf")


def test_a_simple_field_whose_sides_have_no_unit_takes_the_stated_size(tmp_path):
    (tmp_path / "scan.gsf").write_bytes(gsf(XYUnits=""))
    with pytest.raises(ScanError, match="size_um: scan.gsf has no size"):
        read(tmp_path / "scan.gsf")
    same(read(tmp_path / "scan.gsf", Source(size=SIZE)).scan, 1e-15)
    with pytest.raises(ScanError, match="in no unit of length"):
        read(tmp_path / "scan.gsf", Source(size=(SIZE[0], 2 * SIZE[1])))


# Nanonis


@pytest.mark.parametrize("direction", ["up", "down"])
def test_both_directions_of_a_line_show_the_same_place(tmp_path, direction):
    (tmp_path / "scan.sxm").write_bytes(sxm(direction))
    forward, backward = (
        read(tmp_path / "scan.sxm", Source(channel=f"Z ({way})")).scan for way in ("forward", "backward")
    )
    mirrored = backward.heights[::-1]
    assert np.corrcoef(forward.heights.ravel(), backward.heights.ravel())[0, 1] > 0.999
    assert abs(np.corrcoef(forward.heights.ravel(), mirrored.ravel())[0, 1]) < 0.1


# netCDF of xarray

VERSIONS = {"NETCDF4": "netcdf4", "NETCDF3_CLASSIC": "netcdf4", "NETCDF3_64BIT": "scipy"}


def labelled(dims=("y", "x"), sides="um", unit="nm", x=0.1):
    """Map with coordinates and units, in the order of these dimensions."""
    steps = {name: step * np.arange(n) for name, step, n in zip("xy", (x, 0.1), HEIGHTS.shape, strict=True)}
    attributes = {"units": sides} if sides else {}
    coordinates = {name: (name, values, attributes) for name, values in steps.items()}
    stored = HEIGHTS / 1e-9 if dims == ("x", "y") else HEIGHTS.T / 1e-9
    return xarray.DataArray(
        stored, dims=dims, coords=coordinates, name="heights", attrs={"units": unit} if unit else {}
    )


@pytest.mark.parametrize("dims", [("y", "x"), ("x", "y")])
@pytest.mark.parametrize(("version", "engine"), VERSIONS.items())
def test_coordinates_and_units_of_netcdf(tmp_path, version, engine, dims):
    labelled(dims).to_netcdf(tmp_path / "scan.nc", format=version, engine=engine)
    found = read(tmp_path / "scan.nc")
    same(found.scan, 1e-15)
    assert found.unit == "nm"


def test_what_netcdf_does_not_say_is_asked_for_and_compared(tmp_path):
    labelled(unit=None).to_netcdf(tmp_path / "scan.nc")
    with pytest.raises(ScanError, match="height_unit: scan.nc has no unit"):
        read(tmp_path / "scan.nc")
    same(read(tmp_path / "scan.nc", Source(height_unit="nm")).scan, 1e-15)
    labelled(sides=None).to_netcdf(tmp_path / "bare.nc")
    same(read(tmp_path / "bare.nc", Source(size=SIZE)).scan, 1e-15)
    with pytest.raises(
        ScanError, match=r"size_um: bare.nc has coordinates over 6.4 x 4, which are 5 x 4 µm in no unit"
    ):
        read(tmp_path / "bare.nc", Source(size=(5e-6, 4e-6)))
    labelled().assign_coords(x=("x", np.cumsum(np.linspace(0.1, 0.2, 64)), {"units": "um"})).to_netcdf(
        tmp_path / "a.nc"
    )
    with pytest.raises(ScanError, match="files: a.nc cannot be read"):
        read(tmp_path / "a.nc")


# Pictures of numbers


@pytest.mark.parametrize("kind", ["<f4", ">f4", "<f8"])
def test_numbers_with_a_decimal_point_in_tiff_take_unit_and_size_of_the_configuration(tmp_path, kind):
    tifffile.imwrite(tmp_path / "scan.tif", (HEIGHTS.T / 1e-9).astype(kind), byteorder=kind[0])
    same(read(tmp_path / "scan.tif", GIVEN).scan, 1e-15)
    with pytest.raises(ScanError, match="height_unit: scan.tif has no unit"):
        read(tmp_path / "scan.tif", Source(size=SIZE))


def test_whole_numbers_in_tiff_have_no_scale(tmp_path):
    tifffile.imwrite(tmp_path / "scan.tif", np.round(HEIGHTS.T / 1e-12).astype("<u2"))
    with pytest.raises(ScanError, match="holds no map with units of length"):
        read(tmp_path / "scan.tif", GIVEN)


# Marks, axes and masks, by arrays


@pytest.mark.parametrize("mark", [-9999, 9999, -32768, 1e38, -3.4028234663852886e38])
def test_a_mark_far_from_the_heights_is_no_height_in_any_format_of_bare_numbers(tmp_path, mark):
    z = HEIGHTS / 1e-9
    z[3, 4:7] = mark
    np.save(tmp_path / "scan.npy", z)
    tifffile.imwrite(tmp_path / "scan.tif", z.T.astype("<f4"))
    np.savetxt(tmp_path / "scan.txt", z.T)
    for name in ("scan.npy", "scan.tif", "scan.txt"):
        found = read(tmp_path / name, GIVEN)
        assert np.argwhere(~found.scan.defined).tolist() == [[3, 4], [3, 5], [3, 6]]
        assert any("3 points have" in note and "the mark of no data" in note for note in found.notes)


@pytest.mark.parametrize("kind", ["<f4", "<f8"])
def test_every_mark_is_known_in_numbers_of_every_size_and_none_that_differs_from_it(kind):
    rng = stream(1, "marks")
    for mark in MARKS:
        z = rng.standard_normal((64, 64)).astype(kind)
        z[3, 4] = mark
        assert np.argwhere(np.isnan(without_marks(z.astype(float))[0])).tolist() == [[3, 4]], mark
        z[3, 4] = mark * (1 + 1e-6)
        assert np.isfinite(without_marks(z.astype(float))[0]).all(), "control"


def test_heights_that_only_look_like_a_mark_stay():
    rng = stream(1, "heights like marks")
    for centre in (-9999, 32767, 0):
        z = centre + 3000 * rng.standard_normal((64, 64))
        z[5, 5] = centre
        kept, words = without_marks(z)
        np.testing.assert_array_equal(kept, z)
        assert words == ""
        require_no_mark(z)


def test_a_value_at_many_points_far_from_all_others_is_asked_about(tmp_path):
    z = 478 + HEIGHTS / 1e-9
    z[3, 4:7] = 0
    np.save(tmp_path / "scan.npy", z)
    with pytest.raises(ScanError, match="files: scan.npy has 0 at 3 points, which may be a mark of no data or the"):
        read(tmp_path / "scan.npy", GIVEN)
    z[3, 5:7] = 478  # a single outlier is a height
    np.save(tmp_path / "scan.npy", z)
    assert read(tmp_path / "scan.npy", GIVEN).scan.undefined_share == 0


@pytest.mark.parametrize("number", [1, 3])
@pytest.mark.parametrize("mark", [1e10, -1e6, 3e37, -1e-30])
def test_a_value_of_another_order_is_asked_about_before_a_unit_is_suspected(tmp_path, number, mark):
    z = HEIGHTS / 1e-9
    far = mark if abs(mark) > 1 else 1e5 * np.ptp(z)
    z[3, 4 : 4 + number] = far
    np.save(tmp_path / "scan.npy", z)
    if abs(far) > 1e20:
        assert read(tmp_path / "scan.npy", GIVEN).scan.undefined_share > 0  # no unit can mean it
        return
    where = "1 point" if number == 1 else f"{number} points"
    with pytest.raises(ScanError, match=f"at {where}, which may be a mark of no data or the end of a detector"):
        read(tmp_path / "scan.npy", GIVEN)
    z[3, 4 : 4 + number] = 0
    z[3, 4] = 500 * np.ptp(z)  # a particle alone, the control
    require_no_mark(z)


def test_no_line_of_a_drawn_surface_is_an_axis_however_it_is_tilted():
    rng = stream(1, "axes")
    smooth = np.cumsum(np.cumsum(rng.standard_normal((50, 40)), axis=0), axis=1)
    for tilt in (0, 1, 100, 1e4):
        for z in (smooth, rng.standard_normal((50, 40))):
            tilted = z + tilt * np.arange(50)[:, None]
            assert without_axes(tilted)[0].shape == without_axes(tilted.T)[0].shape[::-1] == z.shape


@pytest.mark.parametrize("digits", [1, 2, 6])
def test_rounded_coordinates_are_an_axis(digits):
    z = stream(1, "rounded").standard_normal((60, 50))
    z[0, :], z[:, 0] = np.round(0.0196 * 10 * np.arange(50), digits), np.round(-0.25 * np.arange(60), digits)
    found, words = without_axes(z)
    np.testing.assert_array_equal(found, z[1:, 1:])
    assert words == "its first row and first column count evenly and were taken as axes"


# Sizes


def points_of(x, y, z):
    return "\n".join(f"{a:.4f} {b:.4f} {c:.6f}" for a, b, c in zip(x.ravel(), y.ravel(), z.ravel(), strict=True))


@pytest.mark.parametrize("stated", [SIZE, (6.3e-6, 3.9e-6)], ids=["edges", "centres"])
def test_a_size_may_be_that_between_the_outermost_points(tmp_path, stated):
    x, y = np.indices(HEIGHTS.shape) * 0.1
    (tmp_path / "scan.xyz").write_text(points_of(x, y, HEIGHTS / 1e-9))
    scan = read(tmp_path / "scan.xyz", Source(size=stated, height_unit="nm")).scan
    np.testing.assert_allclose(scan.size, SIZE, rtol=1e-12)
    SurfaceTopography.Topography(HEIGHTS, SIZE, unit="m").to_gwy(str(tmp_path / "scan.gwy"))
    np.testing.assert_allclose(read(tmp_path / "scan.gwy", Source(size=stated)).scan.size, SIZE)


def test_a_size_that_no_scan_has_gives_way_to_the_stated_one_and_is_told(tmp_path):
    SurfaceTopography.Topography(HEIGHTS, (1.0, 1.0), unit="m").to_gwy(str(tmp_path / "scan.gwy"))
    with pytest.raises(ScanError, match="too coarse for what touches, or its size is in another unit"):
        read(tmp_path / "scan.gwy")
    found = read(tmp_path / "scan.gwy", Source(size=SIZE))
    same(found.scan, 1e-15)
    assert found.notes == ("scan.gwy: its size of 1e+06 x 1e+06 µm is that of no scan, the stated one was taken",)


def test_points_under_a_mask_of_gwyddion_are_told(tmp_path):
    mask = np.zeros(HEIGHTS.shape, bool)
    mask[10:14, 5:9] = True
    SurfaceTopography.Topography(np.ma.masked_array(HEIGHTS, mask), SIZE, unit="m").to_gwy(str(tmp_path / "scan.gwy"))
    found = read(tmp_path / "scan.gwy")
    np.testing.assert_array_equal(found.scan.defined, ~mask)
    assert found.notes == ("scan.gwy: 16 points (0.62 %) under a mask in the file count as undefined",)
