"""The first answer of a run is said once, as soon as its job has ended."""

import io

import numpy as np
import pytest
import xarray as xr
from test_progress_line import Terminal
from test_run_state import end, heard, plan, start

from stiction.command.first_answer import first_answer
from stiction.command.progress_line import Display
from stiction.run import storage

LOG = "results/logs/devices/safe_lengths/{}.log"


def written(folder, case="C1_rh067", estimate=280e-6, surfaces_error=np.nan):
    """Write the safe lengths of a case, of which those of the last shape and the middle share are said; its log."""
    shape, share = ["S-shape", "S-shape or arc"], [1e-2, 1e-3, 1e-4]
    values = {"safe_length": 267e-6, "estimate": estimate, "beams_error": 4e-6, "surfaces_error": surfaces_error}
    others = {"safe_length": 1e-3, "estimate": 1e-3, "beams_error": 1e-3, "surfaces_error": 1e-3}
    said = np.zeros((2, 3), bool)
    said[1, 1] = True
    variables = {name: (("shape", "share"), np.where(said, values[name], others[name])) for name in values}
    if np.isinf(estimate):
        variables["beams_error"][1][1, 1] = np.nan
    path = folder / LOG.format(case).replace("logs/", "").replace(".log", ".nc")
    path.parent.mkdir(parents=True)
    storage.save(xr.Dataset(variables, {"shape": shape, "share": share}), path, "safe_lengths", {})
    return LOG.format(case)


def test_a_length_is_said_with_its_errors_by_beams_and_surfaces_if_it_has_one(tmp_path):
    log = written(tmp_path / "both", surfaces_error=3e-6)
    said = "First number: by simulation alone, C1 at RH 0.67 can be 267 µm long (estimate 280 ± 5 µm) if at most 1 in "
    said += "1000 may stick."
    assert first_answer(log, tmp_path / "both") == f"{said} The run goes on."
    assert "± 4 µm" in first_answer(written(tmp_path / "beams"), tmp_path / "beams")
    unknown = first_answer(written(tmp_path / "none", "L1_dry", np.inf), tmp_path / "none")
    assert unknown.startswith(
        "First number: by simulation alone, L1 in dry air can be 267 µm long if at most 1 in 1000"
    )


def test_a_share_of_stoppers_is_said_with_its_band_in_the_air_where_most_stick(tmp_path):
    path = tmp_path / "results" / "devices" / "stoppers" / "S1.nc"
    path.parent.mkdir(parents=True)
    stuck = [[0.1, 0.08, 0.12], [0.3, 0.281, 0.32]]
    found = {"stuck": (("humidity", "end"), stuck), "restoring_force": 19e-6}
    storage.save(xr.Dataset(found, {"humidity": [0.44, 0.67]}), path, "stoppers", {})
    said = "First answer: of S1 with 19 µN, 30 % (28.1 to 32 %) stick at RH 0.67 (95 % confidence)."
    assert first_answer("results/logs/devices/stoppers/S1.log", tmp_path) == f"{said} The run goes on."


@pytest.mark.parametrize("stream", [io.StringIO, Terminal])
def test_it_is_said_once_after_the_end_of_its_job(stream, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    log = written(tmp_path / "study")
    run = heard(plan(safe_lengths=2, beams=1), start(0, at=0), end(0, 5), start(1, "safe_lengths", 10, log=(log,)))
    monkeypatch.chdir(tmp_path / "study")
    display = Display(run, shown := stream(), tmp_path / "study")
    display(11)
    assert "First number" not in shown.getvalue()
    for number in (1, 2):
        run.hear(start(2, "safe_lengths", 12, log=(log.replace("C1", "C2"),)))
        run.hear(end(number, 20))
        display(20)
    display.close()
    assert shown.getvalue().count("alone, C1 at") == shown.getvalue().count("First number") == 1


def test_a_file_that_cannot_be_read_stops_no_run(tmp_path):
    run = heard(plan(safe_lengths=1), start(0, "safe_lengths", log=(LOG.format("C1_rh067"),)), end(0, 5))
    display = Display(run, shown := io.StringIO(), tmp_path)
    display(40)
    assert "First" not in shown.getvalue()
    assert "1 of 1 jobs" in shown.getvalue()
