"""Surfaces with _ and - in their names: every file has one job, and its wildcards are the names."""

import pytest
from configurations import PAPER, problems

from stiction.config import files
from stiction.config.merging import merged
from stiction.plan.graph import Graph, stages
from stiction.plan.plan import Plan

#: Names that end, begin or continue as parts of names of files do.
NAMES = ("my_poly-1", "my_poly", "my", "B2_NG", "B2_0", "b", "a_rms", "rh067_G", "less-more_", "base", "x_dry")


@pytest.fixture(scope="module")
def graph():
    surfaces = PAPER["surfaces"] | {name: PAPER["surfaces"]["B2"] for name in NAMES}
    pair = PAPER["pairs"]["b"]
    pairs = {f"p{k}": pair | {"beam": name, "substrate": NAMES[k - 1]} for k, name in enumerate(NAMES)}
    return Graph(Plan(files.load(PAPER | {"surfaces": surfaces}, {"pairs": pairs, "run": {"pairs": ["b", *pairs]}})))


def test_every_file_has_one_job_with_the_wildcards_that_it_was_named_by(graph):
    """Names are written from wildcards of jobs, and wildcards found again from names."""
    seen = {}
    for stage, _ in stages().values():
        for at in stage.wanted(graph.plan):
            for pattern in stage.patterns(graph.plan).values():
                name = pattern.format(**at)
                assert seen.setdefault(name, (stage.name, dict(at))) == (stage.name, dict(at)), f"{name} has two jobs"
    inputs = {name for stage, at in seen.values() for name in names(graph, stage, at)}
    for name in inputs - seen.keys():
        found = [
            (stage, match.groupdict()) for stage, matches in graph._expressions if (match := matches.fullmatch(name))
        ]
        known = [(stage, at) for stage, at in found if at.get("surface") in (None, *graph.plan.config["surfaces"])]
        assert len(known) == 1, f"{name}: {known}"
        assert name in {pattern.format(**known[0][1]) for pattern in known[0][0].patterns(graph.plan).values()}


def names(graph, stage, at):
    """Names of the datasets that a job reads."""
    from stiction.plan.stage import At, File

    def flat(value):
        if isinstance(value, str):
            return [] if isinstance(value, File) else [value]
        return [one for part in (value.values() if isinstance(value, dict) else value) for one in flat(part)]

    declared = next(one for one, _ in stages().values() if one.name == stage)
    return flat(declared.inputs(graph.plan, At(**at)))


@pytest.mark.parametrize("name", NAMES)
def test_a_surface_may_have_such_a_name_and_a_pair_may_not(name):
    surface, pair = PAPER["surfaces"]["B2"], PAPER["pairs"]["b"]
    assert problems(merged(PAPER, {"surfaces": {name: surface}})) == ()
    if not name.isalnum():
        (line,) = problems(merged(PAPER, {"pairs": {name: pair}}))
        assert "is not a valid name, must be letters and digits, starting" in line


@pytest.mark.parametrize("name", ["dry_x", "_x", "-x", "x.y", "x y", "x\n", "2x", "ä"])
def test_other_names_of_surfaces_are_refused(name):
    (line,) = problems(merged(PAPER, {"surfaces": {name: PAPER["surfaces"]["B2"]}}))
    assert "must be letters and digits, _ and -, not dry_ at the beginning, starting with a letter" in line
