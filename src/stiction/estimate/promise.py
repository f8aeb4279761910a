"""Promise about the size to use at once, in the words of the command and of the page. Plain Python.

The size to use is an end of an interval, and only errors on one side of it are unsafe. Half of the interval towards
them is the larger of two split conformal quantiles: of the sizes of errors at the confidence of the interval, and of
the errors on the unsafe side at `kept`. The promise thus holds whatever the errors are distributed like.
"""


def kept(confidence: str) -> float:
    """Devices out of 100 whose true size is at least on the safe side of an end of an interval of a confidence [%]."""
    return (100 + float(confidence)) / 2


def promise(confidence: str, is_force: bool) -> str:
    """Sentence on the end of an interval that a length or force to use is taken from.

    Examples
    --------
    >>> promise("90", is_force=False)
    'For at least 95 of 100 such devices a run finds a longer length.'
    """
    size = "smaller force" if is_force else "longer length"
    return f"For at least {kept(confidence):g} of 100 such devices a run finds a {size}."
