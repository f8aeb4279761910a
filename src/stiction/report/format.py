"""Units of tables and axes, and numbers as text: with a standard error, as a deviation, or alone."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from decimal import Decimal
from typing import Any

import numpy as np

from stiction.answer.sought import DIGITS, Sought
from stiction.config.mission.conditions import humidity_of
from stiction.contact.air import DRY_AIR, Air, has_dry, humid
from stiction.rounding import MISSING, bounding, number

#: Units in SI, for tables: the stored number is a quantity divided by its unit; a product may differ in the last bit.
NM, UM, NN, UN, PER_UM2 = 1e-9, 1e-6, 1e-9, 1e-6, 1e12
#: Factors from SI, for axes and sentences, mJ m⁻² among them; exact in single precision, in which most data are stored.
TO_NM, TO_UM, TO_UN, TO_MPA, TO_GPA, TO_MJ = 1e9, 1e6, 1e6, 1e-6, 1e-9, 1e3

#: Part of a value below which its standard error is rounding.
_ROUNDING = np.finfo(float).eps
#: Fraction beyond which digits of the rest are shown.
_NEARLY_ALL = 0.99


def percent(value: float, reference: float) -> float:
    """Deviation from a reference [%], NaN without one.

    Examples
    --------
    >>> round(percent(710, 700), 2), percent(710, 0)
    (1.43, nan)
    """
    return 100 * (value / reference - 1) if reference else np.nan


def safe_size(size: float, sought: Sought) -> str:
    """Size to build or a simulated limit with its unit, rounded to its safe side: lengths down, forces up.

    Examples
    --------
    >>> from stiction.answer.sought import FORCE, LENGTH
    >>> safe_size(200.66e-6, LENGTH), safe_size(12.341e-6, FORCE)
    ('200 µm', '12.4 µN')
    """
    return f"{bounding(size / sought.scale, DIGITS, sought.more_is_better)} {sought.shown}"


def humidity_text(value: float) -> str:
    """Text of a relative humidity, zero in dry air [-].

    Examples
    --------
    >>> humidity_text(0.67), humidity_text(0.0), humidity_text(float("nan"))
    ('0.67', 'dry', '–')
    """
    return DRY_AIR.name if Air(value).is_dry else number(value, "g")


def conditions_in_words(conditions: Iterable[Mapping[str, Any]]) -> str:
    """Conditions of a device, each with its air and its share of the touchdowns.

    Examples
    --------
    >>> conditions_in_words([{"temperature_C": 12, "dew_point_C": 10, "share": 0.1}])
    '12 °C at a dew point of 10 °C: RH 0.8755, 10 % of the touchdowns'
    >>> conditions_in_words([{"temperature_C": 60, "humidity": 0.3}, {"temperature_C": 85, "humidity": 0}])
    '60 °C: RH 0.3; 85 °C: dry'
    >>> conditions_in_words([{"temperature_C": -20, "dew_point_C": 10}])
    '-20 °C at a dew point of 10 °C: water condenses'
    """
    texts = []
    for condition in conditions:
        dew, air = condition.get("dew_point_C"), humidity_of(condition)
        at = f"{condition['temperature_C']:g} °C" + (f" at a dew point of {dew:g} °C" if dew is not None else "")
        air = "water condenses" if air is None else Air(air).choose(f"RH {air:g}", DRY_AIR.name)
        texts.append(
            f"{at}: {air}" + (f", {100 * condition['share']:.3g} % of the touchdowns" if "share" in condition else "")
        )
    return "; ".join(texts)


def listed(names: Sequence[str]) -> str:
    """Names in a sentence.

    Examples
    --------
    >>> listed(["a"]), listed(["a", "b"]), listed(["a", "b", "c"])
    ('a', 'a and b', 'a, b and c')
    """
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def airs(humidities: Collection[float]) -> str:
    """Air of a device, for the end of a sentence.

    Examples
    --------
    >>> airs([0.0, 0.45, 0.67]), airs([0.67]), airs([0.0])
    ('in dry air and at relative humidities of 0.45, 0.67', 'at a relative humidity of 0.67', 'in dry air')
    """
    values = [f"{humidity:g}" for humidity in humid(humidities)]
    dry = [DRY_AIR.where] * has_dry(humidities)
    wet = f"{'relative humidities' if len(values) > 1 else 'a relative humidity'} of {', '.join(values)}"
    return " and ".join(dry + [f"at {wet}"] * bool(values))


def with_error(value: float, error: float, sign: str = "") -> str:
    """Value ± standard error as text, to the second significant digit of the error, – for NaN.

    Examples
    --------
    >>> with_error(57.82009, 0.19801), with_error(-4.9, 0.042, "+"), with_error(94.2028, 3e-15)
    ('57.82 ± 0.20', '-4.900 ± 0.042', '94.2028 ± 0')
    """
    if np.isnan(value):
        return MISSING
    if 0 < error < _ROUNDING * abs(value):
        error = 0.0
    if not error > 0:
        return f"{number(value, f'{sign}g')} ± {number(error, 'g')}"
    digits = _decimals(error)
    return f"{number(value, f'{sign}.{digits}f')} ± {error:.{digits}f}"


def signed(value: float, error: float) -> str:
    """Change or deviation ± standard error as text, also with the sign +.

    Examples
    --------
    >>> signed(4.9, 0.042), signed(-4.9, 0.042)
    ('+4.900 ± 0.042', '-4.900 ± 0.042')
    """
    return with_error(value, error, "+")


def as_published(value: float, deviation: float) -> str:
    """Published value ± standard deviation as text, with the digits of the publication, – for NaN.

    Examples
    --------
    >>> as_published(716.0, 9.0), as_published(float("nan"), float("nan"))
    ('716 ± 9', '–')
    """
    return MISSING if np.isnan(value) else f"{number(value, 'g')} ± {number(deviation, 'g')}"


def fraction_with_band(share: float, low: float, high: float, unit: str = "") -> str:
    """Fraction of devices and its 95 % band in percent, – for NaN. A count of none or of all is a bound alone.

    Examples
    --------
    >>> fraction_with_band(0.0123, 0.0101, 0.01485), fraction_with_band(0.5, 0.48, 0.52, " %")
    ('1.23 (1.01 to 1.49)', '50 % (48 to 52 %)')
    >>> fraction_with_band(0.0, 0.0, 0.00037, " %"), fraction_with_band(1.0, 0.99963, 1.0)
    ('at most 0.037 %', 'at least 99.963')
    """
    if np.isnan(share):
        return MISSING
    if 0 < share < 1:
        return f"{100 * share:.3g}{unit} ({fraction_between(low, high, unit)})"
    return fraction_between(low if share else 0.0, high if share < 1 else 1.0, unit)


def fraction_between(low: float, high: float, unit: str = "") -> str:
    """Fraction of devices between two ends in percent, without ends of none and of all. Ends are rounded outwards.

    Examples
    --------
    >>> fraction_between(0.0101, 0.0149), fraction_between(0.0, 0.0003701, " %"), fraction_between(0.0, 1.0, " %")
    ('1.01 to 1.49', 'at most 0.0371 %', '0 to 100 %')
    >>> fraction_between(0.0, 0.9999995, " %"), fraction_between(0.99985, 0.99998)
    ('at most 99.99995 %', '99.985 to 99.998')
    """
    least, most = percent_bound(low, 3, up=False), percent_bound(high, 3, up=True)
    if low <= 0 and high < 1:
        return f"at most {most}{unit}"
    if 0 < low < 1 <= high:
        return f"at least {least}{unit}"
    return f"{least} to {most}{unit}"


def percent_bound(fraction: float, digits: int, up: bool) -> str:
    """End of a band of a fraction in percent, rounded outwards; near all of them with two digits of the rest.

    Examples
    --------
    >>> percent_bound(0.1234, 2, up=True), percent_bound(0.999631, 3, up=False), percent_bound(1.0, 3, up=True)
    ('13', '99.963', '100')
    """
    if _NEARLY_ALL < fraction < 1:
        return f"{100 - Decimal(bounding(100 * (1 - fraction), 2, not up)):f}"
    return bounding(100 * fraction, digits, up)


def with_band(stuck: float, low: float, high: float) -> str:
    """Fraction of devices and its band as `fraction_with_band`, from percent."""
    return fraction_with_band(*(end / 100 for end in (stuck, low, high)))


def error_alone(error: float) -> str:
    """Standard error as text, with the same digits as after ± in `with_error`.

    Examples
    --------
    >>> error_alone(0.0417), error_alone(12.3), error_alone(float("nan"))
    ('0.042', '12', '–')
    """
    return with_error(error, error).partition(" ")[0]


def _decimals(error):
    """Decimals of a value with this error: to the second significant digit of the rounded error."""
    _, _, exponent = f"{error:.1e}".partition("e")
    return max(0, 1 - int(exponent))
