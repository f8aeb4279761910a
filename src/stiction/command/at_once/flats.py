"""Sentences on what flat surfaces hold, beside an estimate."""

from stiction.command.at_once import life
from stiction.estimate.answer import Estimate


def sentences(estimate: Estimate, symbol: str) -> str:
    """Size that flat surfaces hold and what it is not, with the symbol of its unit."""
    asked, bound = estimate.question, estimate.flat
    start = "Without its voltage, flat" if asked.is_driven else "Flat"
    flat = f"{start} surfaces" if all(map(asked.is_dry, asked.humidities)) else f"{start}, flooded surfaces"
    size = f"{life.bound(bound.size, asked.unit, estimate.is_force)} {symbol}"
    if estimate.is_force:
        return f"{flat} hold {size}. No surface of this area holds more."
    if bound.at_tip is None:
        return f"{flat} stick from {size} on. No surface sticks at a shorter length."
    tip = f"{life.bound(bound.at_tip, asked.unit)} {symbol}"
    where = f"from {tip} on at the tip and from {size} on along the underside"
    return f"{flat} stick {where}. Rough ones can stick harder, but at the tip alone."
