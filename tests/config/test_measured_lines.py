"""Surfaces measured along lines, from files to a configuration that runs."""

import importlib.util
import shutil
from pathlib import Path

import numpy as np
import pytest

import stiction
from stiction.command.main import main
from stiction.config.files import load
from stiction.config.messages import ConfigError
from stiction.streams import stream
from stiction.surface import self_affine

STEP, RMS = 25e-9, 3e-9
SPECTRUM = self_affine.spectrum(RMS, -3.6, 12e6, np.pi / STEP)
UNITS = {"x_unit": "um", "height_unit": "nm"}


def drawn(number, points=1024):
    """Line across a Gaussian surface of the spectrum, 64 points wide and periodic [m]."""
    first, second = (2 * np.pi * np.fft.fftfreq(n, STEP) for n in (points, 64))
    density = SPECTRUM(np.hypot(first[:, None], second)) * (2 * np.pi / STEP) ** 2 / (64 * points)
    rng = stream(1, "config lines", number)
    waves = rng.standard_normal((points, 64)) + 1j * rng.standard_normal((points, 64))
    return np.fft.fft2(np.sqrt(density) * waves).real[:, 0]


def write(path, heights, head="", step=STEP):
    rows = (f"{1e6 * step * k:.4f};{1e9 * z:.4f}" for k, z in enumerate(heights))
    path.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    return path.name


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("lines")
    for number in (1, 2, 3):
        write(path / f"line_{number}.txt", drawn(number), "x [µm];z [nm]\n")
    (path / "empty.txt").write_bytes(b"")
    (path / "binary.txt").write_bytes(bytes(range(256)) * 9)
    write(path / "short.txt", drawn(4, 64))
    write(path / "far.txt", drawn(5), step=2 * STEP)
    return path


def configured(folder, profiles, **more):
    """Overlay in a file, with a lever on the surface."""
    import yaml

    text = {
        "run": {"pairs": [], "studies": []},
        "surfaces": {"Etched": {"profiles": profiles, **more}},
        "pairs": {"mine": {"beam": "Etched", "substrate": "Sub2", "gap_um": 20, "humidities": [0.5]}},
        "devices": {"Lever": {"kind": "cantilever", "pair": "mine", "thickness_um": 2.6, "width_um": 30}},
    }
    text["devices"]["Lever"] |= {"gap_um": 20, "humidities": [0.5]}
    path = folder / "mine.yaml"
    path.write_text(yaml.safe_dump(text), encoding="utf-8")
    return path


def test_lines_make_a_surface_by_numbers_with_errors(folder):
    config = load(configured(folder, {"files": ["line_1.txt", "line_2.txt", "line_3.txt"]}, material="SiO2"))
    entry = config["surfaces"]["Etched"]
    errors, psd = entry["uncertainty"], entry["published_psd"]
    assert "profiles" not in entry
    assert entry["material"] == "SiO2"
    assert set(errors) == {"rms_nm", "skewness", "kurtosis", "corner_rad_per_um", "hurst"}
    assert abs(entry["rms_nm"] - 1e9 * RMS) < 3.5 * errors["rms_nm"] < entry["rms_nm"]
    assert abs(psd["corner_rad_per_um"] - 12) < 3.5 * errors["corner_rad_per_um"]
    assert psd["cutoff_rad_per_um"] == pytest.approx(1e-6 * np.pi / STEP, rel=1e-4)
    assert load(config) == config, "the normal form is its own"
    drawn_rms = stiction.Surface.of(config, "Etched").rms
    assert drawn_rms == pytest.approx(1e-9 * entry["rms_nm"], rel=1e-9)


@pytest.mark.parametrize(
    ("profiles", "refused"),
    [
        ({"files": ["absent.txt"]}, "files[0] is 'absent.txt', which cannot be opened: No such file or directory"),
        ({"files": ["binary.txt"]}, "files[0] is 'binary.txt', which is no text"),
        ({"files": ["empty.txt"]}, "files[0] is 'empty.txt', which has no numbers in columns"),
        ({"files": ["short.txt"], **UNITS}, "files[0] is 'short.txt', which has 64 points, must have at least 128"),
        ({"files": ["line_1.txt", "far.txt"], **UNITS}, "files[1] is 'far.txt', which has 0.05 µm between its points"),
        ({"files": ["line_1.txt", "line_1.txt"]}, " must name each file once"),
        ({"files": ["far.txt"]}, "x_unit is missing: far.txt has no units in its head"),
        ({"files": ["line_1.txt"], "x_unit": "nm"}, "x_unit is 'nm': line_1.txt has µm in its head, not nm"),
        ({"files": ["far.txt"], "x_unit": "mm", "height_unit": "nm"}, "files[0] is 'far.txt', which has 50 µm between"),
        ({"files": ["far.txt"], "x_unit": "nm", "height_unit": "mm"}, "files[0] is 'far.txt', which has an rms slope"),
    ],
)
def test_bad_lines_are_refused_in_one_sentence(folder, profiles, refused):
    with pytest.raises(ConfigError) as error:
        load(configured(folder, profiles))
    (line,) = error.value.problems
    assert line.removeprefix("surfaces.Etched.profiles").removeprefix(".").startswith(refused)


def test_lines_stand_beside_no_maps_and_no_numbers(folder):
    for more in ({"scans": {"files": ["map.gwy"]}}, {"rms_nm": 3}, {"uncertainty": {"rms_nm": 0.1}}):
        with pytest.raises(ConfigError, match=f"profiles must not be given beside {next(iter(more))}"):
            load(configured(folder, {"files": ["line_1.txt"]}, **more))


def test_the_example_gives_the_surface_that_it_draws(tmp_path, capsys):
    examples = Path(__file__).parents[2] / "examples" / "scans"
    spec = importlib.util.spec_from_file_location("lines", examples / "lines.py")
    spec.loader.exec_module(lines := importlib.util.module_from_spec(spec))
    lines.main(tmp_path, length=20e-6)
    path = shutil.copy(examples / "lines.yaml", tmp_path)
    assert main(["scans", str(path), "--directory", str(tmp_path)]) == 0
    assert capsys.readouterr().out.startswith("Etched by lines: rms ")
    found, truth = load(path)["surfaces"]["Etched"], load()["surfaces"]["B2"]
    for key in ("rms_nm", "skewness", "kurtosis"):
        assert abs(found[key] - truth[key]) < 3.5 * found["uncertainty"][key]
    assert abs(found["published_psd"]["corner_rad_per_um"] - truth["published_psd"]["corner_rad_per_um"]) < (
        3.5 * found["uncertainty"]["corner_rad_per_um"]
    )
