"""Common names of the whole package: models, the two surfaces of a pair, quantities and scans of a surface, fields."""

#: Models of the heights: Gaussian and non-Gaussian.
SURFACE_MODELS = ("G", "NG")
#: Models of the beams: GEO has the force laws of NG and beams of scattered dimensions.
BEAM_MODELS = (*SURFACE_MODELS, "GEO")
#: The two surfaces of a pair, in the order in which all sequences contain them.
SIDES = ("beam", "substrate")
#: Quantities of maximum-entropy heights, of measured heights and of spectra, see `stiction.analysis.shifts`.
MOMENT_QUANTITIES, SPECTRUM_QUANTITIES = ("rms", "skewness", "kurtosis"), ("corner", "slope")
MODE_QUANTITIES = ("rms", *(f"mode{k}" for k in range(2, 9)))
#: Quantities whose errors can be larger than the steps of slopes, see `stiction.analysis.shifts.step_of`.
FAR_QUANTITIES = ("rms", "kurtosis", *SPECTRUM_QUANTITIES)
#: Sides of a shift, as in names of files: a quantity decreased, and increased.
SHIFTS = ("less", "more")
#: Keys of a surface described by scans that choose how these are evaluated, and the two values of each.
ALTERNATIVES_OF_SCANS = {"beyond": ("cut", "continued"), "heights": ("moments", "measured")}
#: Keys of the measured statistics of a surface: moments of the heights and summit statistics.
MOMENT_KEYS = ("rms_nm", "skewness", "kurtosis")
SUMMIT_KEYS = ("mean_summit_radius_um", "summit_density_per_um2")
#: Least side of the periodic fields on which spectra are estimated [m].
FIELD = 10.24e-6


def surface_model(model: str) -> str:
    """Model of the heights of the surfaces for beams of a model."""
    return "G" if model == "G" else "NG"
