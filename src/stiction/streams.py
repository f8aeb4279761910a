"""Random streams by address: the numbers of a task do not depend on the machine or on the order of the tasks."""

import operator
import zlib

import numpy as np


def stream(root_seed: int, *key: str | int) -> np.random.Generator:
    """Random number generator of one task.

    ``stream(seed, "beam", "B2", 17)`` is independent of the streams of all other keys and of how the work is split
    into batches. For integer keys it is the descendant that successive calls of ``SeedSequence.spawn`` give, one call
    per integer.

    Parameters
    ----------
    root_seed : int
        Seed of the whole study.
    *key : str or int
        Address: stage, name, number, ...
    """
    path = tuple(zlib.crc32(k.encode()) if isinstance(k, str) else operator.index(k) for k in key)
    return np.random.Generator(np.random.SFC64(np.random.SeedSequence(root_seed, spawn_key=path)))
