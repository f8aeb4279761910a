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
