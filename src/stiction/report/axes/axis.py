"""Axis of a curve or a map, of a quantity of a surface or the variable of a process: words, unit, values as text."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.config.kinds import ROUGHNESSES
from stiction.config.surfaces import process
from stiction.config.units import from_si, without_unit
from stiction.contact.air import Air
from stiction.report.format import with_error
from stiction.report.limits import words
from stiction.run.stored_limits import of_text

#: Attributes of datasets that name their axes, and the dimensions of these.
_QUANTITIES = {"key": "roughness", "other_key": "other"}
_VARIABLES = {"variable": "value", "second_variable": "second"}
#: Beginnings of the sentences on a variable of single points.
_BEGINNINGS = {"flagged": "Where", "refused": "Not computed where"}


@dataclass(frozen=True)
class Axis:
    """Axis of a dataset."""

    name: str  #: key of the quantity, or variable with its unit
    dimension: str
    words: str
    unit: str  #: with a space before it; empty without a unit
    values: np.ndarray  #: at which something is known, increasing [SI, or the unit of a variable]
    scale: str = "linear"  #: of `stiction.devices.roughness.SCALES`

    @property
    def is_quantity(self) -> bool:
        """Whether it is a quantity of a surface, and no variable of a process."""
        return self.name in ROUGHNESSES

    @property
    def label(self) -> str:
        """Words with the unit, for figures and tables."""
        return f"{self.words} [{self.unit.strip() or '–'}]"

    def in_unit(self, values: float | np.ndarray) -> float | np.ndarray:
        """Values in the unit."""
        unit = self.name.removeprefix(without_unit(self.name)).removeprefix("_") if self.is_quantity else ""
        return from_si(values, unit) if unit else values

    def text(self, value: float) -> str:
        """Value without its unit. A setting has a hundredth of the range of all, or finer by less than a digit."""
        if self.is_quantity:
            return f"{self.in_unit(float(value)):.3g}"
        decimals = max(0, -math.floor(math.log10(np.ptp(self.values) / 100)))
        return f"{round(float(value), decimals):.10g}"

    def at(self, value: float, error: float = 0.0) -> str:
        """Value with its error, if it has one, and its unit."""
        exact = not float(error) > 0
        return (self.text(value) if exact else with_error(*map(self.in_unit, (float(value), float(error))))) + self.unit

    def ranges(self, ends: np.ndarray) -> list[str]:
        """Ranges (n, 2) as text. Those that are missing are NaN."""
        return [f"{self.text(low)} to {self.text(high)}{self.unit}" for low, high in ends if np.isfinite(low)]


def axes_of(curves: xr.Dataset) -> list[Axis]:
    """Axes of a dataset: along its curves and, of a map, from curve to curve."""
    named = {**_QUANTITIES, **_VARIABLES}
    return [_axis(curves, name, dimension) for attr, dimension in named.items() if (name := curves.attrs.get(attr, ""))]


def _axis(curves, name, dimension):
    """Axis of a dataset along a dimension."""
    values = np.atleast_1d(curves[dimension].values)
    if name not in ROUGHNESSES:
        return Axis(name, dimension, process.words_of(name), f" {process.unit_of(name)}", values)
    quantity = ROUGHNESSES[name]
    words_of_it = f"{quantity.words} of {curves.attrs['surface']}"
    return Axis(name, dimension, words_of_it, quantity.unit, values, quantity.scale)


def subjects(curve: xr.Dataset) -> list[tuple[float, str]]:
    """Humidities and end states of a curve."""
    return [(float(humidity), str(shape)) for humidity in curve.humidity.values for shape in curve["shape"].values]


def notes(curve: xr.Dataset) -> Iterator[str]:
    """Yield sentences on flagged points and on those that could not be computed, each with its places."""
    axis, *_ = axes_of(curve)
    for name, begins in _BEGINNINGS.items():
        places = {}
        for humidity in curve.humidity.values:
            air = f" ({Air(humidity).words})" if axis.is_quantity else ""
            for value in curve[axis.dimension].values:
                text = str(curve[name].sel({"humidity": humidity, axis.dimension: value}).values)
                if sentence := words.joined(of_text(text)) if name == "flagged" else text:
                    places.setdefault(sentence.rstrip("."), []).append(axis.at(value) + air)
        for sentence, at in places.items():
            yield f"{begins} the {axis.words} is {', '.join(dict.fromkeys(at))}: {sentence}."
