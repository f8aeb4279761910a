"""The whole model in one process: from a configuration to the crack lengths of the beams of a pair, without files.

Stages, settings and addresses of random numbers are the same as in the workflow, and so are the results.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config import jobs
from stiction.config.cases import case_id
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.contact.pair import SurfacePair
from stiction.models import SURFACE_MODELS
from stiction.stages import beams, chaos, curves, forces, heights, identification, pairs, spectrum
from stiction.stages import contact as stage_contact
from stiction.stages.cantilevers import Cantilevers, cantilever


@dataclass(frozen=True)
class PairStudy:
    """One pair of surfaces and its results at any relative humidity, stage by stage.

    Examples
    --------
    >>> import stiction
    >>> study = stiction.PairStudy.of(stiction.load(), "b")  # doctest: +SKIP
    >>> study.beams(0.67).crack_length  # doctest: +SKIP
    """

    name: str  #: name of the pair, part of the addresses of random numbers
    model: str  #: ``NG``, or ``G`` for surfaces with Gaussian heights
    surfaces: SurfacePair  #: the two surfaces, from which samples can be drawn
    contact: xr.Dataset  #: dataset of stage contact
    config: dict  #: complete configuration

    @classmethod
    def of(cls, config: dict, name: str, model: str = "NG") -> "PairStudy":
        """Study of one pair of a configuration: draws the surfaces and computes their contact, about 5 ms per sample.

        Spectra with ``psd: identified`` are identified first, which takes a few seconds each; surfaces described by
        scans are estimated first.

        Parameters
        ----------
        config : dict
            Complete configuration, from `stiction.load`.
        name : str
            Name of the pair.
        model : str
            ``NG``, or ``G`` for surfaces with Gaussian heights.

        Raises
        ------
        ValueError
            If the configuration has no such pair, or the package no such model.
        """
        if model not in SURFACE_MODELS:
            raise ValueError(f"there is no model {model} of the heights; the models are {', '.join(SURFACE_MODELS)}")
        if name not in config["pairs"]:
            raise ValueError(f"there is no pair {name}; the configuration has {', '.join(config['pairs'])}")
        plan = Plan(config)
        surfaces = [surface_datasets(plan, side) for side in plan.sides(name)]
        settings = typed(stage_contact.Settings, jobs.contact(plan, name))
        pair = pairs.surface_pair(surfaces, model, settings)
        return cls(name, model, pair, stage_contact.compute(surfaces, name, model, settings), config)

    def energies(self, humidity: float) -> np.ndarray:
        """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
        return curves.energies(self.contact, humidity, self._water)

    def forces(self, humidity: float) -> xr.Dataset:
        """Vectors v of Eq. (11) and f_limit at a relative humidity (Sec. III-B1); dataset of stage forces."""
        settings = typed(forces.Settings, jobs.forces(Plan(self.config), case_id(self.name, humidity)))
        return forces.compute(self.contact, settings)

    def chaos(self, humidity: float) -> xr.Dataset:
        """Chaos model of the force laws at a relative humidity (App. B); dataset of stage chaos.

        `stiction.stages.chaos.chaos_model` returns the model itself, which draws force laws.
        """
        settings = typed(chaos.Settings, jobs.chaos(Plan(self.config)))
        return chaos.compute(self.forces(humidity), case_id(self.name, humidity), self.model, settings)

    def beams(self, humidity: float, scatter: float = 0.0, threads: int = 1) -> xr.Dataset:
        """Beams released at a relative humidity (Sec. III-C); dataset of stage beams.

        Parameters
        ----------
        humidity : float
            [-]
        scatter : float
            Relative standard deviation of each dimension of the beams [-]; 0.025 in the paper's model GEO.
        threads : int
            Number of beams computed in parallel; it does not affect the results.
        """
        case = case_id(self.name, humidity)
        plain = jobs.beams(Plan(self.config), case, "NG") | {"scatter": scatter}
        return beams.compute(self.chaos(humidity), case, typed(beams.Settings, plain), threads)

    @property
    def beam(self) -> Beam:
        """Nominal cantilever of the pair."""
        return cantilever(typed(Cantilevers, jobs.cantilevers(Plan(self.config), self.name)), self.name)

    @cached_property
    def _water(self):
        return typed(curves.Water, Plan(self.config).water(self.name))


def surface_datasets(plan: Plan, name: str) -> tuple[xr.Dataset, xr.Dataset]:
    """Datasets of stages heights and spectrum of one surface."""
    if name in plan.scanned:
        return _measured(plan, name)
    found = heights.compute(typed(heights.Settings, jobs.heights(plan, name)))
    settings = typed(spectrum.Settings, jobs.spectrum(plan, name))
    identified = None
    if settings.psd == "identified":
        wanted = typed(identification.Settings, jobs.identification(plan, name))
        identified = identification.compute(found, name, wanted)
    return found, spectrum.compute(found, identified, settings)


def estimate_of(plan: Plan, name: str) -> xr.Dataset:
    """Dataset of stage estimate of one surface described by scans."""
    # Imported here: other surfaces do not need these modules.
    from stiction.measured import estimate, scan

    scans = [
        scan.compute(path, typed(scan.Settings, jobs.scan(plan, name, number)))
        for number, path in plan.scan_files(name).items()
    ]
    return estimate.compute(scans, name, typed(estimate.Settings, jobs.estimate(plan, name)))


def _measured(plan, name):
    """As `surface_datasets`, of a surface described by scans."""
    from stiction.measured import heights as measured_heights
    from stiction.measured import spectrum as measured_spectrum

    found = estimate_of(plan, name)
    drawn = measured_heights.compute(found, typed(measured_heights.Settings, jobs.heights_of_scans(plan, name)))
    settings = typed(measured_spectrum.Settings, jobs.spectrum_of_scans(plan, name))
    return drawn, measured_spectrum.compute(found, drawn, settings)
