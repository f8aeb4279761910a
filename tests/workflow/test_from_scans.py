"""The workflow from files of a microscope: the same numbers as in one process, warnings, and bad files."""

import shutil

import pytest
import yaml
from conftest import BEAMS, TINY, copied, snakemake
from numpy.testing import assert_array_equal
from written_scans import BAD, bad_files, etched, scans_of

from stiction.config.files import load
from stiction.run.storage import load as dataset
from stiction.stages.surfaces import estimate, surface_flags
from stiction.study import PairStudy

#: Results that depend on the stages of measured surfaces in different ways.
TARGETS = [BEAMS, "results/tables/table_1.csv", "results/studies/variants/b_rh088_every_2.nc",
           "results/studies/sensitivity/b_rms.nc"]  # fmt: skip


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Folder of a finished run from scans, and its configuration file."""
    folder = tmp_path_factory.mktemp("scans")
    tiny = folder / "tiny.yaml"
    tiny.write_text(TINY)
    scans_of(folder, count=2)
    mine = folder / "mine.yaml"
    changes = etched("B2-0.gwy", "B2-1.gwy", psd="tabulated") | {"studies": {"variants": {"every": [2]}}}
    mine.write_text(yaml.safe_dump(changes))
    run = tmp_path_factory.mktemp("run")
    snakemake(run, *TARGETS, configs=[tiny, mine])
    return run, [tiny, mine]


@pytest.mark.slow
def test_the_workflow_gives_the_numbers_of_one_process(finished):
    run, configs = finished
    few, end = (f"^surface Etched: {flag}" for flag in ("only", "beyond 12. rad/µm the scans show"))
    with pytest.warns(UserWarning, match=few), pytest.warns(UserWarning, match=end):
        study = PairStudy.of(load(*configs), "b")
    contact = dataset(run / "results/contact/b_NG.nc", "contact")
    for name in ("solid_pressure", "bearing_area"):
        assert_array_equal(contact[name], study.contact[name])
    beams = dataset(run / BEAMS, "beams")
    assert_array_equal(beams.crack_length, study.beams(0.88)["crack_length"])


@pytest.mark.slow
def test_table_1_compares_with_the_estimate(finished):
    run, _ = finished
    found = estimate.statistics(dataset(run / "results/estimate/Etched.nc", "estimate"))
    rows = (run / "results/tables/table_1.csv").read_text().splitlines()
    names, row = (line.split(",") for line in (rows[0], next(row for row in rows if row.startswith("Etched,NG"))))
    cells = dict(zip(names, row, strict=True))
    for key, value in found.items():
        assert float(cells[f"{key}_afm"]) == pytest.approx(value)


@pytest.mark.slow
def test_flags_are_in_the_log_and_in_the_dataset(finished):
    run, _ = finished
    flags = surface_flags.flags(dataset(run / "results/estimate/Etched.nc", "estimate"))
    log = (run / "results/logs/estimate/Etched.log").read_text()
    assert any(flag.startswith("only") for flag in flags)
    assert all(f"UserWarning: surface Etched: {flag}\n" in log for flag in flags)


@pytest.mark.slow
def test_nothing_reruns_in_another_folder_with_copied_files_of_equal_content(finished, tmp_path):
    run, (tiny, mine) = finished
    copied(run, tmp_path / "run")
    moved = tmp_path / "elsewhere"
    shutil.copytree(mine.parent, moved)
    done = snakemake(tmp_path / "run", *TARGETS, "-n", configs=[moved / tiny.name, moved / mine.name])
    assert "Nothing to be done" in done.stdout


@pytest.mark.slow
def test_scans_are_evaluated_without_a_pair(planner, tmp_path):
    (good,) = scans_of(tmp_path)
    overlay = tmp_path / "mine.yaml"
    overlay.write_text(yaml.safe_dump({"surfaces": {"Etched": {"scans": {"files": [good.name]}}}}))
    rules = {rule for rule, _ in planner.outputs("scans", "--directory", tmp_path, config=[overlay]).values()}
    assert rules == {"scan", "estimate", "surface_sheet", "table_scans"}


@pytest.fixture(scope="module")
def bad(tmp_path_factory):
    """Folder with unusable files, and what is wrong with each."""
    folder = tmp_path_factory.mktemp("bad")
    (good,) = scans_of(folder)
    return folder, bad_files(folder, good)


@pytest.mark.slow
@pytest.mark.parametrize("name", BAD)
def test_an_unusable_file_stops_before_the_first_job_in_one_sentence(planner, bad, tmp_path, name):
    folder, known = bad
    keys, key, sentence = known[name]
    others = {other: value for other, value in keys.items() if other != "files"}
    beside = [path.name for path in keys.get("files", [])]
    overlay = folder / "mine.yaml"
    overlay.write_text(yaml.safe_dump(etched(*beside, name.strip(), **others)))
    status, printed = planner("--directory", tmp_path, "--cores", 1, config=[overlay])
    assert status == 1
    (line,) = [line for line in printed.splitlines() if line.startswith("surfaces.")]
    assert line.startswith(f"surfaces.Etched.scans.{key} {sentence}")
    assert "Traceback" not in printed
    assert not (tmp_path / "results").exists()
