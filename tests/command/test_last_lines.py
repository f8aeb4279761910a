"""Last lines of a command and its exit status."""

import contextlib

import pytest
from noted import noted, save_page
from test_run_state import end, failure, heard, plan, record, start

from stiction.command.last_lines import FAULT, Status, last_lines, sentence, status, where_to_look
from stiction.run.atomic import DataError
from stiction.run.logs import logged

DONE = heard(plan(beams=2), start(0), start(1, at=70), end(0, 70), end(1, 119))


@pytest.mark.parametrize(
    ("run", "code", "stopped", "expected"),
    [
        (DONE, 0, False, Status.DONE),
        (DONE, 1, True, Status.STOPPED),
        (heard(plan(beams=2), start(0), failure(0)), 1, False, Status.FAILED),
        (heard(plan(verdict=2), start(0, "verdict"), failure(0, "verdict")), 1, False, Status.CHECKS),
        (heard(start(0, "verdict"), failure(0, "verdict"), start(1), failure(1)), 1, False, Status.FAILED),
        (heard(record("no", event="error")), 1, False, Status.REFUSED),
        (heard(plan(beams=2), record("no", event="error")), 1, False, Status.REFUSED),
        (heard(plan(beams=2), record("x", event="error", exception="CalledProcessError")), 1, False, Status.FAILED),
        (heard(record("'psd'", event="error", exception="KeyError")), 1, False, Status.FAILED),
        (heard(record("no", event="error", exception="WorkflowError")), 1, False, Status.REFUSED),
        (heard(), 2, False, Status.REFUSED),
        (heard(plan(beams=2), start(0)), 1, False, Status.FAILED),
    ],
)
def test_exit_statuses(run, code, stopped, expected):
    assert status(run, code, stopped) == expected


def test_the_numbers_of_exit_statuses_are_those_of_the_help():
    assert [*map(int, Status)] == [0, 1, 2, 3, 130]


def lines(run, ended, folder, printed=""):
    return list(last_lines(run, ended, folder, printed))


def test_a_run_that_was_stopped_says_how_to_continue(tmp_path):
    (line,) = lines(DONE, Status.STOPPED, tmp_path)
    assert line == "stopped after 2 of 2 jobs; run the same command to continue"
    assert lines(heard(), Status.STOPPED, tmp_path) == ["stopped; run the same command to continue"]


def test_a_run_with_budgets_says_which_part_of_the_time_they_took(tmp_path):
    jobs = start(0), start(1, "budget", at=70), end(0, 70), end(1, 100)
    assert lines(heard(plan(beams=1, budget=1), *jobs), Status.DONE, tmp_path)[0] == (
        "Done: 2 jobs in 2 min, 30 % of their time for budgets."
    )
    assert "budgets" not in lines(DONE, Status.DONE, tmp_path)[0]


def test_a_refusal_is_the_last_line(tmp_path):
    assert lines(heard(record("no", event="error")), Status.REFUSED, tmp_path, "other") == ["no"]
    assert lines(heard(), Status.REFUSED, tmp_path, "usage") == ["usage"]
    run = heard(record("x returned 1", event="error", exception="CalledProcessError"))
    assert lines(run, Status.FAILED, tmp_path, "OSError: y") == ["OSError: y"]


def test_a_failure_ends_with_its_sentence_and_the_path_of_its_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    log = tmp_path / "results" / "logs" / "a.log"
    with contextlib.suppress(SystemExit), logged(log):
        raise DataError("the disk is full")
    run = heard(plan(beams=3), start(0), start(1), failure(0), failure(1))
    first, reason, last = lines(run, Status.FAILED, tmp_path)
    assert first == "failed: Job of beams. (and 1 more)"
    assert reason == "DataError: the disk is full"
    assert last == "log: results/logs/a.log"
    log.unlink()
    assert "without a message" in lines(run, Status.FAILED, tmp_path)[1]


def test_an_error_of_the_code_says_so_with_its_log_and_a_refusal_does_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    planning = heard(
        record('KeyError in file "a.smk", line 3:\n\'psd\'\n  File "b.py"', event="error", exception="KeyError")
    )
    assert lines(planning, Status.FAILED, tmp_path) == ["KeyError: 'psd'", FAULT, "log: .snakemake/printed.log"]
    for error, expected in ((KeyError("psd"), True), (TypeError("no"), True), (ValueError("no"), False)):
        log = tmp_path / "results" / "logs" / "a.log"
        with contextlib.suppress(SystemExit), logged(log):
            raise error
        found = lines(heard(plan(beams=1), start(0), failure(0)), Status.FAILED, tmp_path)
        assert (FAULT in found) == expected
        assert found[1].startswith(f"{type(error).__name__}: ")
        assert found[-1] == "log: results/logs/a.log"


@pytest.mark.parametrize("text", ["short", "two\nlines", "a: b"])
def test_the_sentence_of_a_log_is_the_message_of_its_error_with_its_notes(tmp_path, text):
    with contextlib.suppress(SystemExit), logged(tmp_path / "log"):
        error = ValueError(text)
        error.add_note("in pair b")
        raise error
    assert sentence(tmp_path / "log") == f"ValueError: {' '.join(text.split())} in pair b"


def test_a_log_without_error_has_no_sentence(tmp_path):
    with logged(tmp_path / "log"):
        pass
    assert sentence(tmp_path / "log") == ""


def test_the_first_failed_check_is_told(tmp_path):
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "checks.csv").write_text(
        "name,case,passed,message\nenergy,b,True,fine\ncrack,b NG,False,5 off\ncrack,c,False,6 off\n"
    )
    fill(tmp_path / "results", "index.html")
    first, counted, where = lines(heard(start(0, "verdict"), failure(0, "verdict")), Status.CHECKS, tmp_path)
    assert first == "crack: b NG: 5 off"
    assert counted.startswith("2 of 3 checks of the results failed: ")
    assert counted.endswith("results/checks.md")
    assert "results/index.html" in where


def fill(results, *names):
    for name in names:
        (results / name).parent.mkdir(parents=True, exist_ok=True)
        (results / name).write_text("")


def test_where_to_look_counts_warnings_and_names_page_and_table(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = (tmp_path / "results").relative_to(tmp_path)
    fill(results, "verdict.txt", "tables/table_3.md", "tables/table_1.md", "figures/overview.png", "figures/a.png")
    (results / "verdict.txt").write_text("All 3 checks of the results passed.\n")
    save_page(results, noted("One."), noted("Two."))
    verdict, warnings, first = where_to_look(results)
    assert verdict == "All 3 checks of the results passed. The numbers are in results/checks.md."
    assert warnings.endswith("2 in results/warnings.md.")
    assert first == "Open first: results/figures/overview.png and results/tables/table_3.md."
    fill(results, "devices/S1.html", "devices/C1.html", "tables/stoppers.md")
    assert list(where_to_look(results))[-1] == "Open first: results/devices/C1.html and results/tables/stoppers.md."
    fill(results, "tables/roughness.md")
    assert list(where_to_look(results))[-1].endswith("and results/tables/roughness.md."), "which was asked for"


def test_what_was_asked_for_is_opened_first(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fill(tmp_path / "results", "figures/overview.png", "tables/table_3.md", "figures/asperities.png")
    fill(tmp_path / "results", "tables/asperities.md", "figures/compared_table_3.png", "tables/compared_table_3.md")
    for asked, expected in (
        (["asperities", "--force"], "results/figures/asperities.png and results/tables/asperities.md"),
        (["compared_*"], "results/figures/compared_table_3.png and results/tables/compared_table_3.md"),
        (["figures"], "results/figures/overview.png and results/tables/table_3.md"),
    ):
        done = list(last_lines(DONE, Status.DONE, tmp_path, "", asked))
        assert done[-1] == f"Open first: {expected}."


def test_a_finished_run_ends_in_at_most_four_lines(tmp_path):
    fill(tmp_path / "results", "verdict.txt", "tables/table_3.md", "figures/overview.png")
    save_page(tmp_path / "results", noted("One."))
    found = lines(DONE, Status.DONE, tmp_path)
    assert len(found) == 4
    assert found[0] == "Done: 2 jobs in 2 min."
    assert lines(heard(), Status.DONE, tmp_path) == [], "an answer of Snakemake, such as --summary, ends by itself"
    assert lines(heard(record("Nothing to be done")), Status.DONE, tmp_path)[0].startswith("Nothing to do")


def test_the_end_of_a_run_is_silent_about_files_of_other_settings_and_says_so(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = (tmp_path / "results").relative_to(tmp_path)
    names = ["verdict.txt", "warnings.md", "tables/table_3.md", "figures/overview.png"]
    fill(results, *names)
    save_page(results, noted("One."))
    every = len(list(where_to_look(results)))
    for number in range(1, len(names) + 1):
        unlike = {f"results/{name}": "was made with other settings" for name in names[:number]}
        *spoken, last = where_to_look(results, (), unlike)
        assert len(spoken) == every - min(number, 2) - (number == 4), "figure and table share a line"
        assert not [name for name in names[:number] if any(name in line for line in spoken)]
        more = {1: "", 2: " (and 1 more file)"}.get(number, f" (and {number - 1} more files)")
        assert last == f"Not computed in this run: results/verdict.txt was made with other settings{more}."
