"""When, and by which code, a result was made."""

import json

import pytest

from stiction.run import made

RUN = {"started": "2026-01-31T23:05:59+00:00", "versions": {"stiction": "0.2.0", "numpy": "2.0"}, "git": None}


def commit(*changed):
    return {"commit": "abc", "changed": list(changed), "untracked": ["notes.txt"]}


@pytest.mark.parametrize(
    ("git", "sentences"),
    [
        (None, ["stiction 0.2.0, installed"]),
        (commit(), ["stiction 0.2.0, commit abc"]),
        (commit("a.py", "b.py"), ["stiction 0.2.0, commit abc", "Files that are changed in its folder: a.py, b.py"]),
    ],
)
def test_the_code_of_a_run_is_named_with_its_changed_files_alone(git, sentences):
    assert list(made.code(RUN | {"git": git})) == sentences
    assert next(made.code(RUN | {"git": git, "versions": {}})) == sentences[0].replace(" 0.2.0", "")


def test_a_result_is_made_by_the_last_run_of_the_record(tmp_path):
    record = tmp_path / "provenance.json"
    record.write_text(json.dumps([RUN | {"started": "2025-01-01T00:00:00+00:00", "git": commit()}, RUN]))
    first, *code, last = made.by_the_last_run(record)
    assert first == "Made by the run of 2026-01-31 23:05 UTC."
    assert code == ["stiction 0.2.0, installed."]
    assert "results/provenance.json" in last
