"""Pairs of rough surfaces that meet, from the configuration and from datasets.

Apart from `stiction.stages.cases`, so that a change of the contact reruns nothing that is done to single surfaces.
"""

from stiction.config.units import si
from stiction.contact.asperity import MaugisTable, reduced_modulus
from stiction.contact.pair import SurfacePair, contact_of_samples
from stiction.contact.vanderwaals import attraction
from stiction.progress import progress
from stiction.stages import data
from stiction.stages.cases import SIDES, rough_surface, strip_grid
from stiction.streams import stream


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
    return lambda sample: tuple(stream(seed, "contact", pair, side, sample) for side in SIDES)


def contact(surfaces, pair, model, settings, samples=None):
    """Stage contact: solid pressure and bearing area of the sampled pairs, free of humidity (Sec. III-A).

    Parameters
    ----------
    surfaces : tuple
        Datasets (heights, spectrum) of the beam's and of the substrate's surface.
    pair : str
        Part of the addresses of random numbers.
    model : str
        ``NG``, or ``G`` for surfaces with Gaussian heights.
    settings : dict
        Sections seed, sampling, solid, van_der_waals, contact and the width of the beam.
    samples : range, optional
        Numbers of the samples; all by default.
    """
    meeting = surface_pair(surfaces, model, settings)
    samples = range(settings["contact"]["samples"]) if samples is None else samples
    streams = streams_of_sides(settings["seed"], pair)
    curves = contact_of_samples(meeting, streams, progress(samples, "surface pairs"))
    return data.contact(*curves, meeting.distances, samples)
