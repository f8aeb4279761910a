"""Names of cases, which are used in file names."""

import re

#: Pattern of a case in paths: name of the pair, two to four decimals of the relative humidity.
CASE = "[A-Za-z][A-Za-z0-9]*_rh0[0-9]{2,4}"
#: Requirement on a humidity, as part of an error message.
NAMEABLE = "have at most 4 decimals, because the names of files contain them"


def case_id(pair: str, humidity: float) -> str:
    """Name of the case of a pair at a relative humidity [-], safe in paths and wildcards.

    Raises
    ------
    ValueError
        If the humidity is not in (0, 1) or has more than four decimals.

    Examples
    --------
    >>> case_id("b", 0.67), case_id("b", 0.6), case_id("b", 0.675)
    ('b_rh067', 'b_rh060', 'b_rh0675')
    """
    text = decimals(humidity)
    if not (0 < humidity < 1 and text):
        raise ValueError(f"humidity {humidity} of pair {pair} must be above 0, below 1 and {NAMEABLE}")
    return f"{pair}_rh{text.replace('.', '')}"


def humidity_of(case: str) -> float:
    """Relative humidity [-] of a case.

    Raises
    ------
    ValueError
        If `case_id` returns no such name.

    Examples
    --------
    >>> humidity_of("b_rh067")
    0.67
    """
    return _parted(case)[1]


def pair_of(case: str) -> str:
    """Name of the pair of a case; raises the errors of `humidity_of`.

    Examples
    --------
    >>> pair_of("b_rh067")
    'b'
    """
    return _parted(case)[0]


def _parted(case):
    """Pair and humidity of a case, the inverse of `case_id`."""
    pair, _, digits = case.partition("_rh0")
    humidity = float(f"0.{digits}") if re.fullmatch(CASE, case) else 0.0
    if not humidity or case_id(pair, humidity) != case:
        raise ValueError(f"{case!r} is not a case, must be like b_rh067 for pair b at relative humidity 0.67")
    return pair, humidity


def decimals(humidity: float) -> str | None:
    """Humidity with two to four decimals as text; ``None`` if four decimals are not exact."""
    texts = (f"{humidity:.{places}f}" for places in (2, 3, 4))
    return next((text for text in texts if float(text) == humidity), None)
