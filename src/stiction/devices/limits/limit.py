"""Limit of a result as data: what it leaves out or exceeds, on which side it errs, and by how much.

Rules find limits, most of them in `stiction.devices.limits.rules`. `stiction.report.limits.words` puts them in words.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any


class Side(StrEnum):
    """Side on which a stated number errs because of a limit."""

    SAFE = "safe"  #: the device sticks less than stated
    UNSAFE = "unsafe"  #: the device sticks more than stated
    EITHER = "either"  #: to either side, or it is not known whether at all


@dataclass(frozen=True)
class Limit:
    """What a stated number leaves out or exceeds.

    Examples
    --------
    >>> Limit("spacer", Side.UNSAFE, bounded=False, numbers={"name": "FDTS"}).forbids
    True
    """

    kind: str  #: key of the rule that found it; each kind has one sentence
    side: Side
    bounded: bool  #: whether the error of the number itself is known: within its band, or stated beside it
    #: Relative change of lengths or forces by the effect, perhaps only of their mean or under other conditions, NaN if
    #: it is not known [-]. It follows from the numbers, and NaN differs from itself: comparisons leave it out.
    amount: float = field(default=math.nan, compare=False)
    #: What its sentence needs: text, numbers in SI units, and lists of them.
    numbers: Mapping[str, Any] = field(default_factory=dict, hash=False)

    @property
    def forbids(self) -> bool:
        """Whether it forbids relying on a number: it errs on the unsafe side by an unknown amount."""
        return self.side is Side.UNSAFE and not self.bounded

    def stored(self) -> dict[str, Any]:
        """Fields for a file of JSON, which has no NaN."""
        amount = None if math.isnan(self.amount) else self.amount
        return {
            "kind": self.kind,
            "side": str(self.side),
            "bounded": self.bounded,
            "amount": amount,
            "numbers": dict(self.numbers),
        }


def restored(fields: Mapping[str, Any]) -> Limit:
    """Limit from its stored fields, the inverse of `Limit.stored`.

    Examples
    --------
    >>> spacer = Limit("spacer", Side.UNSAFE, bounded=False, numbers={"name": "FDTS"})
    >>> restored(spacer.stored()) == spacer
    True
    """
    amount = math.nan if fields["amount"] is None else fields["amount"]
    return Limit(**{**fields, "side": Side(fields["side"]), "amount": amount})
