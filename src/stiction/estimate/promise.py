"""Promise about the size to use at once, in the words of the command and of the page. Plain Python."""


def kept(confidence: str) -> float:
    """Devices out of 100 whose true size is on the safe side of one end of an interval of a confidence [%].

    ASSUME: as many true sizes lie beyond either end. docs/tables/estimate.md counts those beyond the end to use.
    """
    return (100 + float(confidence)) / 2


def promise(confidence: str, is_force: bool) -> str:
    """Sentence on the end of an interval that a length or force to use is taken from.

    Examples
    --------
    >>> promise("90", is_force=False)
    'For 95 of 100 such devices a run finds a longer length.'
    """
    size = "smaller force" if is_force else "longer length"
    return f"For {kept(confidence):g} of 100 such devices a run finds a {size}."
