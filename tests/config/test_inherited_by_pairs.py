"""A pair of other surfaces that has the name of one of the paper's does not leave out attraction across gaps."""

import pytest

from stiction.config.files import load
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
