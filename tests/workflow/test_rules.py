"""The text of the rules says what Snakemake does: which rule follows which, and what each does."""

import re
import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import reruns  # noqa: E402
import rules  # noqa: E402


def edges(printed):
    """Pairs of rules in the graph of Snakemake, each before the one that reads its results."""
    names = dict(re.findall(r'^\s*(\d+)\[label = "(\w+)"', printed, re.MULTILINE))
    return {(names[first], names[second]) for first, second in re.findall(r"(\d+) -> (\d+)", printed)}


@pytest.fixture(scope="module")
def graph(planner):
    status, printed = planner("--rulegraph", "--forceall")
    assert status == 0, printed
    return edges(printed)


@pytest.mark.slow
def test_every_rule_reads_what_its_text_says(graph):
    targets = {"all", "verdict"}  # verdict waits for all files
    stated = {(read, name) for name in rules.reads() for read in rules.read_by(name)}
    drawn = {(first, second) for first, second in graph if second not in targets}
    assert len(drawn) > 60
    assert drawn <= stated


def test_every_stage_is_in_one_file_of_rules(monkeypatch):
    text = "".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
    assert sorted(re.findall(r'^(?:rule (\w+):|define\("(\w+)"\))', text, re.MULTILINE)) == sorted(
        (name, "") if name in rules.CHAIN else ("", name) for name in rules.stages()
    )
    rooms = {room: place for room, place in rules.ROOMS.items() if room != "laws"}
    monkeypatch.setattr(rules, "ROOMS", rooms)
    with pytest.raises(ValueError, match=r"no file of rules has .*fit \(stiction.stages.laws.fit\)"):
        rules.texts()


@pytest.mark.slow
def test_the_picture_has_the_chain_of_the_graph(graph):
    chained = {(first, second) for first, second in graph if {first, second} <= {*rules.CHAIN}}
    assert chained | {("identification", "spectrum")} >= {*rules.links()}  # read by identified surfaces alone
    parts = re.findall(r'font-weight="600">(\w+)<', rules.picture())
    assert parts == [*rules.CHAIN]
    assert "var(" not in rules.picture()


@pytest.mark.slow
def test_the_list_of_rules_says_what_each_does(planner):
    status, printed = planner("--list-rules")
    listed = dict(re.findall(r"^(\w+)(?: \((.*)\))?$", printed, re.MULTILINE))
    assert status == 0
    assert {*rules.CHAIN, "all", "tables"} <= {*listed}
    assert [name for name, does in listed.items() if not does] == []


@pytest.mark.slow
def test_snakemake_finds_nothing_to_improve_but_environments(planner):
    _, printed = planner("--lint")
    faults = {*re.findall(r"^    \* (.*)$", printed, re.MULTILINE)}
    assert faults == {"Specify a conda environment or container for each rule.:"}


@pytest.mark.slow
def test_the_table_of_keys_and_the_rules_that_they_rerun_is_up_to_date():
    assert reruns.TABLE.read_text() == reruns.table(), "run make numbers"
