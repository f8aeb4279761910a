"""Stage spectrum (Sec. II-B): Eq. (7) and the spectrum of the Gaussian field underlying a non-Gaussian surface."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.plan.stage import Stage, select
from stiction.stages.surfaces import parameters
from stiction.stages.surfaces.heights import density
from stiction.surface.spectrum import CutoffSelfAffine, Spectrum, TabulatedSpectrum
from stiction.surface.translation import Translation, spectrum_of_heights, underlying_spectrum

#: Largest ratio, or smallest inverse ratio, of identified to measured radius and density of summits. ASSUME: 2; beyond,
#: contact would be computed for surfaces that do not resemble the measured one.
RESEMBLES = 2.0


@dataclass(frozen=True)
class SpectrumUse:
    """Surface and strips as users of an identified spectrum."""

    surface: str  #: its name
    strip_length: float  #: l_meso [m]
    margin: float  #: width of the periodic field beyond the strip [m]


@dataclass(frozen=True)
class Settings:
    """Settings of a spectrum, without the height density."""

    spacing: float  #: of the grid on which the surface will be drawn [m]
    psd: CutoffSelfAffine | str  #: spectrum of the heights, used up to a factor, or ``identified``
    identified: SpectrumUse | None = None  #: what an identified spectrum is used for


def compute(heights: xr.Dataset, settings: Settings, identification: xr.Dataset | None = None) -> xr.Dataset:
    """Take the published or the identified parameters of Eq. (7) and invert the translation.

    Parameters
    ----------
    heights, identification : Dataset
        Datasets of the stages of these names; ``identification`` is ignored if the settings contain the spectrum.
    settings : Settings

    Raises
    ------
    ValueError
        If the identified spectrum is not that of strips of a surface with the measured summits, see `refuse_misuse`.

    Returns
    -------
    Dataset
        Parameters of Eq. (7); target spectrum of the heights, spectrum of the Gaussian field and achieved spectrum of
        the heights, all of unit variance; share of the variance that no Gaussian field can provide.
    """
    target = parameters.spectrum_of(identification) if settings.psd == "identified" else settings.psd
    if settings.psd == "identified" and settings.identified:
        refuse_misuse(identification, settings.identified)
    return on_grid(target, heights, settings.spacing)


def on_grid(target: Spectrum, heights: xr.Dataset, spacing: float) -> xr.Dataset:
    """Dataset of a spectrum of the heights, for surfaces drawn on a grid of this spacing [m]."""
    translation = Translation(density(heights, "NG"))
    underlying, defect = underlying_spectrum(target, translation, spacing)
    return layout(target, underlying, spectrum_of_heights(underlying, translation, spacing), defect)


def refuse_misuse(identification: xr.Dataset, use: SpectrumUse) -> None:
    """Check an identified spectrum before anything is drawn from it.

    Raises
    ------
    ValueError
        If the margin is not longer than its correlation length, or its summits do not resemble the measured ones.
    """
    spectrum = parameters.spectrum_of(identification)
    parameters.refuse_long_correlation(use.surface, spectrum, {"sampling.margin_um": use.margin})
    ratios = {word: 1 + off / 100 for word, (off, _) in parameters.misfits(identification).items()}
    if not all(1 / RESEMBLES <= ratio <= RESEMBLES for ratio in ratios.values()):
        raise ValueError(
            f"no spectrum of the form of Eq. (7) has the summits of surface {use.surface}: at best "
            f"{ratios['radius']:.3g} times the radius surfaces.{use.surface}.mean_summit_radius_um and "
            f"{ratios['density']:.3g} times the density surfaces.{use.surface}.summit_density_per_um2"
        )


def layout(
    target: Spectrum,
    underlying: TabulatedSpectrum,
    achieved: TabulatedSpectrum,
    defect: float,
) -> xr.Dataset:
    """Dataset of a spectrum, of the underlying Gaussian field's and of the achieved spectrum of the heights.

    The three spectra have unit variance and are given at the wave numbers of ``underlying``.
    """
    zeta = underlying.wavenumber
    return parameters.variables(target).assign(
        target=("wavenumber", target(zeta) / target.variance),
        underlying=("wavenumber", underlying.density),
        achieved=("wavenumber", achieved(zeta)),
        defect=((), defect),
        wavenumber=("wavenumber", zeta),
    )


def underlying(spectrum: xr.Dataset, model: str) -> Spectrum:
    """Spectrum of the Gaussian field underlying a surface. For model ``G`` it is the spectrum of the heights."""
    target = parameters.spectrum_of(spectrum)
    if model == "G":
        return target
    return TabulatedSpectrum(spectrum.wavenumber.values, spectrum.underlying.values, target.cutoff)


def achieved(spectrum: xr.Dataset, wavenumber: np.ndarray) -> np.ndarray:
    """Spectrum of the drawn heights, of unit variance, at wave numbers (n,) [rad m⁻¹], (n,) [m²]."""
    return np.interp(wavenumber, spectrum.wavenumber, spectrum.achieved)


def defect(spectrum: xr.Dataset) -> float:
    """Fraction of the variance not provided by any Gaussian field [-]."""
    return float(spectrum.defect)


def _settings(plan, at):
    """Published spectrum of a surface, or ``identified`` with the strips it is used for, and the grid."""
    entry, sampling = plan.config["surfaces"][at.surface], plan.config["sampling"]
    if entry["psd"] == "published":
        return {"spacing_nm": sampling["spacing_nm"], "psd": entry["published_psd"]}
    use = select(SpectrumUse, sampling, surface=at.surface)
    return {"spacing_nm": sampling["spacing_nm"], "psd": "identified", "identified": use}


def _inputs(plan, at):
    """Heights of a surface, and its identification if its spectrum is identified."""
    identified = plan.config["surfaces"][at.surface]["psd"] == "identified"
    return {"heights": f"heights/{at.surface}"} | (
        {"identification": f"identification/{at.surface}"} if identified else {}
    )


STAGES = (
    Stage.writing(
        "spectrum",
        "spectrum/{surface}",
        surfaces=lambda plan: plan.scans.described_by_numbers,
        inputs=_inputs,
        settings=_settings,
        kind=Settings,
        compute=compute,
        message="Spectrum of {surface} and of the underlying Gaussian field (Sec. II-B).",
    ),
)
