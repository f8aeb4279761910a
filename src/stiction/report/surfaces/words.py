"""Surfaces of a configuration in words."""

from collections.abc import Collection, Mapping

from stiction.analysis.greenwood import ADHERE, BOND

#: Keys of a surface, what they are called and their unit.
_OF_SURFACES = {
    "rms_nm": ("rms", " nm"),
    "skewness": ("skewness", ""),
    "kurtosis": ("kurtosis", ""),
    "mean_summit_radius_um": ("mean radius of summits", " µm"),
    "summit_density_per_um2": ("density of summits", " per µm²"),
}
#: The same of its material.
_OF_MATERIALS = {"contact_angle_deg": ("contact angle", "°"), "coating_nm": ("coating", " nm")}


def surface_in_words(surface: Mapping, material: Mapping) -> str:
    """Surface of the configuration by its numbers, or by its scans, and by its material.

    Examples
    --------
    >>> surface_in_words({"rms_nm": 3.4, "skewness": -0.76, "kurtosis": 3.9}, {})
    'rms 3.4 nm, skewness -0.76, kurtosis 3.9'
    >>> surface_in_words({"rms_nm": 3.4, "material": "FDTS"}, {"contact_angle_deg": 110, "coating_nm": 1.2})
    'rms 3.4 nm, FDTS, contact angle 110°, coating 1.2 nm'
    """
    stated = _numbers_in_words(surface, _OF_SURFACES)
    if "scans" in surface:
        files = len(surface["scans"]["files"])
        stated.append(f"described by {files} {'scan' if files == 1 else 'scans'}")
    stated += [surface["material"]] if "material" in surface else []
    return ", ".join(stated + _numbers_in_words(material, _OF_MATERIALS))


def replica_in_words(replica: Mapping) -> str:
    """How a surface follows the substrate.

    Examples
    --------
    >>> replica_in_words({"coherence": 0.9, "above_nm": 100, "offset_nm": 0, "play_nm": 20})
    'follows the substrate with a coherence of 0.9, in waves above 100 nm, with a play of 20 nm in its plane'
    """
    above = [f"in waves above {replica['above_nm']:g} nm"] if replica.get("above_nm") else []
    beside = [f"{replica['offset_nm']:g} nm beside its register"] if replica.get("offset_nm") else []
    play = [f"with a play of {replica['play_nm']:g} nm in its plane"] if replica.get("play_nm") else []
    return ", ".join([f"follows the substrate with a coherence of {replica['coherence']:g}", *above, *beside, *play])


def adhesion_in_words(parameters: Collection[float]) -> str:
    """Adhesion parameters of a pair in all its airs [-], beside those of wafers.

    Examples
    --------
    >>> adhesion_in_words([81.2, 112.8])
    '81.2 to 113 (for comparison: dry wafers bond below 1 and do not adhere above 12; water is left out)'
    """
    ends = dict.fromkeys(f"{end:.3g}" for end in (min(parameters), max(parameters)))
    wafers = f"dry wafers bond below {BOND} and do not adhere above {ADHERE}"
    return f"{' to '.join(ends)} (for comparison: {wafers}; water is left out)"


def _numbers_in_words(section, words):
    """Numbers of a section, in words."""
    return [f"{name} {section[key]:g}{unit}" for key, (name, unit) in words.items() if key in section]
