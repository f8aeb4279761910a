"""Memory of the jobs that draw surfaces, from the size of the largest field that they hold."""

#: Side of the periodic fields on which spectra are estimated [µm]; `stiction.stages.surfaces.FIELD`.
FIELD_UM = 10.24
#: Memory of a job: libraries and small arrays [MB]; fields, their waves and their spectra [bytes per point]. Measured:
#: 54 bytes per point of a field whose spectrum is estimated, up to 24 of one from which a strip is cut.
_BASE, _PER_POINT = 350, 60
#: Memory that every job may use without asking for it [MB], and the most that a job may need.
USUAL, LARGEST = 800, 8000


def of_field(length_um: float, width_um: float, spacing_nm: float) -> float:
    """Memory of a job that draws fields of this size on a grid of this spacing [MB].

    Examples
    --------
    >>> round(of_field(10.24, 10.24, 10))
    413
    """
    return _BASE + 1e-6 * _PER_POINT * (1e3 * length_um / spacing_nm) * (1e3 * width_um / spacing_nm)


def of_job(config: dict) -> int:
    """Memory to reserve for any job that draws surfaces of a configuration [MB]."""
    sampling, patch = config["sampling"], config["identification"]["patch_um"]
    strip = sampling["strip_length_um"] + sampling["margin_um"], config["beam"]["width_um"] + sampling["margin_um"]
    spacings = sampling["spacing_nm"], *config["studies"]["variants"]["spacing_nm"]
    sides = (FIELD_UM, FIELD_UM), (patch, patch)
    needed = [of_field(*side, spacings[0]) for side in sides] + [of_field(*strip, spacing) for spacing in spacings]
    return max(USUAL, round(max(needed)))
