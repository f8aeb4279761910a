"""Beams from the configuration."""

from stiction.beam.cantilever import Beam
from stiction.config.units import si


def cantilever(settings, pair):
    """The nominal beam of a pair, from sections beam, solid and pairs."""
    entry = si(settings["beam"])
    sizes = {key: entry[key] for key in ("length", "width", "thickness", "elements")}
    gap, young_modulus = si(settings["pairs"][pair])["gap"], si(settings["solid"])["young_modulus"]
    return Beam(**sizes, gap=gap, young_modulus=young_modulus)


def points(settings):
    """Number of force laws along a beam, N_p, from sections beam and sampling."""
    return round(si(settings["beam"])["length"] / si(settings["sampling"])["strip_length"])
