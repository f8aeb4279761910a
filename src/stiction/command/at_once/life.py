"""Sentences on the life of a device beside its estimate, in the words of its page: drying, shock and voltage."""

import math
from collections.abc import Iterator

from stiction.config.units import from_si
from stiction.estimate.answer import Estimate
from stiction.rounding import bounding, grouped

#: What becomes of a beam that dries, by the number of bounds of its length that it exceeds, as on a page.
_FATES = ("stands", "may collapse", "collapses")


def sentences(estimate: Estimate, symbol: str) -> Iterator[str]:
    """Sentences on drying, then on shock and voltage at the size of a device, with the symbol of its unit."""
    yield from map(_drying, estimate.dried, estimate.dried.values())
    if estimate.dried and estimate.question.size is not None:
        yield _fates(estimate, symbol)
    yield from _touching(estimate, symbol)
    yield from _own_causes(estimate)


def bound(size: float, unit: str, up: bool = False) -> str:
    """Bound in a unit with three digits, on its safe side: rounded down, or ``up``.

    Examples
    --------
    >>> bound(199.26e-6, "um"), bound(199.26e-6, "uN", up=True), bound(1505780.1, "g")
    ('199', '200', '153 000')
    """
    text = bounding(from_si(size, unit), 3, up)
    return text if "." in text else grouped(float(text))


def as_stated(size: float, unit: str) -> str:
    """Size in a unit, as a device states it.

    Examples
    --------
    >>> as_stated(219.35e-6, "um")
    '219.35'
    """
    return f"{from_si(size, unit):g}"


def _drying(liquid, dried):
    """Lengths of beams that dry."""
    if math.isinf(dried.stands):
        return f"Beams of any length stand while {liquid} dries."
    stands, collapses, released = (bound(length, "um") for length in dried.lengths)
    shorter = "" if dried.is_released else "; shorter ones may, too"
    return (
        f"While {liquid} dries, beams stand up to {stands} µm and collapse beyond {collapses} µm; "
        f"after a collapse they stay down if they are longer than {released} µm{shorter}."
    )


def _fates(estimate, symbol):
    """What becomes of a beam of the stated length."""
    length, fates = estimate.question.size, {}
    for liquid, dried in estimate.dried.items():
        fates.setdefault((length > dried.stands) + (length > dried.collapses), []).append(liquid)
    texts = [f"{_FATES[fate]} while {' or '.join(liquids)} dries" for fate, liquids in fates.items()]
    return f"At {as_stated(length, estimate.question.unit)} {symbol} it {', and '.join(texts)}."


def _touching(estimate, symbol):
    """Voltage and shock below which a device does not touch, at its own size or another one, on its safe side."""
    touching, asked = estimate.touching, estimate.question
    limits = [] if math.isnan(touching.voltage) else [f"{bound(touching.voltage, 'V')} V"]
    limits += [] if math.isnan(touching.shock) else [f"a half-sine shock of {bound(touching.shock, 'g')} g"]
    if limits:
        safe = bound(touching.size, asked.unit, estimate.is_force)
        size = safe if asked.size is None else as_stated(asked.size, asked.unit)
        yield f"At {size} {symbol} it does not touch below {' or '.join(limits)}."


def _own_causes(estimate):
    """What the voltage and the shock of a device do to it."""
    touching, surroundings = estimate.touching, estimate.question.surroundings
    if (surroundings.potential or 0.0) >= touching.voltage:
        yield f"Its own voltage of {surroundings.potential:g} V can pull it in."
    if surroundings.shock and not math.isnan(touching.shock):
        shock = f"Its own shock of {from_si(surroundings.shock, 'g'):g} g"
        if surroundings.shock < touching.shock:
            yield f"{shock} does not bring it down."
        else:
            yield f"{shock} {'brings' if surroundings.shock >= touching.slow_shock else 'can bring'} it down."
