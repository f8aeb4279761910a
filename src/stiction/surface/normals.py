"""Normal random numbers in single precision, for the waves of random fields.

The numbers are those of ``numpy.random.Generator.standard_normal``, bit for bit, in a quarter of its time: the
ziggurat of G. Marsaglia and W. W. Tsang (J. Stat. Softw. 5 (8), 2000) with 256 layers, compiled together with the
generator SFC64 (C. Doty-Humphrey, PractRand) that `stiction.streams` uses. The jobs of the paper draw two times 46 200
strips, for which NumPy's would take a minute more, 8 % of their time.
"""

from math import erfc

import numpy as np
from numba import float32, uint32, uint64

from stiction.kernels import kernel

#: Start of the tail of the normal density that lies in the lowest layer [-].
_TAIL = 3.6541528853610088
#: Number of layers, and steps of a random magnitude within the width of a layer.
_LAYERS, _STEPS = 256, 2**23


def _layers() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Layers of equal area under exp(-x²/2), the lowest first: step of x, steps certainly inside, density at the end.

    The lowest layer includes the tail; it is as wide as a rectangle of its area would be.
    """
    area = _TAIL * np.exp(-(_TAIL**2) / 2) + np.sqrt(np.pi / 2) * erfc(_TAIL / np.sqrt(2))
    ends = [_TAIL]
    while len(ends) < _LAYERS - 1:
        ends.append(np.sqrt(-2 * np.log(area / ends[-1] + np.exp(-(ends[-1] ** 2) / 2))))
    ends = np.array([0.0, *reversed(ends)])
    density = np.exp(-(ends**2) / 2)
    width = np.r_[area / density[-1], ends[1:]]
    inside = np.r_[_TAIL, ends[:-1]] / width
    steps = np.rint(inside * _STEPS).astype(np.uint32)
    return (width / _STEPS).astype(np.float32), steps, density.astype(np.float32)


_STEP, _INSIDE, _DENSITY = _layers()


def standard_normal(rng: np.random.Generator, n: int) -> np.ndarray:
    """Numbers (n,) float32 of ``rng.standard_normal(n, dtype=np.float32)``. The generator ends in the same state."""
    state = rng.bit_generator.state
    if state["bit_generator"] != "SFC64":
        return rng.standard_normal(n, dtype=np.float32)
    normals, numbers = np.empty(n, np.float32), state["state"]["state"]
    has_half, half = _fill(numbers, bool(state["has_uint32"]), state["uinteger"], normals)
    rng.bit_generator.state = state | {"has_uint32": int(has_half), "uinteger": int(half)}
    return normals


# A source of random bits is (a, b, c, counter, held, half): the state of SFC64, and whether the other half of its last
# number is still to be used. As a tuple it stays in registers.


@kernel
def _bits(source):
    """Next 32 random bits, and the source after them: lower half of a number of SFC64, then its upper half."""
    a, b, c, counter, has_half, half = source
    if has_half:
        return uint32(half), (a, b, c, counter, False, half)
    number = a + b + counter
    a, b, c = b ^ (b >> uint64(11)), c + (c << uint64(3)), ((c << uint64(24)) | (c >> uint64(40))) + number
    return uint32(number & uint64(0xFFFFFFFF)), (a, b, c, counter + uint64(1), True, number >> uint64(32))


@kernel
def _uniform(source):
    """Uniform number in [0, 1) of 24 bits, and the source after it."""
    bits, source = _bits(source)
    return float32(bits >> uint32(8)) * float32(2**-24), source


@kernel
def _beyond(source):
    """Magnitude of a normal number in the tail, and the source after it."""
    while True:
        first, source = _uniform(source)
        second, source = _uniform(source)
        excess = float32(-1 / _TAIL) * np.log1p(-first)
        if -2 * np.log1p(-second) > excess * excess:
            return float32(_TAIL) + excess, source


@kernel
def _at_the_edge(source, layer, steps, x):
    """Accept or reject a number in the part of a layer crossed by the density. Return this, number and source."""
    if layer == 0:
        magnitude, source = _beyond(source)
        return True, -magnitude if steps & uint32(0x100) else magnitude, source
    share, source = _uniform(source)
    height = (_DENSITY[layer - 1] - _DENSITY[layer]) * share + _DENSITY[layer]
    return height < np.exp(-0.5 * np.float64(x) * np.float64(x)), x, source


@kernel
def _fill(numbers, has_half, half, normals):
    """Fill ``normals`` (n,). Advances ``numbers`` (4,), the state of SFC64, and returns the rest of the source."""
    source = (numbers[0], numbers[1], numbers[2], numbers[3], has_half, uint64(half))
    k = 0
    while k < normals.size:
        bits, source = _bits(source)
        layer, steps = bits & uint32(_LAYERS - 1), bits >> uint32(9)
        x = float32(steps) * _STEP[layer]
        x = -x if bits & uint32(_LAYERS) else x
        accepted = True
        if steps >= _INSIDE[layer]:
            accepted, x, source = _at_the_edge(source, layer, steps, x)
        if accepted:
            normals[k] = x
            k += 1
    numbers[0], numbers[1], numbers[2], numbers[3], has_half, half = source
    return has_half, half
