import ast
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from standard_errors import ALLOWED

from stiction.streams import stream


def numbers(*address):
    return tuple(stream(*address).standard_normal(4))


def test_numbers_do_not_depend_on_the_order_or_the_batching_of_the_work():
    def draw(samples):
        return {k: numbers(1, "surface", "B2", k) for k in samples}

    assert draw(range(6)) == draw([5, 2, 0]) | draw([4, 3, 1])


def test_integer_address_is_the_child_that_spawning_reaches():
    child = np.random.SeedSequence(7).spawn(3)[2].spawn(5)[4]
    expected = np.random.Generator(np.random.SFC64(child)).standard_normal(4)
    assert numbers(7, 2, 4) == tuple(expected)


def test_strings_enter_by_their_checksum_and_not_by_the_salted_hash_of_the_process():
    # Check value of CRC-32: the checksum of the digits 1 to 9.
    assert numbers(1, "123456789") == numbers(1, 0xCBF43926)


def test_every_part_of_the_address_changes_the_numbers():
    addresses = [
        (1,),
        (2,),
        (1, "beam"),
        (1, "beam", 0),
        (1, "beam", 1),
        (1, "beam", 0, 0),
        (1, 0, "beam"),
        (1, "strip", 0),
        (2, "beam", 0),
    ]
    assert len({numbers(*address) for address in addresses}) == len(addresses)


def test_neighbouring_streams_are_uncorrelated():
    n = 20_000
    streams = np.array([stream(1, "beam", k).standard_normal(n) for k in range(8)])
    correlation = streams @ streams.T / n
    off_diagonal = correlation[~np.eye(8, dtype=bool)]
    assert np.abs(off_diagonal).max() < ALLOWED / np.sqrt(n)
    shared = streams + stream(1).standard_normal(n)
    assert np.mean(shared[0] * shared[1]) > ALLOWED / np.sqrt(n)


def test_numpy_integer_is_the_same_address():
    assert numbers(1, "beam", np.int64(3)) == numbers(1, "beam", 3)


def test_a_float_is_not_a_valid_address():
    with pytest.raises(TypeError, match="float"):
        stream(1, "humidity", 0.45)


# Addresses spelled in the package

PACKAGE = Path(__file__).parents[1] / "src" / "stiction"


@cache
def spelled(path):
    """Addresses of the streams that a module makes, without the seed, and the number of its uses of `stream`.

    A part is a text or number, ``None`` for a variable, or ``...`` for any number of further parts.
    """
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    if not any(isinstance(node, ast.ImportFrom) and node.module == "stiction.streams" for node in nodes):
        return [], 0
    calls = [node for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)]
    direct = [call.args[1:] for call in calls if call.func.id == "stream"]
    partial = [call.args[2:] for call in calls if call.func.id == "partial" and ast.unparse(call.args[0]) == "stream"]
    found = [tuple(map(_part, parts)) for parts in direct] + [(*map(_part, parts), ...) for parts in partial]
    return found, sum(isinstance(node, ast.Name) and node.id == "stream" for node in nodes)


def _part(node):
    """One part of an address."""
    if isinstance(node, ast.Starred):
        return ...
    return node.value if isinstance(node, ast.Constant) else None


def may_be_equal(one, other):
    """Whether two addresses are equal for some values of their variables."""
    if one[:1] == (...,):
        return any(may_be_equal(one[1:], other[k:]) for k in range(len(other) + 1))
    if other[:1] == (...,):
        return may_be_equal(other, one)
    if not (one and other):
        return one == other
    return (None in (one[0], other[0]) or one[0] == other[0]) and may_be_equal(one[1:], other[1:])


def test_no_two_places_of_the_package_make_streams_of_the_same_address():
    found = [(path.stem, address) for path in sorted(PACKAGE.rglob("*.py")) for address in spelled(path)[0] if address]
    assert len(found) >= 14
    for (module, one), (other_module, other) in combinations(found, 2):
        assert not may_be_equal(one, other), f"{one} of {module} may be {other} of {other_module}"


def test_every_use_of_a_stream_spells_its_address():
    for path in sorted(PACKAGE.rglob("*.py")):
        found, uses = spelled(path)
        assert len(found) == uses, path


@pytest.mark.parametrize(
    ("one", "other", "equal"),
    [
        (("character", None, None), ("character", None, "field", None), False),
        (("beams", None, ...), ("beams", None, "mesh"), True),
        (("identification", None, ..., None), ("identification", None, "control", None), True),
        (("identification", None, ..., None), ("identification", None), False),
        (("chaos", None, None), ("rejection", None, None), False),
        (("estimate", None), ("estimate", "B2"), True),
        ((...,), (), True),
    ],
)
def test_addresses_that_may_be_equal_are_found(one, other, equal):
    assert may_be_equal(one, other) == may_be_equal(other, one) == equal
