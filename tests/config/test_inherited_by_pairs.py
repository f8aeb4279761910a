"""A pair of other surfaces that has the name of one of the paper's does not leave out attraction across gaps."""

import pytest
from configurations import problems

from stiction.config.files import joined, load
from stiction.config.reading import paper

OF_PAPER = "attraction", "coarser_mesh"


def pair(name, **stated):
    """Pair of a complete configuration that states some keys of it."""
    return load({"pairs": {name: stated}})["pairs"][name]


@pytest.mark.parametrize("name", "abc")
@pytest.mark.parametrize("side", ["beam", "substrate"])
def test_other_surfaces_inherit_nothing_that_is_meant_for_the_paper(name, side):
    known = paper()["pairs"][name]
    other = next(surface for surface in paper()["surfaces"] if surface != known[side])
    assert set(pair(name, **{side: other})).isdisjoint(OF_PAPER)
    assert pair(name, **{side: other, "attraction": "touching"})["attraction"] == "touching"
    for same in ({side: known[side]}, {"gap_um": 10}, {}):
        assert {key: pair(name, **same)[key] for key in OF_PAPER} == {key: known[key] for key in OF_PAPER}


def test_what_an_earlier_file_states_stays():
    first = {"pairs": {"b": {"beam": "B1", "attraction": "touching"}}}
    assert load(first, {"pairs": {"b": {"gap_um": 7}}})["pairs"]["b"]["attraction"] == "touching"


@pytest.mark.parametrize("wrong", [5, ["B2"], None])
def test_what_is_no_pair_is_refused_by_its_key_whatever_came_before(wrong):
    before = {"pairs": {"b": {"beam": "B1"}}}
    assert problems(joined(before)) == ()
    for more in ({"pairs": {"b": wrong}}, {"pairs": wrong}):
        key = "pairs.b" if more["pairs"] != wrong else "pairs"
        assert any(line.startswith(f"{key} is {wrong!r}, must be a section") for line in problems(joined(before, more)))
