"""Measured surfaces of a configuration: their files are checked before any job, once, and laws hold for them too."""

import inspect
import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from configurations import PAPER, SCHEMA, problems
from drawn_scans import gaussian, published, truth
from plans import job_settings
from published import SURFACES
from written_scans import BAD, SIDE, bad_files, etched, scans_of, write

from stiction.config import files, scans, validation
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.errors import ScanError
from stiction.plan import memory
from stiction.plan.devices import DevicePlan
from stiction.plan.plan import Plan
from stiction.scans import estimate
from stiction.scans.levelling import LEVELS, LINES, Levelling
from stiction.scans.quantiles import measured_density
from stiction.scans.reading import UNITS, ScanFile, Source
from stiction.scans.reading import read as read_scan
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import measured_heights as heights
from stiction.stages.surfaces import measured_spectrum as spectrum
from stiction.stages.surfaces import parameters, scan
from stiction.stages.surfaces.heights import measured_moments

B2 = SURFACES["B2"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with two scans of B2."""
    path = tmp_path_factory.mktemp("scans")
    scans_of(path, count=2)
    return path


def configured(*paths, **keys):
    """Configuration of the paper with a measured surface."""
    return merged(PAPER, etched(*paths, **keys))


def both(folder):
    return sorted(folder.glob("B2-*.gwy"))


def test_scans_are_evaluated_without_pairs_and_devices(folder):
    alone = {"run": {"pairs": []}}
    assert problems(merged(configured(*both(folder)), alone)) == ()
    (line,) = problems(merged(PAPER, alone))
    assert line == "run.pairs is [], must name a pair: there are neither devices nor scans"


# Schema and normal form


def test_the_choices_of_the_schema_are_those_of_the_code():
    scans = SCHEMA["properties"]["surfaces"]["additionalProperties"]["properties"]["scans"]["properties"]
    assert set(scans["height_unit"]["enum"]) == set(UNITS)
    assert set(scans["level"]["enum"]) == set(LEVELS)
    assert set(scans["lines"]["enum"]) == set(LINES)


def test_keys_that_are_not_given_have_their_defaults(folder):
    entry = validation.normalised(configured(*both(folder)))["surfaces"]["Etched"]
    assert entry == {"beyond": "cut", "heights": "moments", "psd": "fitted", "scans": entry["scans"]}
    assert {key: entry["scans"][key] for key in ("fast_axis", "level", "lines")} == {
        "fast_axis": "x",
        "level": "plane",
        "lines": "none",
    }
    assert in_si(Source, scans.source(entry)) == Source()
    assert in_si(estimate.Settings, scans.evaluation(entry, PAPER["scans"])) == estimate.Settings()
    given = configured(*both(folder), level="quadratic", lines="bow", fast_axis="y", heights="measured")
    again = validation.normalised(given)["surfaces"]["Etched"]
    assert (again["scans"]["level"], again["heights"]) == ("quadratic", "measured")
    assert in_si(estimate.Settings, scans.evaluation(again, PAPER["scans"])).levelling == Levelling("quadratic", "bow")


def test_values_have_units():
    entry = scans.complete({"scans": {"files": ["a"], "size_um": [5, 10], "tip_radius_nm": 8, "shortest_nm": 60,
                                         "channel": "Height", "height_unit": "nm"}})  # fmt: skip
    assert in_si(Source, scans.source(entry)) == Source("Height", "x", pytest.approx((5e-6, 10e-6)), "nm")
    settings = in_si(estimate.Settings, scans.evaluation(entry, PAPER["scans"]))
    assert (settings.tip_radius, settings.shortest) == pytest.approx((8e-9, 60e-9))
    assert (settings.tiles, settings.undefined_share) == (4, 0.01)


def test_files_are_relative_to_the_folder_of_the_configuration_file_that_names_them(folder, tmp_path):
    overlay = folder / "mine.yaml"
    overlay.write_text(json.dumps(etched("B2-0.gwy", "B2-1.gwy")))
    assert files.load(overlay)["surfaces"]["Etched"]["scans"]["files"] == [str(path) for path in both(folder)]
    other = scans.resolve_scan_paths(etched("x.gwy"), etched("y.gwy"), tmp_path)
    assert other == etched("x.gwy")
    for broken in ({}, {"surfaces": 5}, {"surfaces": {"X": 1}}, {"surfaces": {"X": {"scans": {"files": 7}}}}):
        assert scans.resolve_scan_paths(broken, broken, tmp_path) == broken


# Preliminary numbers and laws


def test_preliminary_numbers_are_those_of_the_scans(folder):
    found = validation.checked(configured(*both(folder))).estimates["Etched"]
    published_scans = published("B2", SIDE, 2)
    pooled = estimate.inspect(published_scans, estimate.Settings())
    assert np.log(1e-9 * found["rms_nm"]) == pytest.approx(pooled.moments[0], rel=1e-9)
    assert found["measured"] == pytest.approx(list(pooled.moments[1:]), rel=1e-9)
    assert found["feasible"] == pytest.approx(found["measured"])
    form = measured_density(pooled.quantiles, pooled.areas)
    np.testing.assert_allclose(found["form"], [form.scores, form.heights], rtol=1e-9)
    assert abs(found["measured"][0] - truth("B2")[1]) < 0.3
    entry = scans.with_preliminary_estimates(configured(*both(folder)), {"Etched": found})["surfaces"]["Etched"]
    psd = entry["published_psd"]
    assert psd["cutoff_rad_per_um"] == pytest.approx(125, rel=0.02)  # where the spectrum of B2 ends
    assert (entry["skewness"], entry["kurtosis"]) == tuple(found["feasible"])
    entry = scans.with_preliminary_estimates(configured(*both(folder), heights="measured"), {"Etched": found})[
        "surfaces"
    ]["Etched"]
    assert {"skewness", "kurtosis"}.isdisjoint(entry)
    np.testing.assert_array_equal(entry["form"], found["form"])
    end = pooled.reach.end
    assert psd["floor_nm4"] == pytest.approx(1e36 * float(pooled.fit.spectrum(end)(end)), rel=1e-6)
    continued = configured(*both(folder), beyond="continued")
    grid = scans.with_preliminary_estimates(continued, {"Etched": found})["surfaces"]["Etched"]["published_psd"][
        "cutoff_rad_per_um"
    ]
    assert grid == pytest.approx(np.pi / 0.01)


def test_measured_surfaces_keep_their_material_and_make_devices_uncertain():
    found = {"rms_nm": 3.0, "end_rad_per_um": 125.0, "plateau_nm4": 500.0, "corner_rad_per_um": 30.0, "slope": -4.0}
    found |= {"feasible": [-0.5, 3.5], "correlation_um": {"fitted": 0.3, "tabulated": 0.3}}
    devices = {name: {"kind": "stopper", "pair": name} for name in ("a", "b", "c")}
    devices["uncertain"] = {"pair": "a", "uncertainty": {"humidity": 0.01}}
    pairs = {"a": {"beam": "Etched"}, "b": {"beam": "B2", "substrate": "Etched"}}
    config = merged(configured("any.gwy"), {"devices": devices, "pairs": pairs})
    config["surfaces"]["Etched"]["material"] = "Gold"
    seen = scans.with_preliminary_estimates(config, {"Etched": found})
    assert seen["surfaces"]["Etched"]["material"] == "Gold"
    stated = {name: device.get("uncertainty") for name, device in seen["devices"].items()}
    assert stated == {"a": {}, "b": {}, "c": None, "uncertain": {"humidity": 0.01}}
    assert "devices" not in scans.with_preliminary_estimates(configured("any.gwy"), {"Etched": found})


def test_a_configuration_with_good_scans_is_valid_and_its_surfaces_are_shifted_like_others(folder):
    config = files.load(etched(*both(folder)))
    plan = Plan(config)
    assert plan.surfaces_with_scans == ["Etched"]
    assert plan.surfaces_by_numbers == ["Sub1"]
    assert plan.with_summits == ["Sub1"]
    assert plan.shifted_moments == ["rms", "skewness", "kurtosis"]
    assert Plan(files.load(etched(*both(folder), heights="measured"))).shifted_moments == ["rms"]
    assert plan.paper.pairs == []
    assert plan.variants.summits("b", "psd_identified")["base"]["surfaces"]["Sub1"]["psd"] == "identified"
    assert "Etched" not in plan.variants.summits("b", "psd_identified")["base"]["surfaces"]
    assert job_settings(plan, "tables/table_1.csv")["measured"].keys() == {"Sub1"}
    assert job_settings(plan, "checks.csv")["targets"].keys() == {"Sub1"}


def test_settings_know_a_file_by_content_and_name_and_not_by_folder(folder, tmp_path):
    copy = shutil.copy(both(folder)[0], tmp_path)
    first, second, other = (
        job_settings(Plan(validation.normalised(configured(path))), "scan/Etched_0")
        for path in (*both(folder)[:1], copy, both(folder)[1])
    )
    assert first == second
    assert first["sha256"] != other["sha256"]
    with pytest.raises(KeyError):
        job_settings(Plan(validation.normalised(configured(copy))), "scan/Etched_1")


def plain_parameters(compute):
    """Parameters of a stage beside its inputs, which are datasets."""
    return [name for name, each in inspect.signature(compute).parameters.items() if each.annotation is not xr.Dataset]


def test_stages_take_exactly_the_settings_of_their_jobs(folder):
    plan = Plan(files.load(etched(*both(folder), size_um=[5, 5], tip_radius_nm=10)))
    settings = {
        scan: job_settings(plan, "scan/Etched_0"),
        stage_estimate: job_settings(plan, "estimate/Etched"),
        heights: job_settings(plan, "heights/Etched"),
        spectrum: job_settings(plan, "spectrum/Etched"),
    }
    for stage, plain in settings.items():
        assert json.loads(json.dumps(plain)) == plain
        read = vars(in_si(stage.Settings, plain)) if hasattr(stage, "Settings") else plain_parameters(stage.compute)
        assert {key.removesuffix("_nm") for key in plain} == set(read)
    use = in_si(spectrum.Settings, settings[spectrum]).use
    assert (use.surface, use.strip_length, use.margin) == ("Etched", pytest.approx(1.5e-6), pytest.approx(1e-6))
    evaluation = in_si(stage_estimate.Settings, settings[stage_estimate]).evaluation
    assert evaluation == estimate.Settings(tip_radius=pytest.approx(10e-9))
    assert settings[stage_estimate]["files"] == ["B2-0.gwy", "B2-1.gwy"]


#: Changes under which the laws refuse a good scan of B2: overlay, beginning of the line, part of it.
LAWS = {
    "margin": ({"sampling": {"margin_um": 0.3}}, "sampling.margin_um is 0.3, must be above the correlation length",
               "surfaces.Etched.scans.files = ['B2-0.gwy']"),
    "coarse grid": ({"sampling": {"spacing_nm": 300, "strip_length_um": 1.5}, "character": {"spacing_nm": 300},
                     "identification": {"patch_um": 6}, "studies": {"variants": {"every": [], "spacing_nm": []}}},
                    "surfaces.Etched.scans.files is ['B2-0.gwy'], which gives corner_rad_per_um = 1",
                    "must be below the cut-off"),
    "gap": ({"pairs": {"b": {"gap_um": 0.3}}}, "pairs.b.gap_um is 0.3, must be at least",
            "surfaces.Etched.scans.files = ['B2-0.gwy']"),
}  # fmt: skip


@pytest.mark.parametrize("heights", ["moments", "measured"])
@pytest.mark.parametrize(("overlay", "begins", "part"), LAWS.values(), ids=LAWS)
def test_laws_of_the_configuration_hold_for_measured_surfaces_and_name_their_files(
    folder, overlay, begins, part, heights
):
    config = configured(both(folder)[0], heights=heights)
    config["surfaces"]["Unmet"] = {"scans": {"files": [str(both(folder)[1])]}}
    assert problems(config) == ()
    found = problems(merged(config, overlay))
    lines = [line for line in found if line.startswith(begins)]
    assert any(part in line for line in lines), found
    if "coarse grid" not in begins:
        assert not [line for line in lines if "rms_nm" in line]
        assert not [line for line in lines if "Unmet" in line and "sampling.margin_um" not in line]


def test_gaussian_scans_are_not_refused(tmp_path):
    for k, drawn in enumerate(gaussian(SIDE, 3)):
        path = write(tmp_path / f"{k}.gwy", drawn.heights)
        assert problems(configured(path)) == ()


@pytest.mark.parametrize(
    "number", [pytest.param(8, marks=pytest.mark.slow), pytest.param(20, marks=pytest.mark.nightly)]
)
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_no_gaussian_scan_is_refused_before_a_run_or_in_it(tmp_path, number):
    distances = []
    for k, drawn in enumerate(gaussian(4e-6, number)):
        path = write(tmp_path / f"{k}.gwy", drawn.heights, drawn.size)
        (found,) = validation.checked(configured(path)).estimates.values()
        assert found["feasible"] is not None
        read = scan.layout(ScanFile(drawn, "Height", "nm", ()))
        estimated = stage_estimate.compute([read], "Etched", stage_estimate.Settings(1, estimate.Settings(), 8))
        used = heights.compute(estimated, "Etched", "moments")
        distances.append(measured_moments(used).distance)
    # Every other one is beyond the border.
    assert abs(np.count_nonzero(distances) - number / 2) < 2.6 * np.sqrt(number / 4)


def test_surfaces_whose_moments_have_no_density_get_the_measured_one(tmp_path):
    clean = published("B2", SIDE, 1)[0].heights
    dirty = clean.copy()
    dirty[::50, ::50] += 60e-9
    for name, z, source in (("dirt", dirty, "measured"), ("clean", clean, "moments")):
        config = configured(write(tmp_path / f"{name}.gwy", z))
        assert validation.checked(config).config["surfaces"]["Etched"]["heights"] == source


def test_a_power_law_that_no_pixel_resolves_does_not_go_on(tmp_path):
    (fine,) = published("B1", SIDE, 1)
    coarse = write(tmp_path / "coarse.gwy", fine.heights[:249:3, :249:3], (4.98e-6, 4.98e-6))
    (line,) = problems(configured(coarse, beyond="continued"))
    assert line == (
        "surfaces.Etched.beyond is 'continued', but the pixels of coarse.gwy do not resolve the power law that would "
        "go on, must be cut"
    )
    assert problems(configured(coarse)) == ()
    assert problems(configured(write(tmp_path / "fine.gwy", fine.heights, fine.size), beyond="continued")) == ()


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:surface Etched")
@pytest.mark.parametrize("share", [0.5, 0.9])
def test_scans_of_two_heights_have_their_measured_density_or_are_refused_before_a_run(tmp_path, share):
    (drawn,) = published("B2", SIDE, 1)
    steps = np.sign(drawn.heights - np.quantile(drawn.heights, share))
    ends = []
    for k, roughness in enumerate((0, 0.1, 0.3)):
        z = 5e-9 * (steps + roughness * drawn.heights / drawn.heights.std())
        path = write(tmp_path / f"{k}.gwy", z, drawn.size)
        config = configured(path)
        if found := problems(config):  # lines on one height are constant, as those of a scan that was stopped
            assert any("of its points undefined (" in line or "equal" in line for line in found)
            ends.append("refused")
            continue
        entry = validation.checked(config).config["surfaces"]["Etched"]
        read = scan.layout(ScanFile(replace(drawn, heights=z), "Height", "nm", ()))
        estimated = stage_estimate.compute([read], "Etched", stage_estimate.Settings(1, estimate.Settings(), 8))
        heights.compute(estimated, "Etched", entry["heights"])
        ends.append(entry["heights"])
    assert ends[1:] == ["measured", "moments"]


#: Wrong keys of measured surfaces: keys, section of the surface, beginning of the only line.
WRONG = {
    "numbers beside": ({"rms_nm": 3, "kurtosis": 4}, "scans is {", "must not be given beside rms_nm, kurtosis; give"),
    "published": ({"psd": "published"}, "psd is 'published'", "must be fitted or tabulated for a surface with sc"),
    "identified": ({"psd": "identified"}, "psd is 'identified'", "must be fitted or tabulated for a surface with sc"),
    "heights": ({"heights": "quantiles"}, "heights is 'quantiles'", "must be one of moments, measured"),
    "beyond": ({"beyond": "continue"}, "beyond is 'continue'", "did you mean continued?"),
}  # fmt: skip


@pytest.mark.parametrize(("keys", "begins", "part"), WRONG.values(), ids=WRONG)
def test_a_wrong_key_of_a_measured_surface_is_one_sentence(folder, keys, begins, part):
    config = configured(both(folder)[0])
    config["surfaces"]["Etched"] |= keys
    (line,) = problems(config)
    assert line.startswith(f"surfaces.Etched.{begins}")
    assert part in line


WRONG_SCANS = {
    "no files": ({"files": []}, "scans.files is [], must be a list with at least one entry"),
    "one file": ({"files": "a.gwy"}, "scans.files is 'a.gwy', must be a list"),
    "twice": ({"files": ["a.gwy", "a.gwy"]}, "scans.files is ['a.gwy', 'a.gwy'], must list each value once; 'a.gwy'"),
    "level": ({"level": "cubic"}, "scans.level is 'cubic', must be one of mean, plane, quadratic"),
    "lines": ({"lines": False}, "scans.lines is False, must be one of none, offset, tilt, bow"),
    "axis": ({"fast_axis": "z"}, "scans.fast_axis is 'z', must be one of x, y"),
    "sides": ({"size_um": [5]}, "scans.size_um is [5], must be a list with 2 entries"),
    "side": ({"size_um": [5, 0]}, "scans.size_um[1] is 0, must be a number at least 0.001"),
    "unit": ({"height_unit": "furlong"}, "scans.height_unit is 'furlong', must be one of m, mm, µm"),
    "key": ({"tip_radius": 10}, "scans.tip_radius is unknown (value 10), must be one of files, channel"),
    "radius": ({"tip_radius_nm": -1}, "scans.tip_radius_nm is -1, must be a number at least 0.001"),
}  # fmt: skip


@pytest.mark.parametrize(("keys", "line"), WRONG_SCANS.values(), ids=WRONG_SCANS)
def test_a_wrong_key_of_scans_is_one_sentence(folder, keys, line):
    config = configured(both(folder)[0])
    config["surfaces"]["Etched"]["scans"] |= keys
    (found,) = problems(config)
    assert found.startswith(f"surfaces.Etched.{line}")


@pytest.mark.parametrize("key", ["heights", "beyond"])
def test_keys_of_measured_surfaces_are_not_given_for_others(key):
    value = {"heights": "measured", "beyond": "cut"}[key]
    (line,) = problems(merged(PAPER, {"surfaces": {"B2": {key: value}}}))
    assert line == f"surfaces.B2.{key} is {value!r}, must not be given for a surface without scans"
    (line,) = problems(merged(PAPER, {"surfaces": {"B2": {"psd": "fitted"}}}))
    assert line.startswith("surfaces.B2.psd is 'fitted', must be published or identified for a surface without scans")


# Bad files


@pytest.fixture(scope="module")
def bad(folder, tmp_path_factory):
    """Folder with unusable files, and what is wrong with each."""
    path = tmp_path_factory.mktemp("bad")
    good = shutil.copy(both(folder)[0], path / "B2-0.gwy")
    return path, bad_files(path, good)


@pytest.mark.parametrize("name", BAD)
def test_an_unusable_file_is_one_sentence_about_the_key_that_helps(bad, capfd, name):
    folder, known = bad
    keys, key, sentence = known[name]
    beside = keys.get("files", [])
    others = {other: value for other, value in keys.items() if other != "files"}
    (line,) = problems(configured(*beside, folder / name.strip(), **others))
    assert line.startswith(f"surfaces.Etched.scans.{key} {sentence}")
    assert len(line) < 300
    assert capfd.readouterr() == ("", "")


#: Names of files that cannot be read like files, or that Snakemake cannot be given, and the reason.
UNREADABLE = {
    "pipe": "cannot be opened: it is a pipe, must be a regular file",
    "zero": "cannot be opened: it is a device, must be a regular file",
    "folder": "cannot be opened: it is a folder, must be a regular file",
    "nu\0ll": "cannot be opened: its name contains a null character",
    "a{b}.gwy": "has braces in its path",
    "a{surface}.gwy": "has braces in its path",
    "brace}/a.gwy": "has braces in its path",
    "a<b>.gwy": "has a word between < and > in its path",
    "<results>/a.gwy": "has a word between < and > in its path",
    "a\nb.gwy": "has a line break or control character in its path",
    "a\x1b[31m.gwy": "has a line break or control character in its path",
    "a\u2028b.gwy": "has a line break or control character in its path",
}


@pytest.mark.parametrize("name", UNREADABLE)
def test_only_regular_files_with_names_for_snakemake_are_read(folder, tmp_path, name):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "zero").symlink_to("/dev/zero")
    (tmp_path / "folder").mkdir()
    misread = "in its path" in UNREADABLE[name]
    if misread:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(both(folder)[0], tmp_path / name)
    (line,) = problems(configured(tmp_path / name))
    assert line.startswith(f"surfaces.Etched.scans.files[0] is {Path(name).name!r}, which {UNREADABLE[name]}")
    if not misread:  # the package alone reads files of any name
        with pytest.raises(ScanError, match=UNREADABLE[name]):
            read_scan(tmp_path / name)


def test_heights_in_another_unit_are_named_as_such(tmp_path):
    np.save(tmp_path / "z.npy", 1e9 * published("B2", SIDE, 1)[0].heights)
    given = {"size_um": [1e6 * SIDE, 1e6 * SIDE]}
    assert problems(configured(tmp_path / "z.npy", height_unit="nm", **given)) == ()
    for unit in ("m", "mm"):
        (line,) = problems(configured(tmp_path / "z.npy", height_unit=unit, **given))
        assert line.startswith(f"surfaces.Etched.scans.height_unit is {unit!r}: z.npy has heights with an rms of ")
        assert line.endswith(" in another unit than is stated")


def test_every_unusable_file_is_tested(bad):
    assert set(BAD) == set(bad[1])


def test_equal_contents_under_two_names_are_not_two_scans(folder, tmp_path):
    copy = shutil.copy(both(folder)[0], tmp_path / "copy.gwy")
    (line,) = problems(configured(*both(folder), copy))
    wanted = "surfaces.Etched.scans.files[2] is 'copy.gwy', which has the same content as B2-0.gwy; a scan counts once"
    assert line == wanted


def test_files_of_equal_names_are_told_apart_by_their_folders(bad, folder, tmp_path):
    paths = [tmp_path / day / "scan.gwy" for day in ("monday", "tuesday")]
    for path, content in zip(paths, (both(folder)[0], bad[0] / "half.gwy"), strict=True):
        path.parent.mkdir()
        shutil.copy(content, path)
    (line,) = problems(configured(*paths, both(folder)[1]))
    assert line.startswith(f"surfaces.Etched.scans.files[1] is {str(paths[1])!r}, which cannot be read")
    shutil.copy(both(folder)[1], paths[1])
    assert problems(configured(*paths)) == ()
    write(paths[1], np.zeros((20, 20)) + np.eye(20))
    (line,) = problems(configured(*paths))
    assert line.startswith(f"surfaces.Etched.scans.files[1] is {str(paths[1])!r}, which has 20 x 20 points, needs")


def test_problems_of_several_surfaces_are_found_at_once(bad):
    config = configured(bad[0] / "empty.spm")
    config["surfaces"]["Other"] = {"scans": {"files": [str(bad[0] / "missing.spm")]}}
    lines = problems(config)
    assert [line.split()[0] for line in lines] == ["surfaces.Etched.scans.files[0]", "surfaces.Other.scans.files[0]"]
    (line,) = problems(config | {"seed": -1})
    assert line.startswith("seed is -1"), "no file is read for a configuration of the wrong form"


#: Folder of files of real microscopes, which are not part of the project.
REAL = os.environ.get("STICTION_SCANS")


@pytest.mark.skipif(not REAL, reason="STICTION_SCANS does not name a folder of real scans")
@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(
    "path", sorted(Path(REAL).glob("*.*")) if REAL else [None], ids=lambda path: path and path.name
)
def test_a_real_file_gives_heights_and_a_spectrum_or_is_refused_in_sentences_that_name_it(path, capfd):
    config = configured(path, heights="measured")
    if lines := problems(config):
        assert all(path.name in line and line.count("\n") == 0 and len(line) < 400 for line in lines)
    else:
        plan = Plan(validation.normalised(config))
        read = scan.compute(path, in_si(scan.Settings, job_settings(plan, "scan/Etched_0")))
        found = stage_estimate.compute(
            [read], "Etched", in_si(stage_estimate.Settings, job_settings(plan, "estimate/Etched"))
        )
        used = heights.compute(found, **job_settings(plan, "heights/Etched"))
        drawn = spectrum.compute(found, used, in_si(spectrum.Settings, job_settings(plan, "spectrum/Etched")))
        assert np.isfinite(stage_estimate.rms(found))
        assert np.all(np.isfinite(found.covariance))
        assert parameters.spectrum_of(drawn).variance > 0
    assert capfd.readouterr() == ("", "")


# Once

CHECK = """
import json, sys
from pathlib import Path
from stiction.config import files, validation
config = json.loads(sys.stdin.read())
validation.checked(config, Path(sys.argv[1]))
print("SurfaceTopography" in sys.modules, any(name.startswith("stiction.scans") for name in sys.modules))
"""


def checked(config, kept):
    """Whether a new process imports the library and the package of scans to check a configuration."""
    words = [sys.executable, "-c", CHECK, str(kept)]
    done = subprocess.run(words, input=json.dumps(config), capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return done.stdout.split()


def test_tips_on_scanned_surfaces_are_those_on_surfaces_of_their_preliminary_rms(folder):
    sizes = {"thickness_um": 2.6, "gap_um": 20, "width_um": 2, "humidities": [0.67]}
    beams = {"devices": {"C1": {"kind": "cantilever", "pair": "b"} | sizes}}
    config = files.load(configured(*both(folder)), beams)
    found, _ = scans.preliminary_estimates(config)
    numbers = scans.with_preliminary_estimates(config, found)
    assert DevicePlan(config).tips("C1") == DevicePlan(numbers).tips("C1")
    assert memory.job_memory(config) == memory.job_memory(numbers)
    rough = merged(numbers, {"surfaces": {"Etched": {"rms_nm": 100}}})
    assert DevicePlan(config).tips("C1").length < DevicePlan(rough).tips("C1").length


@pytest.mark.slow
def test_a_process_that_checks_known_files_reads_nothing_but_their_content(folder, tmp_path):
    config = configured(both(folder)[0])
    assert checked(config, tmp_path) == ["True", "True"]
    assert checked(config, tmp_path) == ["False", "False"]
    assert checked(merged(config, {"surfaces": {"Etched": {"scans": {"level": "mean"}}}}), tmp_path) == ["True", "True"]
    for file in tmp_path.iterdir():
        file.write_text("{")
    assert checked(config, tmp_path) == ["True", "True"]


def test_a_configuration_without_scans_imports_nothing_of_them(tmp_path):
    assert checked(PAPER, tmp_path / "kept") == ["False", "False"]
    assert not (tmp_path / "kept").exists()


def test_numbers_that_cannot_be_kept_are_used_all_the_same(folder, tmp_path, monkeypatch):
    (tmp_path / "kept").touch()  # no folder
    monkeypatch.setattr(scans, "_NUMBERS", {})
    assert validation.checked(configured(both(folder)[0]), tmp_path / "kept").estimates


def test_another_version_of_the_library_reads_the_files_again(folder, monkeypatch):
    config = configured(both(folder)[0])
    validation.checked(config)
    known = set(scans._NUMBERS)
    monkeypatch.setattr(scans, "version_of", lambda library: f"another {library}")
    scans._code.cache_clear()
    validation.checked(config)
    scans._code.cache_clear()
    assert len(set(scans._NUMBERS) - known) == 1


@pytest.mark.parametrize("changed", ["config/scans.py", "scans/estimate.py", "scans/reading.py"])
def test_another_evaluation_reads_the_files_again(folder, monkeypatch, changed):
    def fingerprint(module):
        return "another" if str(module).endswith(changed) else "the same"

    config, sizes = configured(both(folder)[0]), []
    for code in (lambda _: "the same", fingerprint):
        monkeypatch.setattr(scans, "fingerprint", code)
        scans._code.cache_clear()
        validation.checked(config)
        sizes.append(len(scans._NUMBERS))
    scans._code.cache_clear()
    assert sizes[1] == sizes[0] + 1


def test_other_content_in_the_same_file_is_read_again(folder, tmp_path):
    path = tmp_path / "a.gwy"
    shutil.copy(both(folder)[0], path)
    before = validation.checked(configured(path)).estimates["Etched"]
    shutil.copy(both(folder)[1], path)
    assert validation.checked(configured(path)).estimates["Etched"]["rms_nm"] != before["rms_nm"]
