"""Stiction of MEMS beams: rough surfaces, their contact, stochastic force laws and the release of cantilevers.

The names below are the public interface of the package. A module is imported when one of its names is first used, so
that ``import stiction`` takes almost no time. Modules and scripts of this project import from the modules instead,
because fingerprints follow such imports only.

>>> import stiction
>>> config = stiction.load({"contact": {"samples": 2000}})
>>> study = stiction.PairStudy.of(config, "b")  # doctest: +SKIP
>>> study.beams(0.67)["crack_length"]  # doctest: +SKIP
"""

from importlib import import_module

__version__ = "0.2.0"

#: Module and name of what each public name stands for, from the imports by which editors know them, one in a line.
with open(f"{__file__}i", encoding="utf-8") as _stub:  # noqa: PTH123 - importing pathlib takes longer than everything else
    _PLACES = {line[-1]: (line[1], line[3]) for line in map(str.split, _stub) if line[:1] == ["from"]}

__all__ = list(_PLACES)


def __getattr__(name):
    """Import the module of a public name at its first use."""
    if name not in _PLACES:
        raise AttributeError(f"module 'stiction' has no attribute {name!r}")
    module, attribute = _PLACES[name]
    globals()[name] = getattr(import_module(module), attribute)
    return globals()[name]


def __dir__():
    """Names of the public interface, including those not imported yet."""
    return sorted({*globals(), *__all__})
