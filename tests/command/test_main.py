"""The command line, without Snakemake: what is asked of it, and what is refused before it starts."""

import gc
import json
import os
import re
import shlex
import signal
import sys
import warnings
from pathlib import Path

import pytest
import yaml
from test_front_page import finished
from written_scans import QUICK, etched, scans_of

import stiction
from stiction.command import launch
from stiction.command.front_page import FRONT
from stiction.command.last_lines import FAULT
from stiction.command.main import main
from stiction.config.merging import merged
from stiction.config.test_beams import beams

ROOT = Path(__file__).parents[2]
BASE = ["--configfile", str(ROOT / "config.yaml")]


@pytest.fixture
def asked(monkeypatch, tmp_path):
    """Arguments of Snakemake, which does not run, in an empty folder."""
    calls = []

    def snakemake(arguments, directory, quiet, progress):
        calls.append((list(map(str, arguments)), directory, quiet, progress))
        return 0, False

    monkeypatch.setattr(launch, "snakemake", snakemake)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.yaml").write_text("seed: 1\n")
    (tmp_path / "more.yaml").write_text("seed: 2\n")
    (tmp_path / "both.yaml").write_text("devices: {C1: {}}\nsurfaces: {B1: {scans: {}}}\n")
    return calls


def options(asked):
    """Arguments behind the files, and files."""
    ((arguments, *_),) = asked
    cut = arguments.index("--directory")
    assert arguments[: len(BASE)] == BASE
    assert arguments[cut + 2 : cut + 4] == ["--snakefile", str(ROOT / "Snakefile")]
    return arguments[cut + 4 :], arguments[len(BASE) : cut]


@pytest.mark.parametrize(
    ("words", "passed", "files"),
    [
        ("paper", [], []),
        ("run mine.yaml", [], ["mine.yaml"]),
        ("run mine.yaml more.yaml --cores 2", ["--cores", "2"], ["mine.yaml", "more.yaml"]),
        ("run mine.yaml -- --forceall tables", ["--forceall", "tables"], ["mine.yaml"]),
        ("devices both.yaml --dry-run", ["--dry-run", "devices"], ["both.yaml"]),
        ("devices", ["devices"], [str(ROOT / "examples" / "devices.yaml")]),
        ("figures", ["figures"], []),
        ("figures mine.yaml", ["figures"], ["mine.yaml"]),
        ("explain mine.yaml", ["--dry-run"], ["mine.yaml"]),
        ("run mine.yaml -- -- devices", ["--", "devices"], ["mine.yaml"]),
    ],
)
def test_what_every_command_asks_of_snakemake(asked, words, passed, files):
    assert main(words.split()) == 0
    assert options(asked) == (passed, files)


def test_scans_are_asked_for_without_what_uses_them(asked, tmp_path):
    (tmp_path / "scans.yaml").write_text(json.dumps(merged(etched(*scans_of(tmp_path)), {"devices": {"C1": {}}})))
    assert main(["scans", "scans.yaml"]) == 0
    assert options(asked) == (["scans", "--keep-going"], [str(Path(".snakemake", "scans.yaml"))])
    written = yaml.safe_load((tmp_path / ".snakemake" / "scans.yaml").read_text())
    assert written.keys() == {"surfaces", "scans", "seed", "run"}
    assert list(written["surfaces"]) == ["Etched"]


def test_the_folder_of_a_run_and_the_report_in_it(asked, tmp_path, capsys):
    (tmp_path / "here" / "results").mkdir(parents=True)
    assert main(["report", "--directory", "here"]) == 2, "nothing to report yet"
    assert asked == []
    finished(tmp_path / "here" / "results")
    assert main(["report", "--directory", "here"]) == 0
    assert capsys.readouterr().out.endswith("The report is one file: here/results/report.html.\n")
    assert "686 ± 16" in (tmp_path / "here" / FRONT).read_text()
    found, _ = options(asked)
    style, guide = (ROOT / "workflow" / "report" / name for name in ("style.css", "guide.yaml"))
    asked_for = ["--report", "results/report.html", "--report-stylesheet", str(style), "--report-metadata", str(guide)]
    assert found == asked_for
    assert style.exists()
    assert guide.exists()


@pytest.mark.parametrize(
    ("words", "quiet", "progress"),
    [
        ("paper", True, True),
        ("paper -n", True, False),
        ("paper -- -n", True, False),
        ("paper -v", False, True),
        ("paper -- --verbose", False, True),
    ],
)
def test_progress_is_shown_unless_snakemake_prints_or_nothing_runs(asked, words, quiet, progress):
    main(words.split())
    assert asked[0][2:] == (quiet, progress)


BAD_FILES = {
    "latin-1": "seed: 1 # µ".encode("latin-1"),
    "utf-16": "seed: 1".encode("utf-16"),
    "empty": b"",
    "list": b"- seed\n",
    "tabs": b"beam:\n\telements: 2\n",
    "two documents": b"seed: 1\n---\nseed: 2\n",
    "base 60": b"beam: {thickness_um: 1:30}\n",
    "octal": b"seed: 010\n",
    "missing": None,
}
COMMANDS = ("run", "devices", "scans", "figures", "explain", "check")


@pytest.mark.parametrize(
    ("command", "kind"), [*(("run", kind) for kind in BAD_FILES), *((command, "list") for command in COMMANDS)]
)
def test_a_file_that_snakemake_would_misread_is_refused_in_one_line_before_it_starts(asked, capsys, command, kind):
    Path("mine.yaml").unlink()
    if BAD_FILES[kind] is not None:
        Path("mine.yaml").write_bytes(BAD_FILES[kind])
    assert main([command, "mine.yaml"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("mine.yaml ")
    assert asked == []


@pytest.mark.parametrize("setting", ["beam.thickness_um=2.5", "seed"])
def test_a_setting_that_snakemake_cannot_take_is_refused_in_one_line(asked, capsys, setting):
    assert main(["paper", "--", "--config", setting]) == 2
    assert f"--config {setting} must be a key of the first level" in capsys.readouterr().err
    assert asked == []
    assert main(["paper", "--", "--config", "seed=1"]) == 0


@pytest.mark.parametrize("words", ["-c 0", "--cores=-1", "-c0", "-- --cores 0", "-- -j0"])
def test_a_run_without_a_job_at_a_time_would_never_end_and_is_refused(asked, capsys, words):
    assert main(["run", "mine.yaml", *words.split()]) == 2
    assert capsys.readouterr().err.startswith("the number of jobs at the same time is ")
    assert asked == []


def test_without_snakemake_the_command_says_what_to_install(asked, capsys, monkeypatch):
    monkeypatch.setattr(launch.importlib.util, "find_spec", {}.get)
    assert main(["paper"]) == 2
    assert "-m pip install 'snakemake[reports]" in capsys.readouterr().err
    assert asked == []
    assert main(["check", "mine.yaml"]) == 0, "needs no Snakemake"


def test_errors_of_a_quiet_run_go_to_a_file_until_it_ends(tmp_path, capfd):
    with launch._kept_errors(tmp_path) as terminal:
        os.write(2, b"of a job\n")
        terminal.write("shown\n")
    os.write(2, b"after it\n")
    assert capfd.readouterr() == ("", "shown\nafter it\n")
    assert launch.printed_last(tmp_path) == "of a job"


@pytest.mark.parametrize(("quiet", "progress"), [(True, True), (True, False), (False, True)])
def test_only_a_quiet_run_shows_its_progress_in_a_line(tmp_path, monkeypatch, quiet, progress):
    shown = []
    monkeypatch.setattr("snakemake.cli.main", lambda _: shown.append(launch.RUN.changed))
    assert launch.snakemake([], tmp_path, quiet, progress) == (0, False)
    assert [display is not None for display in shown] == [quiet and progress]


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_jobs_that_a_signal_keeps_from_starting_are_no_warning(tmp_path, monkeypatch, how):
    async def prepare():
        """As Snakemake does before it starts a job."""

    monkeypatch.setattr("snakemake.cli.main", lambda _: [prepare(), signal.raise_signal(how)])
    before = signal.getsignal(how)
    with warnings.catch_warnings(record=True) as caught:
        assert launch.snakemake([], tmp_path, True, False) == (1, True)
        gc.collect()
    assert caught == []
    assert signal.getsignal(how) is before


def test_a_path_of_python_that_snakemake_does_not_support_is_refused(asked, capsys, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/my folder/python")
    assert main(["paper"]) == 2
    assert "the path of Python (/my folder/python) contains ' '" in capsys.readouterr().err
    assert asked == []


def test_the_study_that_is_written_is_valid_and_never_overwritten(tmp_path, capsys):
    assert main(["init", "--directory", str(tmp_path)]) == 0
    (named,) = re.findall(r"\$schema=(\S+)", (tmp_path / "study.yaml").read_text())
    assert json.loads((tmp_path / named).read_text())["properties"], "editors find the schema"
    study = tmp_path / "study.yaml"
    assert f"stiction run {study}" in capsys.readouterr().out
    text = study.read_text(encoding="utf-8")
    assert stiction.load(study)["run"]["pairs"] == ["mine"]
    study.write_text(text.replace("# devices:", "devices:").replace("#   C1", "  C1").replace("#   S1", "  S1"))
    assert list(stiction.load(study)["devices"]) == ["C1", "S1"]
    changed = study.read_text()
    assert main(["init", "--directory", str(tmp_path)]) == 2
    assert study.read_text() == changed
    assert main(["init", "--directory", str(tmp_path / "new" / "folder")]) == 0
    capsys.readouterr()
    assert main(["init", "--directory", str(tmp_path / "new" / "folder")]) == 2
    assert (
        capsys.readouterr().err == f"{tmp_path / 'new' / 'folder' / 'study.yaml'} exists already: nothing was written\n"
    )
    for below in (study, study / "below"):
        assert main(["init", "--directory", str(below)]) == 2
        assert capsys.readouterr().err == f"{study} is no folder: move it away, or choose another --directory\n"


def test_the_commands_that_follow_can_be_pasted_whatever_the_folder(tmp_path, capsys):
    folder = tmp_path / "it's $mine (2)"
    assert main(["init", "--directory", str(folder)]) == 0
    _, *commands = capsys.readouterr().out.splitlines()
    assert [shlex.split(line)[:3] for line in commands] == [
        ["stiction", command, str(folder / "study.yaml")] for command in ("check", "run")
    ]


def test_no_file_is_overwritten_beside_a_study_or_through_a_link(tmp_path, capsys):
    schema, other = tmp_path / "stiction.schema.json", tmp_path / "other"
    for content in (lambda: schema.write_text("mine"), lambda: schema.symlink_to(other), lambda: schema.mkdir()):
        content()
        assert main(["init", "--directory", str(tmp_path)]) == 2
        assert capsys.readouterr().err == f"{schema} exists already: nothing was written\n"
        assert not other.exists()
        assert not (tmp_path / "study.yaml").exists()
        schema.rmdir() if schema.is_dir() else schema.unlink()
    assert main(["init", "--directory", str(tmp_path)]) == 0
    (tmp_path / "study.yaml").rename(other)
    assert main(["init", "--directory", str(tmp_path)]) == 0, "the same schema serves both"


def test_a_table_of_test_beams_is_written_once(tmp_path, capsys):
    assert main(["init", "--test-beams", "--directory", str(tmp_path)]) == 0
    assert [file.name for file in tmp_path.iterdir()] == ["test_beams.csv"]
    assert len(beams((tmp_path / "test_beams.csv").read_text(encoding="utf-8"))) == 4
    assert main(["init", "--test-beams", "--directory", str(tmp_path)]) == 2
    assert "exists already" in capsys.readouterr().err


def test_a_check_names_what_would_be_computed_or_every_problem(tmp_path, capsys, monkeypatch):
    path = tmp_path / "mine.yaml"
    path.write_text("run: {pairs: [a, b]}\n")
    monkeypatch.chdir(tmp_path)
    assert main(["check", str(path)]) == 0
    can, costs = capsys.readouterr().out.splitlines()
    assert can == f"{path} can run: pairs a, b."
    assert re.fullmatch(r"It takes about \d+ min of CPU time and \d+ MB for each job, .*", costs)
    path.write_text("seeds: 1\nchaos: {ordr: 2}\n")
    assert main(["check", str(path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 2


def test_a_check_says_what_takes_most_of_the_time_of_a_device_on_measured_surfaces(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("stiction.pilot.problems", lambda *_: [])
    device = {"kind": "stopper", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.6]}
    devices = {"Measured": device | {"pair": "b"}, "Other": device | {"pair": "c"}}
    config = merged(etched(*scans_of(tmp_path)), QUICK | {"devices": devices})
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(config))
    assert main(["check", str(path), "--directory", str(tmp_path)]) == 0
    can, _, estimate, costs = capsys.readouterr().out.splitlines()
    assert estimate.startswith("Estimate: 1 in 1000 of Other sticks between")
    assert can.endswith("devices Measured, Other and scans of Etched.")
    assert costs.startswith("The budget of Measured draws the measured surfaces again")


def test_a_check_names_the_probes_that_are_asked_for_their_force(tmp_path, capsys):
    probe = {"kind": "probe", "pair": "b", "radius_um": 10, "humidities": [0.45]}
    devices = {"Ball": probe, "Bump": probe | {"radius_um": 5, "restoring_force_uN": 1}}
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({"run": {"pairs": [], "studies": []}, "devices": devices}))
    assert main(["check", str(path), "--directory", str(tmp_path)]) == 0
    assert "Asked for the pull-off force, not for what to build: Ball.\n" in capsys.readouterr().out


def test_a_check_draws_the_first_samples_and_remembers_what_they_showed(tmp_path, capsys, monkeypatch):
    path = tmp_path / "mine.yaml"
    path.write_text("run: {pairs: [b]}\nbeam: {width_um: 0.06}\nattraction: {reach: touching}\n")
    words = ["check", str(path), "--directory", str(tmp_path)]
    assert main(words) == 2
    refusal = capsys.readouterr().err
    assert refusal.startswith("beam.width_um is 0.06, must give patches of surface with so many summits")
    monkeypatch.delattr("stiction.pilot.contacts_of_samples")
    assert main(words) == 2
    assert capsys.readouterr().err == refusal


def test_a_check_makes_no_folder(tmp_path, capsys):
    path = tmp_path / "mine.yaml"
    path.write_text("run: {pairs: [b]}\nbeam: {width_um: 0.06}\n")
    asked = ["check", str(path), "--directory", str(tmp_path / "later" / "mine")]
    status = main(asked)
    assert list(tmp_path.iterdir()) == [path]
    (tmp_path / "later" / "mine").mkdir(parents=True)
    printed = capsys.readouterr()
    assert main(asked) == status, "the answer does not depend on the folder"
    assert capsys.readouterr() == printed


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("place", ["folder", "folder/below", "link", "."])
def test_a_folder_that_is_none_is_refused_in_one_sentence(asked, capsys, command, place):
    Path("folder").touch()
    Path("link").symlink_to("nowhere")
    Path("results").touch()
    assert main([command, "both.yaml", "--directory", place]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith(" is no folder: move it away, or choose another --directory")
    assert asked == []


@pytest.mark.parametrize("content", ["", "{}", "[1]", "[{}]", "\x00"])
def test_a_damaged_record_of_runs_is_named_with_what_to_do(asked, capsys, content):
    Path("results").mkdir()
    Path("results", "provenance.json").write_text(content)
    assert main(["report"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("results/provenance.json ")
    assert line.endswith("; delete it")
    assert asked == []


@pytest.mark.parametrize("dry", [[], ["-n"]])
@pytest.mark.parametrize(
    ("command", "missing"), [("devices", "no devices: add"), ("scans", "no surface by scans: add")]
)
def test_a_file_without_what_a_command_computes_is_not_up_to_date(asked, capsys, command, missing, dry):
    assert main([command, "mine.yaml", *dry]) == 2
    assert missing in capsys.readouterr().err
    found = [["mine.yaml", "both.yaml"], ["mine.yaml", "--", "--configfile", "both.yaml"]]
    ended = [main([command, *words]) for words in found]
    assert ended == [2 * (command == "scans"), 0], "scans without files are refused where they are read"
    assert len(asked) == ended.count(0)


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"]])
def test_the_help_tells_exit_statuses_and_where_results_are(capsys, words):
    with pytest.raises(SystemExit, match="0"):
        main(words)
    text = capsys.readouterr().out
    assert "3 checks of the results failed" in text
    assert "results/" in text


@pytest.mark.usefixtures("asked")
def test_an_unexpected_error_of_the_command_ends_in_three_lines_and_a_log(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(launch, "words", lambda *arguments: {}["psd"])
    assert main(["run", "mine.yaml"]) == 1
    assert capsys.readouterr().err.splitlines() == ["KeyError: 'psd'", FAULT, "log: .snakemake/printed.log"]
    assert "Traceback" in (tmp_path / ".snakemake" / "printed.log").read_text()


def test_the_version(capsys):
    with pytest.raises(SystemExit, match="0"):
        main(["--version"])
    assert capsys.readouterr().out == f"stiction {stiction.__version__}\n"


@pytest.mark.parametrize("words", [[], ["paint"], ["run"], ["paper", "--colour"]])
def test_an_unknown_command_is_refused_with_the_usage(words):
    with pytest.raises(SystemExit, match="2"):
        main(words)
