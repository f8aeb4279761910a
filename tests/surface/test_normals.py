import numpy as np
import pytest

from stiction.streams import stream
from stiction.surface.normals import standard_normal

#: Bits of a random number: layer of the ziggurat, sign, and magnitude in steps of the layer's width.
LAYERS, SIGN, MAGNITUDE = np.arange(256), 8, 9
MOST = 2**23 - 1
#: State c of SFC64 for which the second number, 9c + 1, ends in bits that are nearly all set: the tail accepts them.
ACCEPTED = pow(9, -1, 2**32) * (2**32 - 2**12) % 2**32


def numpys(rng, n):
    return rng.standard_normal(n, dtype=np.float32)


def state_of(rng):
    state = rng.bit_generator.state
    return [*state["state"]["state"].tolist(), state["has_uint32"], state["uinteger"]]


def same(rngs, n):
    """Whether both ways draw the same n numbers, to the sign of zero, and leave the same state."""
    ours, theirs = rngs
    one, other = standard_normal(ours, n), numpys(theirs, n)
    return one.dtype == np.float32 and one.tobytes() == other.tobytes() and state_of(ours) == state_of(theirs)


def beginning_with(low, high):
    """Generator whose first 64 random bits are the halves ``low`` and ``high``: their sum is all that SFC64 returns."""
    source = np.random.SFC64(0)
    first = (int(high) << 32) | int(low)
    source.state = source.state | {"state": {"state": np.array([first, 0, ACCEPTED, 0], np.uint64)}}
    return np.random.Generator(source)


def both_beginning_with(low, high):
    return beginning_with(low, high), beginning_with(low, high)


def last_inside(layer):
    """Largest magnitude of a layer that is accepted without a second random number."""

    def accepted(magnitude):
        rng = beginning_with(layer | magnitude << MAGNITUDE, 0)
        numpys(rng, 1)
        return rng.bit_generator.state["has_uint32"] == 1  # the other half is left

    low, high = -1, MOST + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if accepted(middle) else (low, middle)
    return low


def test_numbers_and_final_state_are_those_of_numpy_bit_for_bit():
    for k in range(3):
        assert same((stream(1, k), stream(1, k)), 2_000_001)


@pytest.mark.parametrize("n", [0, 1, 2, 3, 10])
def test_numbers_continue_where_a_generator_stands_even_in_the_middle_of_a_random_number(n):
    rngs = stream(1, n), stream(1, n)
    for _ in range(4):
        assert same(rngs, n)
        for rng in rngs:
            rng.integers(9, size=3, dtype=np.uint32)  # leaves half of a number, or uses the half that was left
    assert rngs[0].random() == rngs[1].random()


@pytest.mark.parametrize("sign", [0, 1])
def test_every_layer_ends_at_the_same_magnitude_as_in_numpy(sign):
    for layer in LAYERS:
        last = last_inside(layer)
        for magnitude in np.clip([0, 1, last - 1, last, last + 1, MOST], 0, MOST):
            assert same(both_beginning_with(layer | sign << SIGN | magnitude << MAGNITUDE, 2**31), 1), layer


def test_numbers_at_the_edge_of_a_layer_are_accepted_below_the_same_height_as_in_numpy():
    for layer in LAYERS[1:]:
        low = layer | (last_inside(layer) + MOST) // 2 << MAGNITUDE

        def accepted(share, low=low):
            rng = beginning_with(low, share << 8)
            numpys(rng, 1)
            return int(rng.bit_generator.state["state"]["state"][3]) == 1  # no further random number was used

        below, above = 0, 2**24
        while above - below > 1:
            middle = (below + above) // 2
            below, above = (middle, above) if accepted(middle) else (below, middle)
        for share in np.clip([0, below - 1, below, above, 2**24 - 1], 0, 2**24 - 1):
            assert same(both_beginning_with(low, share << 8), 1), layer


@pytest.mark.parametrize("sign", [0, 1])
def test_numbers_in_the_tail_are_those_of_numpy_with_the_sign_that_it_takes(sign):
    tails = []
    for share in range(0, 2**32, 2**24 + 1):
        low = sign << SIGN | MOST << MAGNITUDE
        assert same(both_beginning_with(low, share), 1)
        low = sign << SIGN | (MOST - 2**8) << MAGNITUDE
        assert same(both_beginning_with(low, share), 1)
        tails.append(standard_normal(beginning_with(low, share), 1)[0])
    assert np.abs(tails).min() > 3.65
    assert np.abs(tails).max() > 5


def test_numbers_of_other_generators_are_drawn_by_numpy():
    for kind in (np.random.PCG64, np.random.MT19937):
        ours, theirs = (np.random.Generator(kind(5)) for _ in range(2))
        np.testing.assert_array_equal(standard_normal(ours, 1000), numpys(theirs, 1000))
        assert ours.random() == theirs.random()


def test_streams_have_the_generator_that_is_compiled():
    assert stream(1).bit_generator.state["bit_generator"] == "SFC64"
