"""Files are read strictly, and problems are one line with the name of the file; also before Snakemake reads them."""

import json
import os
import subprocess
import sys

import pytest
import yaml
from configurations import ROOT
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stiction.config import reading
from stiction.config.files import load
from stiction.config.messages import ConfigError
from stiction.config.reading import problems, read


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"seed: 1\nbeam: {elements: 2}\nseed: 2\n", "key 'seed' is given twice"),
        (b"beam:\n  elements: 2\n  elements: 2\n", "line 2, column 3"),
        (b"", "is empty, must be sections"),
        (b"- 1\n", "holds [1], must be sections"),
        (b"5000\n", "holds 5000, must be sections"),
        (b"a: [1\n", "expected ',' or ']'"),
        (b"a:\n\tb: 1\n", "; indent with spaces, not with tabs"),
        (b"a: 1\nb: \xff\n", "line 2 holds a character that is not UTF-8"),
        (b"a: \x00\n", "cannot be read"),
        (b"a: &x {b: *x}\n", "recursive"),
        (b"a: &x {b: [*x]}\n", "recursive"),
        (b"a: &x [*x]\n", "recursive"),
        (b"a: *x\n", "undefined alias"),
        (b"{[1]: 2}\n", "unhashable key"),
        (b"a: !!bool x\n", "cannot be read"),
        (b"a: !!python/object:os.system x\n", "could not determine a constructor"),
        (b"a: 2021-13-45\n", "cannot be read"),
        (b"a: 1\n---\na: 2\n", "remove the line --- that starts a second document"),
        (b"a: " + b"1" * 5000, "line 1, column 4: a value has 5000 characters, must have at most 4096"),
        (b"a:\n  b: " + b"x" * 5000, "line 2, column 6: a value has 5000 characters"),
        (b"? " + b"x" * 5000 + b"\n: 1\n", "a value has 5000 characters"),
        (b"a: &x [" + b"1, " * 999 + b"1]\nb: [" + b"*x, " * 100 + b"]", "the file has 101105 values"),
        (b"[" * 2000, "cannot be read"),
    ],
)
def test_an_invalid_file_is_rejected_in_one_line_with_its_name(tmp_path, content, message):
    path = tmp_path / "mine.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigError) as refused:
        read(path)
    assert str(path) in str(refused.value)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def laughs(levels, kind):
    """A file of a few lines in which every level repeats the one before nine times."""
    repeated = {
        "list": "[{}]".format(", ".join(["*{0}"] * 9)),
        "section": "{{" + ", ".join(f"k{k}: *{{0}}" for k in range(9)) + "}}",
    }
    lines = [f"l{k}: &l{k} " + repeated[kind].format(f"l{k - 1}") for k in range(1, levels)]
    return "\n".join(["l0: &l0 [lol, lol]", *lines, f"seed: *l{levels - 1}", f"pairs: {{a: *l{levels - 1}}}"])


@pytest.mark.parametrize("kind", ["list", "section"])
@pytest.mark.parametrize("levels", [12, 200])
def test_aliases_that_stand_for_more_values_than_memory_holds_are_refused_at_once(tmp_path, kind, levels):
    path = tmp_path / "mine.yaml"
    path.write_text(laughs(levels, kind))
    with pytest.raises(ConfigError, match="values, with aliases written out, must have at most 100000"):
        load(path)
    path.write_text(laughs(3, kind))
    with pytest.raises(ConfigError, match="l0 is unknown"):
        load(path)


@pytest.mark.slow
def test_a_message_about_any_text_of_the_largest_size_ends(tmp_path):
    """Texts that a pattern or a suggestion could need long for, at a number, a choice, a name, a list and as a key."""
    path = tmp_path / "mine.yaml"
    texts = [part * (4000 // len(part)) for part in ("1", "a", "1,111", "1e", "water", " x", "+1", "a.", "1 ", "[")]
    for text in (*texts, *(f"{text}%" for text in texts), *(f"1{text}" for text in texts)):
        for place in ("beam: {{thickness_um: {}}}", "van_der_waals: {}", "figures: {{pair: {}}}", "run: {{pairs: {}}}"):
            path.write_text(place.format(json.dumps(text)))
            with pytest.raises(ConfigError) as refused:
                load(path)
            assert len(str(refused.value)) < 5000
        path.write_text(f"beam: {{? {json.dumps(text)} : 1}}")
        with pytest.raises(ConfigError, match="is unknown"):
            load(path)


def test_a_missing_file_is_reported_by_name(tmp_path):
    with pytest.raises(ConfigError, match=r"nowhere\.yaml cannot be read: .*No such file"):
        read(tmp_path / "nowhere.yaml")


def test_only_regular_files_are_read(tmp_path):
    os.mkfifo(tmp_path / "pipe")  # waits for ever
    (tmp_path / "to zero").symlink_to("/dev/zero")  # has no end
    for path, kind in {"pipe": "a pipe", "to zero": "a device", ".": "a folder"}.items():
        with pytest.raises(ConfigError) as refused:
            read(tmp_path / path)
        assert str(refused.value) == f"{tmp_path / path} cannot be read: it is {kind}, must be a regular file"
    with pytest.raises(ConfigError, match="cannot be read: its name contains a null character"):
        read(f"{tmp_path}/mine\0.yaml")


def test_an_anchor_may_be_changed_key_by_key(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("base: &b {x: 1, y: 2}\nmine: {<<: *b, y: 3}\n", encoding="utf-8")
    assert read(path)["mine"] == {"x": 1, "y": 3}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text(alphabet="abé1.-~: {}[]\n\t,'\"&*!<>?|%@#=0e") | st.text())
def test_any_text_is_read_as_sections_or_rejected_in_one_line(tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        assert isinstance(read(path), dict)
    except ConfigError as error:
        refused = str(error)
    else:
        return
    assert refused.startswith(str(path))
    assert len(refused.splitlines()) == 1


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_a_text_of_ascii_in_utf_16_is_named_so_with_and_without_a_mark(tmp_path, encoding):
    path = tmp_path / "range.csv"
    path.write_bytes("name,length_um\nL1,100\n".encode(encoding))
    with pytest.raises(ValueError, match="it is text in UTF-16, must be UTF-8: save it as UTF-8"):
        reading.text(path)
    path.write_bytes(b"name,length_um\nL1,100\n")  # the control
    assert reading.text(path).startswith("name")


ENCODINGS = ("latin-1", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252")


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("lines", [0, 1, 7])
def test_text_in_another_encoding_is_rejected_with_its_line_or_its_name(tmp_path, encoding, lines):
    path = tmp_path / "mine.yaml"
    path.write_bytes(("seed: 1\n" * lines + "# gap in µm\n").encode(encoding))
    with pytest.raises(ConfigError) as refused:
        read(path)
    assert str(refused.value).startswith(f"{path} cannot be read: ")
    assert "UTF-8" in str(refused.value) or "special characters" in str(refused.value)
    if encoding in ("latin-1", "cp1252"):
        assert f"line {lines + 1} holds a character that is not UTF-8" in str(refused.value)


@given(st.integers(0, 10**6))
def test_a_number_is_read_as_written_or_rejected_with_the_number_that_yaml_reads(tmp_path_factory, number):
    path = tmp_path_factory.mktemp("numbers") / "mine.yaml"
    for text in (
        f"{number}",
        f"-{number}",
        f"+{number}",
        f"{number}.5",
        f"0{number}",
        f"{number}:30",
        f"{number}:30.5",
    ):
        path.write_text(f"a: 1\nb: [{text}]\n")
        (meant,) = yaml.safe_load(path.read_text())["b"]
        if isinstance(meant, str) or (":" not in text and meant == float(text)):
            assert read(path)["b"] == [meant]
            continue
        with pytest.raises(ConfigError, match=r"line 2, column 5: YAML reads") as refused:
            read(path)
        assert f"{text} in base" in str(refused.value)
        assert f", as {meant}: write the number that is meant" in str(refused.value)


@pytest.mark.parametrize(
    ("text", "value"), [("1:30", 90), ("010", 8), ("-1:30", -90), ("1:30.5", 90.5), ("0o10", None)]
)
def test_bases_60_and_8_are_rejected(tmp_path, text, value):
    path = tmp_path / "mine.yaml"
    path.write_text(f"beam: {{thickness_um: {text}}}\n")
    if value is None:
        assert read(path) == {"beam": {"thickness_um": text}}
        return
    with pytest.raises(ConfigError, match=rf"line 1, column 22: YAML reads {text} in base \d+, as {value}: write"):
        read(path)


@pytest.mark.parametrize(
    ("arguments", "count"),
    [
        ([], 0),
        (["--config", "seed=1", "chaos={order: 3}", "-n"], 0),
        (["--config=seed=1"], 0),
        (["-n", "--config", "seed", "beam.thickness_um=2.5", "--cores", "2"], 2),
        (["-C", "a b=3"], 1),
        (["--config=seed"], 1),
        (["--cores", "seed", "--configfile", "nowhere.yaml", "config.yaml"], 1),
    ],
)
def test_settings_that_snakemake_cannot_take_are_reported(monkeypatch, arguments, count):
    monkeypatch.chdir(ROOT)
    found = list(problems(["config.yaml"], arguments))
    assert len(found) == count
    assert all("must be a key of the first level" in line or "nowhere.yaml cannot be read" in line for line in found)


@pytest.mark.parametrize("option", ["--cores", "-c", "--jobs", "-j", "--local-cores"])
@pytest.mark.parametrize(("number", "count"), [("0", 1), ("-1", 1), ("00", 1), ("1", 0), ("all", 0), ("unlimited", 0)])
def test_no_number_of_jobs_with_which_a_run_never_ends_is_accepted(option, number, count):
    written = [[option, number, "-n"], [f"{option}={number}"], ["-n", option, number, "tables"]]
    for arguments in [*written, [f"{option}{number}"]] if len(option) == 2 else written:
        found = list(problems([], arguments))
        assert found == [f"the number of jobs at the same time is {number}, must be at least 1, or all"] * count


def test_the_command_imports_no_library_for_numbers_before_it_checks_its_files():
    code = "import sys, stiction.command.main; print(*sys.modules)"
    modules = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, check=True).stdout.split()
    assert not {"numpy", "scipy", "numba", "xarray", "snakemake"} & set(modules)


def test_the_workflow_imports_no_library_that_only_jobs_need():
    common = (ROOT / "workflow" / "rules" / "common.smk").read_text()
    head = [line for line in common.splitlines() if line.startswith("from stiction")]
    code = "\n".join([*head, "import sys", "print(*sys.modules)"])
    modules = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, check=True).stdout.split()
    assert "stiction.plan.planner" in modules
    assert not {"scipy", "numba", "xarray", "netCDF4", "pandas", "matplotlib"} & set(modules)
