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

TYPE_CHECKING = False  # type checkers assume that it is true; importing it from typing takes 20 ms
if TYPE_CHECKING:
    from stiction.beam.cantilever import Beam
    from stiction.beam.release import EndState, release
    from stiction.chaos.model import ChaosModel, draw_laws
    from stiction.chaos.model import fit as fit_chaos
    from stiction.config.cases import case_id
    from stiction.config.files import load
    from stiction.config.messages import ConfigError
    from stiction.contact.asperity import HertzAsperity, MaugisTable, asperity, reduced_modulus
    from stiction.contact.forcelaw import coefficients as force_laws
    from stiction.contact.forcelaw import energy as law_energy
    from stiction.contact.forcelaw import pressure as law_pressure
    from stiction.contact.pair import SurfacePair
    from stiction.contact.vanderwaals import DugdaleAttraction, attraction
    from stiction.device import Device
    from stiction.errors import NotConverged
    from stiction.scans.estimate import SurfaceEstimate
    from stiction.scans.estimate import estimate as estimate_surface
    from stiction.scans.reading import read as read_scan
    from stiction.scans.scan import Scan
    from stiction.stages.laws.chaos import chaos_model
    from stiction.stages.laws.forces import vectors as force_vectors
    from stiction.streams import stream
    from stiction.study import PairStudy
    from stiction.surface.field import RoughSurface, StripGrid
    from stiction.surface.maxent import HeightDensity
    from stiction.surface.maxent import solve as maximum_entropy
    from stiction.surface.spectrum import CutoffSelfAffine, TabulatedSpectrum
    from stiction.surface.translation import Translation, underlying_spectrum

__version__ = "0.2.0"

#: Public names and where each is defined.
_PLACES = {
    # configuration, study of a pair of surfaces, and devices
    "load": "config.files.load",
    "case_id": "config.cases.case_id",
    "PairStudy": "study.PairStudy",
    "Device": "device.Device",
    # surfaces
    "maximum_entropy": "surface.maxent.solve",
    "HeightDensity": "surface.maxent.HeightDensity",
    "CutoffSelfAffine": "surface.spectrum.CutoffSelfAffine",
    "TabulatedSpectrum": "surface.spectrum.TabulatedSpectrum",
    "Translation": "surface.translation.Translation",
    "underlying_spectrum": "surface.translation.underlying_spectrum",
    "StripGrid": "surface.field.StripGrid",
    "RoughSurface": "surface.field.RoughSurface",
    # measured surfaces
    "read_scan": "scans.reading.read",
    "Scan": "scans.scan.Scan",
    "estimate_surface": "scans.estimate.estimate",
    "SurfaceEstimate": "scans.estimate.SurfaceEstimate",
    # contact and force laws
    "DugdaleAttraction": "contact.vanderwaals.DugdaleAttraction",
    "attraction": "contact.vanderwaals.attraction",
    "reduced_modulus": "contact.asperity.reduced_modulus",
    "asperity": "contact.asperity.asperity",
    "MaugisTable": "contact.asperity.MaugisTable",
    "HertzAsperity": "contact.asperity.HertzAsperity",
    "SurfacePair": "contact.pair.SurfacePair",
    "force_vectors": "stages.laws.forces.vectors",
    "force_laws": "contact.forcelaw.coefficients",
    "law_pressure": "contact.forcelaw.pressure",
    "law_energy": "contact.forcelaw.energy",
    "ChaosModel": "chaos.model.ChaosModel",
    "fit_chaos": "chaos.model.fit",
    "chaos_model": "stages.laws.chaos.chaos_model",
    "draw_laws": "chaos.model.draw_laws",
    # beams
    "Beam": "beam.cantilever.Beam",
    "EndState": "beam.release.EndState",
    "release": "beam.release.release",
    # random numbers and errors
    "stream": "streams.stream",
    "ConfigError": "config.messages.ConfigError",
    "NotConverged": "errors.NotConverged",
}

__all__ = list(_PLACES)


def __getattr__(name):
    """Import the module that defines a public name when the name is first used."""
    if name not in _PLACES:
        raise AttributeError(f"module 'stiction' has no attribute {name!r}")
    module, _, attribute = _PLACES[name].rpartition(".")
    globals()[name] = getattr(import_module(f"stiction.{module}"), attribute)
    return globals()[name]


def __dir__():
    """All public names, including those not imported yet."""
    return sorted({*globals(), *__all__})
