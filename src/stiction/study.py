"""Whole model in one process: from a configuration to the crack lengths of the beams of a pair, without files.

Stages, settings and addresses of random numbers are the same as in the workflow, and so are the results.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from stiction.beam.cantilever import Beam
from stiction.config.cases import case_id, in_numbers
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.pair import SurfacePair
from stiction.models import SURFACE_MODELS
from stiction.plan.graph import Results
from stiction.stages.beams import beams
from stiction.stages.beams.cantilevers import Cantilevers, cantilever, sections
from stiction.stages.contact import corrections, curves, pairs
from stiction.stages.laws import samples
from stiction.stages.surfaces.rough_surfaces import sides_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class PairStudy:
    """One pair of surfaces and its results at any relative humidity, or ``"dry"``, stage by stage.

    Examples
    --------
    >>> import stiction
    >>> study = stiction.PairStudy.of(stiction.load(), "b")  # doctest: +SKIP
    >>> study.beams(0.67).crack_length  # doctest: +SKIP
    """

    name: str  #: name of the pair, part of the addresses of random numbers
    model: str  #: ``NG``, or ``G`` for surfaces with Gaussian heights
    results: Results  #: results of all stages by the names of their files

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
        study = cls(name, model, Results.of(config))
        study.contact  # noqa: B018 - computed now, as the docstring says
        return study

    @property
    def contact(self) -> xr.Dataset:
        """Solid pressure and bearing area of all samples at the highest humidity (Sec. III-A), of stage contact."""
        return self._contact_at(max(self._plan.config["pairs"][self.name]["humidities"]))

    def _contact_at(self, humidity):
        """Contact at a humidity. It differs in dry air alone."""
        return self.results[f"contact/{self._plan.air.contact(self.name, humidity)}_{self.model}"]

    @property
    def surfaces(self) -> SurfacePair:
        """Both surfaces, for drawing samples."""
        job = self.results.graph.job(f"contact/{self.name}_{self.model}/0-of-1")
        settings = in_si(pairs.Settings, job.settings)
        return pairs.surface_pair(sides_of(self.results.inputs(job)), self.model, settings)

    def energies(self, humidity: float | str) -> np.ndarray:
        """Adhesion energies e of all samples at a relative humidity (m,) [J m⁻²]."""
        humidity = in_numbers(humidity)
        water = in_si(Water, self._plan.air.water(self._plan.air.contact(self.name, humidity)))
        if named := corrections.corrections_of_laws(self._plan, self.name, [humidity], self.model):
            water = replace(water, correction=corrections.applied(self.results[named["model_error"]]))
        return curves.energies(self._contact_at(humidity), humidity, water)

    def forces(self, humidity: float | str) -> xr.Dataset:
        """Vectors v of Eq. (11) and f_limit at a relative humidity (Sec. III-B1). Dataset of stage forces."""
        return self.results[f"forces/{case_id(self.name, humidity)}_{self.model}"]

    def curves(self, humidity: float | str) -> xr.DataArray:
        """Force per area [Pa] of the first samples over the distance of the mean planes [m], negative if it attracts.

        ``curves(0.67).plot.line(x="distance")`` of xarray draws them.
        """
        return self.forces(humidity).force.assign_attrs(long_name="force per area")

    def laws(self, humidity: float | str) -> xr.Dataset:
        """Force laws of Eq. (12) of all lawful samples, by number. Dataset of `stiction.stages.laws.samples`."""
        return samples.laws(self.forces(humidity))

    def plot(self, humidity: float | str) -> "Figure":
        """Figure of a typical force curve, its force law, Eq. (12), and its parameters, Eq. (11)."""
        from stiction.report.laws.figures import fitted_curve

        case = f"{case_id(self.name, humidity)}_{self.model}"
        return fitted_curve(self.results[f"forces/{case}"], self.results[f"fit/{case}"])

    def chaos(self, humidity: float | str) -> xr.Dataset:
        """Chaos model of the force laws at a relative humidity (App. B). Dataset of stage chaos.

        `stiction.stages.laws.stored_model.chaos_model` returns the model itself, which draws force laws.
        """
        return self.results[f"chaos/{case_id(self.name, humidity)}_{self.model}"]

    def beams(self, humidity: float | str, scatter: float = 0.0, threads: int = 1) -> xr.Dataset:
        """Beams released at a relative humidity (Sec. III-C). Dataset of stage beams.

        Parameters
        ----------
        humidity : float or str
            [-], or ``"dry"``
        scatter : float
            Relative standard deviation of each dimension of the beams [-]; 0.025 in the paper's model GEO.
        threads : int
            Number of beams computed in parallel; it does not affect the results.
        """
        case = case_id(self.name, humidity)
        settings = self.results.graph.job(f"beams/{case}_{self.model}").settings | {"scatter": scatter}
        return beams.compute(self.chaos(humidity), case, in_si(beams.Settings, settings), threads)

    @property
    def beam(self) -> Beam:
        """Nominal cantilever of the pair."""
        return cantilever(in_si(Cantilevers, sections(self._plan, self.name)), self.name)

    def __repr__(self):
        model = "" if self.model == "NG" else ", Gaussian heights"
        return f"PairStudy {self.name}: {' on '.join(self._plan.sides(self.name))}{model}"

    @property
    def _plan(self):
        return self.results.graph.plan
