"""Pairs of rough surfaces that meet, from the configuration and from datasets.

Apart from `stiction.cases`, so that a change of the contact reruns nothing that is done to single surfaces.
"""

from functools import partial

from stiction.asperity import MaugisTable, reduced_modulus
from stiction.cases import rough_surface, strip_grid
from stiction.contact import SurfacePair
from stiction.streams import stream
from stiction.units import si
from stiction.vanderwaals import attraction


def asperity(solid, van_der_waals):
    """Force of one asperity, from section solid and the kind of van der Waals attraction."""
    return MaugisTable(reduced_modulus(**si(solid)), attraction(van_der_waals))


def surface_pair(surfaces, model, settings):
    """Pair of surfaces from two (heights, spectrum) datasets, beam first, and the settings of stage contact."""
    grid = strip_grid(settings["sampling"], si(settings["beam"])["width"])
    beam, substrate = (rough_surface(heights, spectrum, model, grid) for heights, spectrum in surfaces)
    solid = asperity(settings["solid"], settings["van_der_waals"])
    contact = si(settings["contact"])
    return SurfacePair(beam, substrate, solid, contact["distance_step"], contact["every"])


def streams_of_sides(seed, pair):
    """Streams of the two surfaces of one sample of a pair: ``(sample) -> beam's, substrate's``."""
    return lambda sample: tuple(partial(stream, seed, "contact", pair)(side, sample) for side in ("beam", "substrate"))
