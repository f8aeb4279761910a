"""One surface of a configuration: its heights and spectrum, and strips drawn from it, without files."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import xarray as xr

from stiction.config.units import in_si, to_si
from stiction.plan.graph import Results
from stiction.report.format import TO_NM
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import maps
from stiction.stages.surfaces.rough_surfaces import Sampling, rough_surface
from stiction.streams import stream
from stiction.surface.field import StripGrid

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Surface:
    """Surface of a configuration, described by numbers, as in papers, like a typical one, or by scans.

    Examples
    --------
    >>> import stiction
    >>> config = stiction.load({"surfaces": {"Mine": {"rms_nm": 5, "like": "B2"}}})
    >>> mine = stiction.Surface.of(config, "Mine")
    >>> mine
    Surface Mine: rms 5 nm, skewness -0.76, kurtosis 3.9
    >>> mine.draw().dims
    ('x', 'y')
    """

    name: str
    results: Results  #: results of all stages by the names of their files

    @classmethod
    def of(cls, config: dict, name: str) -> "Surface":
        """Surface of a configuration, from `stiction.load`.

        Raises
        ------
        ValueError
            If the configuration has no such surface.
        """
        if name not in config["surfaces"]:
            raise ValueError(f"there is no surface {name}; the configuration has {', '.join(config['surfaces'])}")
        return cls(name, Results.of(config))

    @property
    def heights(self) -> xr.Dataset:
        """Density of the standardised heights and its moments. Dataset of stage heights."""
        return self.results[f"heights/{self.name}"]

    @property
    def rms(self) -> float:
        """Standard deviation of the heights [m]."""
        return stage_heights.moments(self.heights).rms

    @property
    def skewness(self) -> float:
        """Third standardised moment of the heights [-]. For measured heights, it is their density's."""
        return stage_heights.moments(self.heights).skewness

    @property
    def kurtosis(self) -> float:
        """Fourth standardised moment of the heights, 3 for Gaussian ones [-]."""
        return stage_heights.moments(self.heights).kurtosis

    @property
    def spectrum(self) -> xr.DataArray:
        """Power spectral density s_Z of the heights [m⁴] by wave number [rad/m]. Its integral is the rms squared.

        The convention is that of `stiction.surface.spectrum`.
        """
        target = self.results[f"spectrum/{self.name}"].target
        return (self.rms**2 * target).assign_attrs(units="m4", long_name=f"spectral density of {self.name}")

    def draw(self, number: int = 0, length: float | None = None, width: float | None = None) -> xr.DataArray:
        """Draw one strip of surface: heights [m] over x along the beam and y across it [m].

        Parameters
        ----------
        number : int
            The same number is the same strip.
        length, width : float, optional
            Sides of the strip [m]; by default those of the configuration.
        """
        config = self.results.graph.plan.config
        sampling = in_si(Sampling, config["sampling"])
        sides = length or sampling.strip_length, width or to_si(config["beam"]["width_um"], "um")
        grid = StripGrid(*sides, sampling.spacing, sampling.margin)
        surface = rough_surface(self.heights, self.results[f"spectrum/{self.name}"], "NG", grid)
        drawn = surface.draw(stream(config["seed"], "surface", self.name, number))
        return maps.labelled(drawn, (sampling.spacing, sampling.spacing), self.name)

    def plot(self) -> "Figure":
        """Figure of a drawn strip, of the density of the heights and of their spectrum."""
        from stiction.report.surfaces.figures import surface

        return surface(self.draw(), self.heights, self.spectrum)

    def __repr__(self):
        return (
            f"Surface {self.name}: rms {TO_NM * self.rms:.4g} nm, skewness {self.skewness:.4g}, "
            f"kurtosis {self.kurtosis:.4g}"
        )
