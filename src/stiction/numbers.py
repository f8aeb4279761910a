"""Comparison of lengths up to rounding."""

import numpy as np


def is_multiple(whole: float, part: float) -> bool:
    """Whether ``whole`` is 1, 2, 3, ... times ``part``, up to rounding.

    Examples
    --------
    >>> is_multiple(0.3, 0.1), is_multiple(0.3, 0.2), is_multiple(0.1, 0.3)
    (True, False, False)
    """
    return bool(np.isclose(whole / part, max(1, round(whole / part)), rtol=1e-9))
