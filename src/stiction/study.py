"""The paper in one process: from the configuration of a pair to the crack lengths of its beams, without files.

Stages, settings and addresses of random numbers are those of the workflow, and so are the results.
"""

from dataclasses import dataclass
from functools import partial

import xarray as xr

from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.chaos import model as chaos
from stiction.config.cases import case_id
from stiction.config.units import si
from stiction.contact.forcelaw import adhesion_energies, parametrise
from stiction.progress import progress
from stiction.stages.cantilevers import cantilever, points
from stiction.stages.cases import surfaces_of
from stiction.stages.curves import force_curves
from stiction.stages.pairs import contact
from stiction.streams import stream


@dataclass(frozen=True)
class PairStudy:
    """One pair of surfaces and all that the humidity does to it, stage by stage.

    Examples
    --------
    >>> config = settings.load(["config.yaml", "workflow/smoke.yaml"], schema)  # doctest: +SKIP
    >>> study = PairStudy.of(config, "b")  # doctest: +SKIP
    >>> study.beams(0.67)["crack_length"]  # doctest: +SKIP
    """

    name: str  #: of the pair, part of the addresses of random numbers
    contact: xr.Dataset  #: stage contact
    settings: dict  #: sections seed, sampling, solid, water, chaos, beam and pairs of the configuration

    @classmethod
    def of(cls, config, name, model="NG", identified=()):
        """Study of one pair of a configuration: draws its surfaces and computes their contact, 15 ms a sample.

        Parameters as in `stiction.stages.cases.surfaces_of` and `stiction.stages.pairs.contact`; spectra that are to be
        identified come from `stiction.stages.identifications.identified_spectra`.

        Raises
        ------
        ValueError
            If the configuration has no such pair, or a spectrum has to be identified.
        """
        if name not in config["pairs"]:
            raise ValueError(f"there is no pair {name}; the configuration has {', '.join(config['pairs'])}")
        return cls(name, contact(surfaces_of(config, name, identified), name, model, config), config)

    def _curves(self, humidity):
        return force_curves(self.contact, humidity, si(self.settings["water"])["temperature"])

    def energies(self, humidity):
        """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
        return adhesion_energies(*self._curves(humidity), self.contact.sizes["sample"])

    def forces(self, humidity):
        """Vectors v of Eq. (11), (m, 4) [SI], and f_limit [Pa] at a relative humidity (Sec. III-B1)."""
        return parametrise(*self._curves(humidity), self.contact.sizes["sample"])

    def chaos(self, humidity):
        """Chaos model of the force laws at a relative humidity (App. B)."""
        wanted = self.settings["chaos"]
        return chaos.fit(*self.forces(humidity), wanted["order"], wanted["dimension_tolerance"])

    def beams(self, humidity, scatter=0.0, threads=1):
        """Beams released at a relative humidity, as `stiction.beam.montecarlo.columns` (Sec. III-C)."""
        fitted, entry = self.chaos(humidity), self.settings["beam"]
        strips = points(self.settings)
        experiment = Experiment(self.beam, strips, lambda rng, n: chaos.draw_laws(fitted, n, rng)[0], scatter)
        address = partial(stream, self.settings["seed"], "beams", case_id(self.name, humidity))
        released = simulate(experiment, range(entry["samples"]), address, threads)
        return columns(list(progress(released, f"beams at {humidity}", total=entry["samples"])))

    @property
    def beam(self):
        """The nominal cantilever."""
        return cantilever(self.settings, self.name)
