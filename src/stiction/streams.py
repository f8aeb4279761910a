"""Random streams with an address: a piece of work draws the same numbers in every order and on every machine."""

import operator
import zlib

import numpy as np


def stream(root_seed, *key):
    """Return the generator that belongs to one piece of work.

    ``stream(seed, "beam", "B2", 17)`` is independent of every other key's numbers and of how the work is batched;
    for integer keys it is the child that ``SeedSequence(seed).spawn`` reaches along the key.

    Parameters
    ----------
    root_seed : int
        Seed of the whole study.
    *key : str or int
        Address: stage, name, number, ...

    Returns
    -------
    numpy.random.Generator
    """
    path = tuple(zlib.crc32(k.encode()) if isinstance(k, str) else operator.index(k) for k in key)
    return np.random.Generator(np.random.SFC64(np.random.SeedSequence(root_seed, spawn_key=path)))
