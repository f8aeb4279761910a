"""The paper in one process: from the configuration of a pair to the crack lengths of its beams, without files.

Stages, settings and addresses of random numbers are those of the workflow, and so are the results.
"""

from dataclasses import dataclass
from functools import cached_property, partial

from stiction import chaos, data, maxent, pairs
from stiction.beam import Beam
from stiction.contact import contact_of_samples
from stiction.forcelaw import humid_curves, parametrise
from stiction.logs import progress
from stiction.meniscus import laplace_pressure, meniscus_height
from stiction.montecarlo import Experiment, columns, simulate
from stiction.settings import case_id
from stiction.spectrum import CutoffSelfAffine
from stiction.streams import stream
from stiction.translation import Translation, spectrum_of_heights, underlying_spectrum
from stiction.units import si

SIDES = ("beam", "substrate")
MOMENTS = ("rms", "skewness", "kurtosis")


def surface(moments, target, spacing):
    """One rough surface, as the datasets of stages heights and spectrum (Sec. II-A and II-B).

    Parameters
    ----------
    moments : dict
        rms [m], skewness, kurtosis.
    target : CutoffSelfAffine
        Spectrum of the heights; only its shape counts.
    spacing : float
        Of the grid on which the surface will be drawn [m].
    """
    density = maxent.solve(moments["skewness"], moments["kurtosis"])
    translation = Translation(density)
    underlying, defect = underlying_spectrum(target, translation, spacing)
    achieved = spectrum_of_heights(underlying, translation, spacing)
    return data.heights(density, moments), data.spectrum(target, underlying, achieved, defect)


def _target(name, entry, identified):
    """Spectrum of a surface of the configuration."""
    if entry["psd"] == "published":
        return CutoffSelfAffine(**si(entry["published_psd"]))
    if name not in identified:
        raise ValueError(
            f"the spectrum of {name} has to be identified first, see stiction.identify; given {[*identified]}"
        )
    return identified[name]


def cantilever(settings, pair):
    """The nominal beam of a pair, from sections beam, solid and pairs."""
    entry = si(settings["beam"])
    sizes = {key: entry[key] for key in ("length", "width", "thickness", "elements")}
    gap, young_modulus = si(settings["pairs"][pair])["gap"], si(settings["solid"])["young_modulus"]
    return Beam(**sizes, gap=gap, young_modulus=young_modulus)


@dataclass(frozen=True)
class PairStudy:
    """One pair of surfaces and all that happens to it, stage by stage.

    Examples
    --------
    >>> config = settings.load(["config.yaml", "workflow/smoke.yaml"], schema)  # doctest: +SKIP
    >>> study = PairStudy.of(config, "b")  # doctest: +SKIP
    >>> study.beams(0.67)["crack_length"]  # doctest: +SKIP
    """

    name: str  #: of the pair, part of the addresses of random numbers
    surfaces: tuple  #: datasets (heights, spectrum) of the beam's and of the substrate's surface
    settings: (
        dict  #: sections of the configuration: seed, sampling, solid, van_der_waals, water, contact, chaos, beam, pairs
    )
    model: str = "NG"  #: or G, for surfaces with Gaussian heights

    @classmethod
    def of(cls, config, name, model="NG", identified=None):
        """Study of one pair of a configuration.

        Parameters
        ----------
        config : dict
        name : str
            Pair of section ``pairs``.
        model : str
            ``NG`` or ``G``.
        identified : dict, optional
            Spectra of the surfaces whose psd is not the published one, by name.
        """
        spacing, surfaces = si(config["sampling"])["spacing"], []
        for entry_name in (config["pairs"][name][side] for side in SIDES):
            entry = si(config["surfaces"][entry_name])
            target = _target(entry_name, entry, identified or {})
            surfaces.append(surface({key: entry[key] for key in MOMENTS}, target, spacing))
        return cls(name, tuple(surfaces), config, model)

    @cached_property
    def pair(self):
        """The two surfaces, their elasticity and attraction."""
        return pairs.surface_pair(self.surfaces, self.model, self.settings)

    @cached_property
    def contact(self):
        """Solid pressure (m, n_solid) [Pa] and bearing area (m, n_bearing) [-] of all samples (Sec. III-A)."""
        streams = pairs.streams_of_sides(self.settings["seed"], self.name)
        samples = progress(range(self.settings["contact"]["samples"]), "surface pairs")
        return contact_of_samples(self.pair, streams, samples)

    def forces(self, humidity):
        """Vectors v of Eq. (11), (m, 4) [SI], and f_limit [Pa] at a relative humidity (Sec. III-B1)."""
        temperature = si(self.settings["water"])["temperature"]
        film = float(meniscus_height(humidity, temperature)), -float(laplace_pressure(humidity, temperature))
        grid = self.pair.distances
        starts = float(grid.solid[0]), float(grid.bearing[0])
        distance, curve = humid_curves(*self.contact, starts, grid.step, film)
        return parametrise(distance, curve, len(self.contact[0]))

    def chaos(self, humidity):
        """Chaos model of the force laws at a relative humidity (App. B)."""
        wanted = self.settings["chaos"]
        return chaos.fit(*self.forces(humidity), wanted["order"], wanted["dimension_tolerance"])

    def beams(self, humidity, scatter=0.0, threads=1):
        """Beams released at a relative humidity, as `stiction.montecarlo.columns` (Sec. III-C)."""
        fitted, entry = self.chaos(humidity), self.settings["beam"]
        experiment = Experiment(self.beam, self.points, lambda rng, n: chaos.draw_laws(fitted, n, rng)[0], scatter)
        address = partial(stream, self.settings["seed"], "beams", case_id(self.name, humidity))
        released = simulate(experiment, range(entry["samples"]), address, threads)
        return columns(list(progress(released, f"beams at {humidity}", total=entry["samples"])))

    @property
    def beam(self):
        """The nominal cantilever."""
        return cantilever(self.settings, self.name)

    @property
    def points(self):
        """Number of force laws along the beam, N_p."""
        return round(self.beam.length / si(self.settings["sampling"])["strip_length"])
