"""Memory of fields and tips drawn by a job, and its limits."""

from collections.abc import Iterator, Sequence

from stiction.config.kinds import kind_of
from stiction.config.units import NM_PER_UM, from_si
from stiction.models import FIELD

#: Grid of the paper, that of all surfaces that need no other: see `stiction.config.surfaces.grid`.
GRID = {"spacing_nm": 10, "margin_um": 1}
#: Side of the periodic fields on which spectra are estimated [µm].
FIELD_UM = from_si(FIELD, "um")
#: Memory of a job: libraries and small arrays [MB]; fields, their waves and their spectra [bytes per point]. Measured:
#: 54 bytes per point of a field whose spectrum is estimated, up to 24 of one from which a strip is cut.
_BASE, _PER_POINT = 350, 60
#: Memory of one tip at one slope in a contact that a job holds [bytes]. Measured: 1800 to 5700 (pairs a and c).
_PER_SLOPE = 6000
#: Memory that every job may use without a request [MB], and the most that a job may need.
USUAL, LARGEST = 800, 8000


def field_memory(length_um: float, width_um: float, spacing_nm: float) -> float:
    """Memory of a job with fields of this size on a grid of this spacing [MB].

    Examples
    --------
    >>> round(field_memory(10.24, 10.24, 10))
    413
    """
    points = (NM_PER_UM * length_um / spacing_nm) * (NM_PER_UM * width_um / spacing_nm)
    return _BASE + from_si(_PER_POINT * points, "MB")


def fields_of(
    device: dict, sampling: dict, others_nm: Sequence[float] = ()
) -> Iterator[tuple[str, tuple[float, float], float]]:
    """Yield the fields that a device draws: the key behind each, its sides [µm], and the distance of its points [nm].

    With an uncertainty, the patch is drawn at the distances of variants as well.
    """
    spacing, margin = sampling["spacing_nm"], sampling["margin_um"]
    length, width = kind_of(device).sides(device, sampling["strip_length_um"])
    key = "contact_um" if "contact_um" in device else "width_um"
    for at in (spacing, *(others_nm if "uncertainty" in device else ())):
        yield key, (length + margin, width + margin), at
    if "dimples" in device:
        length, width = device["dimples"]["contact_um"]
        yield "dimples.contact_um", (length + margin, width + margin), spacing


def tip_memory(slopes: int) -> float:
    """Memory of a job with the contacts of tips, for this number of slopes of all of them together [MB].

    Examples
    --------
    >>> round(tip_memory(12 * 400 * 15))  # 12 slopes of 400 tips in 15 contacts
    1232
    """
    return USUAL + from_si(_PER_SLOPE * slopes, "MB")
