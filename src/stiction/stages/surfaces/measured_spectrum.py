"""Spectrum of a measured surface (Sec. II-B): the dataset of stage spectrum from stage estimate."""

import math
import warnings
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stiction.config.units import from_si
from stiction.devices.strips import repetition
from stiction.errors import NotConverged
from stiction.plan.stage import Stage, select
from stiction.rounding import is_at_most
from stiction.stages.surfaces import estimate as stage_estimate
from stiction.stages.surfaces import spectrum as stage_spectrum
from stiction.stages.surfaces.spectrum import SpectrumUse
from stiction.stages.surfaces.surface_flags import flagged
from stiction.surface.neighbours import mean_height_correlations
from stiction.surface.spectrum import uncorrelated_beyond


@dataclass(frozen=True)
class Settings:
    """Source of the spectrum, its cut-off, and its use."""

    psd: str  #: ``fitted`` (Eq. (7)) or ``tabulated``
    beyond: str  #: ``cut`` at the end of the measured spectrum, or ``continued`` to the Nyquist wave number of the grid
    spacing: float  #: of the grid on which the surface will be drawn [m]
    use: SpectrumUse


def compute(estimate: xr.Dataset, heights: xr.Dataset, settings: Settings) -> xr.Dataset:
    """Fit or table of the measured spectrum up to its cut-off, and the spectrum of the Gaussian field.

    ASSUME: with ``cut`` there is no roughness that the scans do not show, as in the identification from summits.

    Raises
    ------
    ValueError
        If no Gaussian field has these heights and this spectrum.
    """
    use, source = settings.use, f"from {', '.join(stage_estimate.files(estimate))}"
    cutoff, clipped = cutoff_and_clipping(stage_estimate.reach(estimate).end, settings)
    try:
        target = stage_estimate.spectrum(estimate, settings.psd, cutoff)
        spectrum = stage_spectrum.on_grid(target, heights, settings.spacing)
    except (ValueError, NotConverged) as reason:
        raise ValueError(f"surface {use.surface} {source} cannot be drawn: {reason}") from None
    limits = [*([("grid_ends", clipped)] if clipped else []), *_within_correlation(target, use)]
    for _, sentence in limits:
        warnings.warn(f"surface {use.surface}: {sentence}", stacklevel=2)
    return spectrum.assign(flagged(limits))


def _within_correlation(spectrum, use):
    """Kinds and sentences of limits of strips and margins within the correlation length."""
    length = uncorrelated_beyond(spectrum)
    strip, margin, heights = (from_si(value, "um") for value in (use.strip_length, use.margin, length))
    if use.strip_length <= length:
        lags = math.ceil(length / use.strip_length)
        repeated = repetition(mean_height_correlations([(spectrum, 1.0)], (use.strip_length, math.inf), lags))
        yield (
            "correlated_strips",
            f"heights are correlated over {heights:.2g} µm; strips of {strip:g} µm count as independent"
            + (
                " under the beams of pairs, whose lengths then come out up to 10 % too long, while under devices "
                f"strips repeat the law of their neighbour with a probability of up to {repeated:.2g}, the safe side"
                if repeated
                else " nevertheless"
            ),
        )
    if use.margin <= length:
        yield (
            "correlated_edges",
            f"heights are correlated over {heights:.2g} µm, so that a margin of {margin:g} µm makes opposite edges of "
            "a strip alike; a longer sampling.margin_um does not",
        )


def cutoff_and_clipping(end: float, settings: Settings) -> tuple[float, str]:
    """Cut-off [rad m⁻¹], and a sentence if the grid cuts the measured spectrum off, otherwise nothing.

    The measured spectrum ends at the Nyquist wave number of the scans at most [rad m⁻¹].
    """
    grid = np.pi / settings.spacing
    if is_at_most(end, grid):
        return (end if settings.beyond == "cut" else grid), ""
    ends, measured = (f"{from_si(wavenumber, 'rad_per_um'):.4g} rad/µm" for wavenumber in (grid, end))
    return grid, (
        f"the spectrum ends at the Nyquist wave number of the grid, {ends}, before that of the scans, {measured}; "
        "a finer sampling.spacing_nm keeps more"
    )


def _settings(plan, at):
    """Source of the spectrum of a measured surface, the strips it is used for, and the grid."""
    entry, sampling = plan.config["surfaces"][at.surface], plan.config["sampling"]
    use = select(SpectrumUse, sampling, surface=at.surface)
    return select(Settings, entry, spacing_nm=sampling["spacing_nm"], use=use)


STAGES = (
    Stage.writing(
        "spectrum_of_scans",
        "spectrum/{surface}",
        surfaces=lambda plan: plan.scans.surfaces,
        inputs=lambda plan, at: {stage: f"{stage}/{at.surface}" for stage in ("estimate", "heights")},
        settings=_settings,
        kind=Settings,
        compute=compute,
        label="spectrum",
        message="Spectrum of measured surface {surface} and of the underlying Gaussian field (Sec. II-B).",
    ),
)
