"""The index of a folder is made again when a file of the folder or the code changes, and only then."""

import json

import pytest

from stiction.command import index
from stiction.config.files import load
from stiction.run.provenance import record


@pytest.fixture
def results(tmp_path, monkeypatch):
    """Results of a run without devices, among the files of Snakemake."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".snakemake").mkdir()
    record("results/provenance.json", tmp_path, load({"run": {"pairs": ["b"]}}))
    return tmp_path / "results"


@pytest.fixture
def made(monkeypatch):
    """Pages that are made, in place of those of the configuration."""
    pages = []
    monkeypatch.setattr(index, "_page", lambda results: pages.append(f"page {len(pages)}") or pages[-1])
    return pages


def test_an_index_is_made_once_until_something_changes(results, made, monkeypatch):
    def page():
        """Text of the index after another call."""
        return index.write_for_last_run(results).read_text(encoding="utf-8")

    assert [page(), page()] == ["page 0"] * 2
    (results / "index.html").write_text("damaged")
    assert page() == "page 0"
    (results / "table.md").write_text("new")
    assert [page(), page()] == ["page 1"] * 2
    (results.parent / ".snakemake" / "configuration.json").write_text(json.dumps({}))
    assert page() == "page 2"
    monkeypatch.setattr(index, "hashes", lambda *_: {"changed": ""})
    assert [page(), page()] == ["page 3"] * 2
    assert len(made) == 4


def test_a_folder_without_a_run_has_no_index_and_nothing_is_kept_beside_it(tmp_path):
    (tmp_path / "results").mkdir()
    assert index.write_for_last_run(tmp_path / "results") is None
    assert list(tmp_path.iterdir()) == [tmp_path / "results"]
