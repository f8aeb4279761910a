"""Keys of cases, which name their files, and changes of single keys of the configuration.

Apart from `stiction.config.settings`, so that a change of what is said about wrong settings reruns nothing.
"""

import re

#: A case as it stands in paths: name of the pair, two to four decimals of the relative humidity.
CASE = "[A-Za-z][A-Za-z0-9]*_rh0[0-9]{2,4}"
#: What a humidity must do for that, in words.
NAMEABLE = "have at most 4 decimals, which name its files"


def case_id(pair, humidity):
    """Name of a pair at a relative humidity [-], safe in paths and wildcards.

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


def humidity_of(case):
    """Relative humidity [-] of a case.

    Raises
    ------
    ValueError
        If ``case`` is not what `case_id` returns.

    Examples
    --------
    >>> humidity_of("b_rh067")
    0.67
    """
    return _parted(case)[1]


def pair_of(case):
    """Name of the pair of a case; raises as `humidity_of`.

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


def decimals(humidity):
    """Humidity with two to four decimals, ``None`` if these do not hold it."""
    texts = (f"{humidity:.{places}f}" for places in (2, 3, 4))
    return next((text for text in texts if float(text) == humidity), None)


def merged(base, overlay):
    """Mapping ``base`` changed key by key, as Snakemake does; lists and numbers are replaced whole."""
    if not (isinstance(base, dict) and isinstance(overlay, dict)):
        return overlay
    return base | {key: merged(base.get(key), value) for key, value in overlay.items()}
