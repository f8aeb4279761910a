"""Names of cases in files, and the word ``dry`` for the humidity of dry air in configurations."""

import re
from collections.abc import Sequence
from functools import cache
from typing import Any

from stiction.contact.air import DRY, DRY_AIR, Air, is_possible

#: Pattern of a name in paths. No ``_`` in it is followed by the excluded text, which follows names.
_NAME = "[A-Za-z][A-Za-z0-9-]*(?:_(?!{})[A-Za-z0-9-]*)*"
#: Pattern of the name of a device, or of an array of test beams, before air.
BEFORE_AIR = _NAME.format("dry|rh0")
#: Pattern of a case in paths: name of the pair or device, two to four decimals of the relative humidity, or dry.
CASE = BEFORE_AIR + "_(?:rh0[0-9]{2,4}|dry)"
#: Pattern of a `PairInAir` in paths, before air or the sides of a patch.
PAIR_IN_AIR = _NAME.format("dry|rh0|[0-9]+x[0-9]") + "(?:_dry)?"
#: Studies of pairs in humid air alone.
IN_HUMID_AIR = ("full_contact", "asperities", "pressing", "variants")
#: Why dry air is refused without attraction across gaps, as the end of a sentence.
TOO_LITTLE = "without attraction across gaps, energies in dry air are 5 to 30 times too small, which is the unsafe side"
#: Keys of humidities in a configuration.
_HUMIDITIES = ("humidity", "humidities")
#: Levels above ``test_beams.T.crack_lengths[0].humidity``, the deepest of them.
_LEVELS = 5
#: Requirement on a humidity, as part of an error message.
NAMEABLE = "have at most 4 decimals, because the names of files contain them"


class PairInAir(str):
    """Name of the contact of a pair: the pair's in any humid air, or another in dry air, with other summits.

    Examples
    --------
    >>> humid, dry = PairInAir("b"), PairInAir.in_dry_air("b")
    >>> dry, dry.pair, dry.medium, humid.pair, humid.medium
    ('b_dry', 'b', 'dry', 'b', None)
    """

    @classmethod
    def in_dry_air(cls, pair: str) -> "PairInAir":
        """Contact of a pair in dry air. Its summits attract each other through air."""
        return cls(pair + DRY_AIR.ending)

    @property
    def pair(self) -> str:
        """Name of the pair."""
        return self.removesuffix(DRY_AIR.ending)

    @property
    def ending(self) -> str:
        """End of the name, empty in humid air."""
        return self.removeprefix(self.pair)

    @property
    def medium(self) -> str | None:
        """Medium of the attraction between its summits, if not the configuration's."""
        return DRY if self.ending else None


class Case(str):
    """Name of a pair, or of a device, at a relative humidity or in dry air, from `case_id`.

    Its parts raise a ValueError if `case_id` returns no such name.

    Examples
    --------
    >>> Case("b_rh067").pair, Case("b_rh067").humidity, Case("C1_dry").device, Case("C1_dry").humidity
    ('b', 0.67, 'C1', 0.0)
    """

    @property
    def pair(self) -> str:
        """Name of its pair."""
        return _parts(self)[0]

    device = pair  #: name of its device, in cases of devices

    @property
    def humidity(self) -> float:
        """Relative humidity [-]."""
        return _parts(self)[1]


@cache
def _parts(case):
    """Pair and humidity of a case, the inverse of `case_id`. A plan asks for them ten times for each job."""
    pair, _, digits = case.removesuffix(DRY_AIR.ending).partition("_rh0")
    valid = re.fullmatch(CASE, case)
    humidity = float(f"0.{digits or 0}") if valid else 0.0
    if not valid or case_id(pair, humidity) != case:
        raise ValueError(
            f"{str(case)!r} is not a case, must be like b_rh067 for pair b at relative humidity 0.67, or b_dry"
        )
    return pair, humidity


def case_id(pair: str, humidity: float | str) -> Case:
    """Name of the case of a pair at a relative humidity [-], or in dry air, safe in paths and wildcards.

    Raises
    ------
    ValueError
        If the humidity is neither in (0, 1) nor that of dry air, or has more than four decimals.

    Examples
    --------
    >>> case_id("b", 0.67), case_id("b", 0.6), case_id("b", 0.675), case_id("b", "dry"), case_id("b", 0)
    ('b_rh067', 'b_rh060', 'b_rh0675', 'b_dry', 'b_dry')
    """
    humidity = in_numbers(humidity)
    ending = Air(humidity).ending if is_possible(humidity) else None
    if ending is None:
        raise ValueError(f"humidity {humidity} of pair {pair} must be dry, or above 0, below 1 and {NAMEABLE}")
    return Case(pair + ending)


def in_numbers(value: Any, key: str = "humidity", levels: int = _LEVELS) -> Any:
    """Humidity, or configuration with its humidities, with 0 for the word ``dry``. ``key`` is the value's.

    Values below more levels of sections and lists than any humidity has are left as they are.

    Examples
    --------
    >>> in_numbers("dry"), in_numbers({"pairs": {"dry": {"humidities": ["dry", 0.45], "beam": "dry"}}})
    (0.0, {'pairs': {'dry': {'humidities': [0.0, 0.45], 'beam': 'dry'}}})
    """
    if isinstance(value, dict) and levels:
        return {name: in_numbers(inner, name, levels - 1) for name, inner in value.items()}
    if isinstance(value, list) and levels:
        return [in_numbers(inner, key, levels - 1) for inner in value]
    return DRY_AIR.humidity if value == DRY and key in _HUMIDITIES else value


def in_words(value: Any, path: Sequence[str | int]) -> Any:
    """Value of a key, for messages: a humidity of 0 is called dry.

    Examples
    --------
    >>> in_words([0.0, 0.45], ("pairs", "b", "humidities")), in_words(0.0, ("pairs", "b", "humidities", 0))
    (['dry', 0.45], 'dry')
    >>> in_words([0.0, 1.0], ("devices", "C1", "shares"))
    [0.0, 1.0]
    """
    if not any(key in _HUMIDITIES for key in path):
        return value
    if isinstance(value, list):
        return [in_words(item, path) for item in value]
    return DRY if type(value) is float and value == DRY_AIR.humidity else value
