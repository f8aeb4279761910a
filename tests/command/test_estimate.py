"""The command for an estimate: at once, without the libraries for numbers, and silent about what it does not know."""

import json
import re
import subprocess
import sys

import pytest

import stiction
from stiction.command.at_once import estimate
from stiction.command.main import main
from stiction.config.reading import paper
from stiction.estimate.length import NotLearnt
from stiction.plan.graph import Results

OPTIONS = ["--rms", "3", "--like", "B2", "--rh", "0.6", "--thickness", "2.6", "--gap", "20"]
FILE = """
run: {pairs: [mine], studies: []}
surfaces: {Etched: {like: B2, rms_nm: 3}}
pairs: {mine: {beam: Etched, substrate: Sub1, gap_um: 20, humidities: [0.6]}}
devices:
  Lever: {kind: cantilever, pair: mine, thickness_um: 2.6, width_um: 30, gap_um: 20, humidities: [0.6]}
"""
#: Runs the command as its script does, and says what it cost.
MEASURED = """
import json, resource, sys
from stiction.command.at_once.entry import main
sys.argv[1:1] = ["estimate"]
status = main()
used = resource.getrusage(resource.RUSAGE_SELF)
print(json.dumps([status, sorted({name.split(".")[0] for name in sys.modules}), used.ru_utime + used.ru_stime]))
"""


def measured(*words):
    """Lines of the command in a process of its own, and its status, libraries and time."""
    done = subprocess.run([sys.executable, "-c", MEASURED, *words], capture_output=True, text=True, check=True)
    *lines, last = done.stdout.splitlines()
    return lines, *json.loads(last)


def lengths(lines):
    """Lengths [µm] of the table with the ends of both intervals, by the fraction 1 in n."""
    rows = [re.findall(r"[\d.]+", line) for line in lines if line.startswith("  1 in ") and "sticks" not in line]
    return {int(float(row[1])): [float(value) for value in row[2:]] for row in rows}


def said(capsys, *words):
    """Lines of the command."""
    status = estimate.main(list(words))
    return status, capsys.readouterr().out.splitlines()


def test_an_estimate_needs_no_library_for_numbers_and_a_tenth_of_a_second():
    tries = [measured(*OPTIONS) for _ in range(5)]
    for lines, status, libraries, _ in tries:
        assert status == 0
        assert lengths(lines)
        assert not {"numpy", "scipy", "xarray", "netCDF4", "numba", "snakemake", "matplotlib"} & set(libraries)
    assert min(seconds for *_, seconds in tries) < 0.1


def test_a_file_and_options_give_the_same_lengths(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text(FILE)
    of_file, of_options = said(capsys, str(tmp_path / "mine.yaml"))[1], said(capsys, *OPTIONS)[1]
    assert lengths(of_file) == lengths(of_options)
    assert of_file[0].startswith("Lever: ")
    assert any(f"stiction devices {tmp_path / 'mine.yaml'}" in line for line in of_file)


def test_the_whole_command_knows_it_too(capsys):
    assert main(["estimate", *OPTIONS]) == 0
    assert lengths(capsys.readouterr().out.splitlines()) == lengths(said(capsys, *OPTIONS)[1])


def test_lengths_fall_with_the_fraction_and_are_within_their_intervals(capsys):
    rows = lengths(said(capsys, *OPTIONS)[1])
    assert sorted(rows) == [10, 100, 1000, 10_000, 100_000, 1_000_000]
    shorter = list(rows.values())
    assert all(one[0] > other[0] for one, other in zip(shorter, shorter[1:], strict=False))
    for length, low90, high90, low95, high95 in shorter:
        assert low95 <= low90 < high90 <= high95
        assert low95 < length < high95


def test_assumed_numbers_widen_an_interval_and_the_worst_air_decides(capsys):
    surface = [f"--{word}={value}" for word, value in {"hurst": 1, "corner": 12, "cutoff": 125}.items()]
    known = lengths(said(capsys, *OPTIONS, *surface, "--skewness=-0.76", "--kurtosis=3.9")[1])[1000]
    assumed = lengths(said(capsys, *OPTIONS)[1])[1000]
    assert known[2] / known[1] < 0.9 * assumed[2] / assumed[1]
    drier, wetter = (lengths(said(capsys, *OPTIONS, f"--rh={rh}")[1])[1000][0] for rh in (0.5, 0.8))
    both = lengths(said(capsys, *OPTIONS, "--rh", "0.5", "0.8")[1])[1000][0]
    assert wetter < drier
    assert both == wetter


def stuck_at(lines):
    """Line on the fraction stuck at the stated size."""
    (line,) = [line for line in lines if "% stick" in line]
    return line.strip()


@pytest.mark.parametrize("kind", ["cantilever", "stopper"])
def test_a_size_beyond_that_to_use_is_said_to_be_unsafe_before_its_estimate(capsys, kind):
    cantilever = [*OPTIONS, "--length"], 1, -1, "longer", "µm"
    options, end, safer, word, unit = (
        cantilever if kind == "cantilever" else (OF_STOPPER[:-1] + ["--force"], 2, 1, "less", "µN")
    )
    use = lengths(said(capsys, *options[:-1])[1])[1000][end]
    safe, unsafe = (stuck_at(said(capsys, *options, f"{use + step:g}")[1]) for step in (safer, -safer))
    assert unsafe.startswith(f"{use - safer:g} {unit} is {word} than {use:g}: not safe. Best estimate: ")
    assert re.search(r"% stick, but up to [\w. ]+ % \(95 %\)\.$", unsafe)
    assert safe.startswith(f"At {use + safer:g} {unit}, "), "the control"


def test_a_size_that_collapses_while_a_liquid_dries_is_unsafe(tmp_path, capsys):
    liquid = FILE.replace("devices:", "liquids: {water: {surface_tension_mN_per_m: 72}}\ndevices:")
    at = {}
    for text in (FILE, liquid):
        (tmp_path / "mine.yaml").write_text(
            text.replace("gap_um: 20, humidities: [0.6]}\n", "gap_um: 20, humidities: [0.6], length_um: 203}\n")
        )
        at[text] = stuck_at(said(capsys, str(tmp_path / "mine.yaml"))[1])
    assert at[liquid].startswith("203 µm is longer than 199: not safe.")
    assert at[FILE].startswith("At 203 µm, "), "the control: shorter than what sticks"


def test_more_touchdowns_need_shorter_beams_and_a_stated_length_has_a_probability(capsys):
    once = lengths(said(capsys, *OPTIONS)[1])
    often = lengths(said(capsys, *OPTIONS, "--touchdowns=10")[1])
    assert often[100][0] == pytest.approx(once[1000][0], rel=0.01)  # 1 in 100 after ten is 1 in 1000 at each
    _, lines = said(capsys, *OPTIONS, f"--length={once[1000][0]}")
    value, high = map(float, re.findall(r"[\d.]+", stuck_at(lines).partition("estimate: ")[2])[:2])
    assert value == pytest.approx(0.1, rel=0.3)  # percent; the length has three digits
    assert value <= high
    low_length = once[1000][1]
    safe = stuck_at(said(capsys, *OPTIONS, f"--length={low_length}")[1])
    value, low, high = map(float, re.findall(r"[\d.]+", safe.partition(",")[2].replace("(95 %", ""))[:3])
    assert low <= value <= high


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("kind: cantilever", "kind: bridge", "is not complete, at 'residual_stress_MPa'"),
        ("kind: cantilever", "kind: probe", "only cantilevers, bridges and stoppers"),
        ("gap_um: 20, humidities: [0.6]}\n", "gap_um: 20, voltage_V: 5, humidities: [0.6]}\n", "dielectric"),
        ("gap_um: 20, humidities: [0.6]}\n", "gap_um: 20, strip_um: 1, humidities: [0.6]}\n", "strip_um"),
        ("humidities: [0.6]}\n", "humidities: [0.999]}\n", "beyond what was learnt"),
        ("humidities: [0.6]}\n", "humidities: [0.2]}\n", "too thin to be a liquid"),
        ("rms_nm: 3", "rms_nm: 60", "beyond what was learnt"),
        ("rms_nm: 3", "rms_nm: three", "stiction check says what is wrong"),
        ("thickness_um: 2.6, ", "", "thickness_um"),
        ("rms_nm: 3}", "rms_nm: 3, material: photoresist}", "beyond what was learnt"),
        ("rms_nm: 3}", "rms_nm: 3, material: Mine}}\nmaterials: {Mine: {coating_nm: 2}", "coating_nm of Mine"),
        ("run:", "water: {temperature_K: 280, adsorbed_nm: 1}\nrun:", "water.adsorbed_nm"),
        ("substrate: Sub1", "substrate: Sub1, replica: {coherence: 0.9}", "replica"),
    ],
)
def test_what_was_not_learnt_has_no_number_but_the_command_that_computes_it(tmp_path, capsys, old, new, reason):
    text = FILE.replace(old, new)
    assert text != FILE
    (tmp_path / "mine.yaml").write_text(text)
    status, lines = said(capsys, str(tmp_path / "mine.yaml"))
    assert status == 2
    (line,) = lines
    assert "not known" in line
    assert reason in line
    assert line.endswith(f"stiction devices {tmp_path / 'mine.yaml'}")


@pytest.mark.parametrize(
    ("section", "key"),
    [
        ("materials: {Hard: {coating_nm: 1}}", ("rms_nm: 3", "rms_nm: 3, material: Hard")),
        (
            "process: {etch: {variable: t, surface: B2, settings: []}}",
            ("humidities: [0.6]}\n", "humidities: [0.6], process: etch}\n"),
        ),
        (
            "design: {beams: 300, samples_of_patches: {mine: 9}}\ncontact: {samples: 9}",
            ("run:", "contact: {every: 2}\nrun:"),
        ),
    ],
)
def test_sections_that_no_key_of_the_device_names_change_no_length(tmp_path, capsys, section, key):
    name = tmp_path / "mine.yaml"
    name.write_text(FILE)
    without = said(capsys, str(name))
    name.write_text(f"{FILE}{section}\n")
    assert said(capsys, str(name)) == without
    name.write_text(f"{FILE}{section.partition(chr(10))[0]}\n".replace(*key))
    assert said(capsys, str(name))[0] == 2, "the control: where one names them, or a number is no number of samples"


@pytest.mark.parametrize(
    "surface", ["rms_nm: 3", "rms_nm: 3, hurst: 0.9, corner_rad_per_um: 12, cutoff_rad_per_um: 125"]
)
def test_an_uncertain_number_of_a_surface_counts_as_exact(tmp_path, capsys, surface):
    exact, name = FILE.replace("rms_nm: 3", surface), tmp_path / "mine.yaml"
    found = []
    for text in (exact, exact.replace(surface, f"{surface}, uncertainty: {{rms_nm: 0.3}}")):
        name.write_text(text)
        found.append(said(capsys, str(name)))
    assert found[0] == found[1]
    assert found[0][0] == 0


def test_a_voltage_shortens_and_needs_its_dielectric(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text(
        FILE.replace("gap_um: 20, humidities: [0.6]}\n", "gap_um: 20, humidities: [0.6], voltage_V: 5, ")
        + "dielectric: {thickness_nm: 100, permittivity: 3.9}}\n"
    )
    of_file = lengths(said(capsys, str(tmp_path / "mine.yaml"))[1])
    assert of_file == lengths(said(capsys, *OPTIONS, "--voltage=5", "--dielectric", "100", "3.9")[1])
    assert of_file[1000][0] < lengths(said(capsys, *OPTIONS)[1])[1000][0]
    status, lines = said(capsys, *OPTIONS, "--voltage=5")
    assert status == 2
    assert "--dielectric is missing" in lines[0]


def test_a_stopper_by_options_is_that_of_a_file(tmp_path, capsys):
    beam, _, _ = FILE.rpartition("Lever")
    bump = "Bump: {kind: stopper, pair: mine, contact_um: [3, 2], restoring_force_uN: 40, humidities: [0.6]}\n"
    (tmp_path / "mine.yaml").write_text(beam + bump)
    options = ["--rms=3", "--like=B2", "--rh=0.6", "--contact", "3", "2", "--force=40"]
    of_file, (status, of_options) = said(capsys, str(tmp_path / "mine.yaml"))[1], said(capsys, *options)
    assert status == 0
    assert of_file[1:-1] == of_options[1 : len(of_file) - 1]
    assert "force [µN]" in of_options[1]
    forces = [row[0] for row in lengths(of_options).values()]
    assert forces == sorted(forces)
    assert stuck_at(of_options).startswith("40 µN is less than ")
    assert "--rms is missing" in said(capsys, "--rh=0.6", "--contact", "3", "2")[1][0]
    _, least, most, *_ = lengths(of_options)[1000]
    (short,) = estimate.in_short([str(tmp_path / "mine.yaml")])
    assert f"1 in 1000 of Bump sticks between {least:g} and {most:g} µN (90 %): use at least {most:g};" in short
    assert f"  1 in 1000 sticks between {least:g} and {most:g} µN (90 %): use at least {most:g}." in of_file


OF_BRIDGE = ["--rms=3", "--like=B2", "--rh=0.6", "--thickness=2", "--gap=2", "--stress=50"]
OF_STOPPER = ["--rms=3", "--like=B2", "--rh=0.6", "--contact", "3", "2", "--force=40"]
WITH_VOLTAGE = [*OPTIONS, "--voltage=5", "--dielectric", "100", "3.9", "--skewness=-0.5", "--kurtosis=4"]


PULLED, DRIVEN = ([*words, "--voltage=20", "--dielectric", "100", "3.9"] for words in (OF_STOPPER, OF_BRIDGE))


@pytest.mark.parametrize("words", [OPTIONS, OF_BRIDGE, OF_STOPPER, WITH_VOLTAGE, PULLED, DRIVEN])
def test_the_printed_file_is_valid_and_has_the_same_estimate(tmp_path, capsys, words):
    lines = said(capsys, *words)[1]
    (tmp_path / "mine.yaml").write_text("\n".join(lines[lines.index("run: {pairs: [mine], studies: []}") :]))
    assert main(["check", str(tmp_path / "mine.yaml"), "-d", str(tmp_path)]) == 0
    capsys.readouterr()
    assert lengths(said(capsys, str(tmp_path / "mine.yaml"))[1]) == lengths(lines)


def test_a_stress_makes_a_bridge_and_more_of_it_lets_it_be_longer(capsys):
    loose, tight, beam = (
        lengths(said(capsys, *OF_BRIDGE[:-1], *stress)[1])[1000][0] for stress in (["--stress=0"], ["--stress=100"], [])
    )
    assert loose < 0.9 * tight
    assert beam < 0.9 * loose, "the control: the tip of a cantilever of these sizes"
    of_file = said(capsys, *OF_BRIDGE)[1]
    assert (
        "  Mine: {kind: bridge, pair: mine, thickness_um: 2.0, gap_um: 2.0, width_um: 30.0, residual_stress_MPa: 50.0,"
        in (of_file[-1][: len(of_file[-1])])
    )


def test_a_voltage_asks_for_more_force(capsys):
    bare, driven = (lengths(said(capsys, *words)[1])[1000] for words in (OF_STOPPER, PULLED))
    assert driven[0] == pytest.approx(bare[0] + 16.2, abs=0.15)  # ε₀ V² A / 2 D², and three digits


def test_no_file_is_printed_for_a_stopper_without_a_force_which_a_run_would_refuse(capsys):
    assert said(capsys, *OF_STOPPER[:-1])[1][-1] == "With --force, the lines of mine.yaml follow."


def test_large_sizes_have_no_exponent(capsys):
    lines = said(capsys, "--rms=3", "--rh=0.45", "--thickness=2.6", "--gap=20")[1]
    assert "1030" in lines[2]
    assert not any("e+" in line for line in lines)


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--rh", "45"], "--rh must be dry, or above 0 and below 1, got 45.0"),
        (["--rh", "0.5", "nan"], "--rh must be dry, or above 0 and below 1, got nan"),
        (["--rms=-3"], "--rms must be above 0, got -3.0"),
        (["--gap=0"], "--gap must be above 0, got 0.0"),
        (["--touchdowns=0"], "--touchdowns must be above 0, got 0"),
        (["--length=250e-6"], "--length must be above --thickness, in the same unit, got 0.00025, 2.6"),
        (["--length=15"], "--length must be above --gap, in the same unit, got 15.0, 20.0"),
        (["--corner=200", "--cutoff=100"], "--cutoff must be above --corner, in the same unit, got 100.0, 200.0"),
        (["--kurtosis=4"], "--skewness and --kurtosis must come together"),
        (["--like=Gold"], "like must be one of B1, B2, Sub1, Sub2"),
        (["--hurst=1.3"], "--hurst is 1.3, must be a number at least 0 and at most 1"),
        (["--temperature=25"], "--temperature is 25.0, must be a number at least 273 and at most 373"),
        (
            ["--angles", "70", "200"],
            "materials.Lower.contact_angle_deg is 200.0, must be a number at least 0 and at most 180",
        ),
        (["--voltage=5", "--dielectric", "0", "3.9"], "--dielectric must be above 0, got 0.0"),
    ],
)
def test_an_impossible_number_has_a_sentence_and_no_run(capsys, words, reason):
    assert said(capsys, *OPTIONS, *words) == (2, [f"The device has no estimate: {reason}."])


@pytest.mark.parametrize("word", ["45%", "humid"])
def test_a_word_for_a_number_has_two_lines(capsys, word):
    with pytest.raises(SystemExit):
        estimate.main([*OPTIONS, "--rh", word])
    usage, error = capsys.readouterr().err.splitlines()
    assert usage == "usage: stiction estimate FILE ... | OPTIONS (-h lists them)"
    assert error.endswith(f"argument --rh: must be dry, or numbers above 0 and below 1, got {word}")


def test_a_dielectric_in_metres_has_no_length(capsys):
    status, lines = said(capsys, *OPTIONS, "--voltage=5", "--dielectric", "100e-9", "3.9")
    assert (status, "below its gap or thickness: change voltage or dielectric" in lines[0]) == (2, True)
    assert said(capsys, *OPTIONS, "--voltage=5", "--dielectric", "100", "3.9")[0] == 0


@pytest.mark.parametrize("options", [OPTIONS, OF_STOPPER])
def test_dry_air_is_a_word_or_zero_and_stands_in_the_printed_file(tmp_path, capsys, options):
    (status, of_word), (_, of_zero) = (said(capsys, *options, "--rh", word) for word in ("dry", "0"))
    assert (status, of_word) == (0, of_zero)
    assert "estimate in dry air, the strictest air" in of_word[0]
    assert lengths(of_word) != lengths(said(capsys, *options)[1])
    lines = of_word[of_word.index("run: {pairs: [mine], studies: []}") :]
    assert all("humidities: [dry]" in line for line in lines if "humidities" in line)
    (tmp_path / "mine.yaml").write_text("\n".join(lines))
    assert main(["check", str(tmp_path / "mine.yaml"), "-d", str(tmp_path)]) == 0
    capsys.readouterr()
    assert lengths(said(capsys, str(tmp_path / "mine.yaml"))[1]) == lengths(of_word)


@pytest.mark.parametrize(
    ("words", "start"),
    [
        (["--rms=900"], "rms of the heights over the film of water (from rms and humidity) is too large"),
        (
            ["--thickness=2.6e-6"],
            "softness of the beam over slopes of the surface (from thickness, gap and rms) is too large",
        ),
        (["--kurtosis=2", "--skewness=-0.5"], "kurtosis is too small"),
    ],
)
def test_what_is_beyond_has_its_side_and_its_inputs(capsys, words, start):
    line = said(capsys, *OPTIONS, *words)[1][0]
    assert line.startswith(f"The device is not known at once: {start}, beyond what was learnt.")


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("gap_um: 20, humidities: [0.6]}\n", "gap_um: 0, humidities: [0.6]}\n", "gap_um must be above 0, got 0"),
        ("humidities: [0.6]}\n", "humidities: [60]}\n", "humidities must be dry, or above 0 and below 1, got 60"),
        (
            "rms_nm: 3",
            "rms_nm: -3",
            "surfaces.Etched.rms_nm is -3, must be a number at least 0.001 and at most 1000",
        ),
    ],
)
def test_an_impossible_number_of_a_file_has_its_key(tmp_path, capsys, old, new, reason):
    (tmp_path / "mine.yaml").write_text(FILE.replace(old, new))
    assert said(capsys, str(tmp_path / "mine.yaml")) == (2, [f"Lever has no estimate: {reason}."])


def test_a_file_of_a_stopper_needs_no_force(tmp_path, capsys):
    bump = "Bump: {kind: stopper, pair: mine, contact_um: [3, 2], humidities: [0.6]}\n"
    (tmp_path / "mine.yaml").write_text(FILE.rpartition("Lever")[0] + bump)
    assert lengths(said(capsys, str(tmp_path / "mine.yaml"))[1]) == lengths(said(capsys, *OF_STOPPER)[1])


def test_a_file_takes_no_options_and_must_have_devices(tmp_path, capsys):
    name = tmp_path / "mine.yaml"
    name.write_text(FILE)
    for words in (["--rms=3"], ["--touchdowns=2"], ["--contact", "3", "3"]):
        assert estimate.main([str(name), *words]) == 2
        option = words[0].partition("=")[0]
        assert capsys.readouterr().err == f"{option} is for a device without a file: state it in {name}\n"
    name.write_text(FILE.partition("devices:")[0])
    assert estimate.main([str(name)]) == 2
    assert capsys.readouterr().err == f"{name} has no devices to estimate\n"
    name.write_text(FILE.partition("devices:")[0] + "devices: {file: range.csv}\n")
    assert "devices of a table were not learnt" in said(capsys, str(name))[1][0]


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--contact", "3", "3", "--voltage=5"], "--dielectric is missing"),
        (["--contact", "3", "3", "--thickness=2"], "--thickness is for beams alone"),
        (["--contact", "3", "3", "--stress=2"], "--stress is for bridges alone"),
        (["--thickness=2", "--gap=20", "--force=5"], "--force is for stoppers alone"),
        (["--thickness=2", "--gap=2", "--stress=50", "--force=5"], "--force is for stoppers alone"),
        (["--thickness=2", "--gap=2", "--stress=50", "--voltage=5"], "--dielectric is missing"),
        (["--thickness=2", "--gap=2", "--stress=-5"], "--stress must be 0 or above, got -5.0"),
    ],
)
def test_an_option_of_another_device_is_refused_and_not_left_out(capsys, words, reason):
    status, (line,) = said(capsys, "--rms=3", "--rh=0.6", *words)
    assert status == 2
    assert reason in line


def test_more_than_half_is_at_least_half(capsys):
    line = stuck_at(said(capsys, *OPTIONS, "--length=2000")[1])
    assert line.endswith("not safe. Best estimate: at least 50 % stick.")
    assert "at least 99 % stick." in stuck_at(said(capsys, *OPTIONS, "--length=2000", "--touchdowns=1000")[1])
    assert "less than 0.0001 % stick (95 %: " in stuck_at(said(capsys, *OPTIONS, "--length=21")[1])


@pytest.mark.parametrize("missing", ["rms", "rh", "thickness", "gap"])
def test_a_missing_option_is_named(capsys, missing):
    k = OPTIONS.index(f"--{missing}")
    status, lines = said(capsys, *OPTIONS[:k], *OPTIONS[k + 2 :])
    assert status == 2
    assert f"--{missing} is missing" in lines[0]


def test_the_library_is_that_of_the_paper():
    for name, entry in estimate.content()["library"].items():
        assert entry.items() <= paper()["surfaces"][name].items()


def test_a_device_in_python_has_the_same_estimate(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text(FILE)
    device = stiction.Device("Lever", Results.of(stiction.load(tmp_path / "mine.yaml")))
    rows = lengths(said(capsys, str(tmp_path / "mine.yaml"))[1])
    for row in device.estimate().rows:
        assert 1e6 * row.length == pytest.approx(rows[round(1 / row.fraction)][0], rel=5e-3)  # three digits
    coarser = stiction.load(tmp_path / "mine.yaml", {"contact": {"every": 2}})
    with pytest.raises(NotLearnt, match="contact.every"):
        stiction.Device("Lever", Results.of(coarser)).estimate()


def test_a_check_ends_with_the_estimate(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text(FILE)
    assert main(["check", str(tmp_path / "mine.yaml"), "-d", str(tmp_path)]) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    _, least, most, *_ = lengths(said(capsys, str(tmp_path / "mine.yaml"))[1])[1000]
    assert f"1 in 1000 of Lever sticks between {least:g} and {most:g} µm (90 %): use at most {least:g}" in last
