"""Kinds of devices: their keys, their places of contact, and the parts able to stick.

All other code asks the object of a kind, never its name: a new kind is an entry of `KINDS` and of the schema. How
devices release is in tables of the stages and of the report, under the name of a `Release`.
"""

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

from stiction.config.units import from_si, in_si
from stiction.contact.probes.shape import Probe

#: Keys that every device may have.
COMMON = (
    "kind",
    "pair",
    "humidities",
    "uncertainty",
    "test_beams",
    "requirement",
    "roughness",
    "process",
    "second_process",
    "touchdowns",
    "conditions",
)
COMMON += ("voltage_V", "offset_V", "dielectric", "shock_g")
#: Keys of a life under a spring, and of what changes it.
OF_SPRINGS = ("requirement", "roughness", "process", "second_process", "test_beams", "touchdowns", "conditions")
OF_SPRINGS += ("voltage_V", "offset_V", "dielectric", "mass_ng", "electrode", "shock_g")
#: Question about a device without a spring, a name of tables as that of a `Release`.
PULL_OFF = "pull_off"
#: Keys that depend on the kind, what they are called and their unit.
KEYS = {
    "thickness_um": ("thickness", "µm"),
    "gap_um": ("gap", "µm"),
    "width_um": ("width", "µm"),
    "length_um": ("length", "µm"),
    "residual_stress_MPa": ("tensile stress", "MPa"),
    "contact_um": ("sides of the area in contact", "µm"),
    "stiffness_N_per_m": ("stiffness of the spring", "N/m"),
    "restoring_force_uN": ("restoring force", "µN"),
    "radius_um": ("radius", "µm"),
    "flat_um": ("radius of the flat", "µm"),
    "measured_nN": ("measured pull-off force", "nN"),
    "measured_error_nN": ("its standard uncertainty", "nN"),
    "mass_ng": ("moving mass", "ng"),
    "voltage_V": ("voltage", "V"),
    "offset_V": ("offset of the voltage", "V"),
}


class Roughness(NamedTuple):
    """Varied quantity of a surface, or of one that follows another, the axis of a computation."""

    words: str  #: what it is called
    unit: str  #: with a space before it; empty without a unit
    scale: str  #: of `stiction.devices.roughness.SCALES`, in which its values are evenly spaced
    smooths: int = 0  #: sign of a change that makes the sum of both surfaces smoother, zero where neither does
    of_replica: bool = False  #: whether it is one of key ``replica`` of the pair


#: Quantities of section ``roughness`` by their keys.
ROUGHNESSES = {
    "rms_nm": Roughness("rms", " nm", "log", -1),
    "skewness": Roughness("skewness", "", "linear"),
    "corner_rad_per_um": Roughness("corner of the spectrum", " rad/µm", "log"),
    "coherence": Roughness("coherence", "", "rest", 1, of_replica=True),
    "play_nm": Roughness("play", " nm", "linear", -1, of_replica=True),
}


@dataclass(frozen=True, kw_only=True)
class Release:
    """Release of stuck devices, and its consequences for their configuration."""

    name: str  #: in settings, and in the tables of later folders
    sides: Callable[["Kind", Mapping, float], tuple[float, float]]  #: of a patch, parameters as of `Kind.sides` [µm]
    required: tuple[str, ...] = ()  #: keys of a requirement beside its fraction
    refusal: str  #: of another requirement
    has_laws: bool = False  #: whether it follows force laws by a chaos model
    in_any_air: bool = False  #: whether the worst humidity is sought along an axis


#: Beams crack open along their strips.
BEAM = Release(
    name="beam",
    sides=lambda kind, device, of_pairs: (kind.strip(device, of_pairs), device["width_um"]),
    required=("length_um",),
    refusal="must come with length_um",
    has_laws=True,
)
#: Others are pulled off at once with their whole area.
STOPPER = Release(
    name="stopper",
    sides=lambda kind, device, _of_pairs: kind.area(device),
    refusal="must come without length_um, for a stopper has a force",
    in_any_air=True,
)


class Way(NamedTuple):
    """Way to state the restoring force of a device, or that none pulls it and its pull-off force is asked for."""

    keys: tuple[str, ...]  #: first the number that grows with the force
    per: Callable[[Mapping], float] | None = None  #: force for one unit of this number [µN], none without a spring


@dataclass(frozen=True, kw_only=True)
class Kind:
    """Differences between the devices of one kind and others."""

    words: str  #: what it is
    drawing: str  #: template of its drawing
    keys: tuple[str, ...]  #: that it must have, of `KEYS`
    ways: tuple[Way, ...] = ()  #: of its restoring force, of which it has one
    optional: tuple[str, ...] = ()  #: keys that it may have
    release: Release = BEAM
    has_tip: bool = False  #: whether a free end may hold it
    longest_strip: float = math.inf  #: of its strips where not stated [µm]; short ones resolve the middle of a beam
    shape: tuple[str, ...] = ()  #: keys of a `stiction.contact.probes.shape.Probe`, none of what is flat

    @property
    def allowed_keys(self) -> tuple[str, ...]:
        """All keys allowed for it."""
        return (*COMMON, *self.keys, *chain.from_iterable(way.keys for way in self.ways), *self.optional)

    def refusal(self, keys: Collection[str]) -> str | None:
        """Refusal of the keys of a device, one missing or of another kind, as the end of a sentence.

        Examples
        --------
        >>> KINDS["stopper"].refusal(["kind", "pair", "humidities", "contact_um", "stiffness_N_per_m"])
        'must come with either restoring_force_uN, or stiffness_N_per_m and gap_um'
        """
        if missing := [key for key in self.keys if key not in keys]:
            return f"must come with {', '.join(missing)}"
        if strange := [key for key in keys if key not in self.allowed_keys]:
            return f"must come without {', '.join(sorted(strange))}: its keys are {', '.join(self.allowed_keys)}"
        ways = [way.keys for way in self.ways]
        if ways and set(keys) & set(chain(*ways)) not in map(set, ways):
            either = "either " if len(ways) > 1 else ""
            return f"must come with {either}{', or '.join(' and '.join(way) for way in ways if way)}"
        return self._without_spring(keys)

    def _without_spring(self, keys):
        """Refusal of keys of a spring where none is stated."""
        if not self.ways or self.way(keys).per or not (strange := [key for key in keys if key in OF_SPRINGS]):
            return None
        springs = ", or ".join(" and ".join(way.keys) for way in self.ways if way.per)
        return f"must come without {', '.join(sorted(strange))}, or with a spring: {springs}"

    @property
    def unasked(self) -> list[str]:
        """Optional keys of the life of devices that are of other kinds alone.

        Examples
        --------
        >>> KINDS["probe"].unasked, KINDS["bridge"].unasked
        ([], ['electrode', 'mass_ng'])
        """
        return sorted({"mass_ng", "electrode", "voltage_V"} - set(self.allowed_keys))

    @property
    def is_patch(self) -> bool:
        """Whether it touches with a flat area at once.

        Examples
        --------
        >>> [name for name, kind in KINDS.items() if kind.is_patch]
        ['stopper']
        """
        return self.release is STOPPER and not self.shape

    @property
    def has_short_strips(self) -> bool:
        """Whether its strips may be shorter than those of pairs and than the correlation of the surfaces."""
        return self.longest_strip < math.inf

    def strip(self, device: Mapping, of_pairs: float) -> float:
        """Length of the strips along a beam [µm]: from its section, or the pairs', or shorter.

        Examples
        --------
        >>> KINDS["cantilever"].strip({}, 1.5), KINDS["bridge"].strip({}, 1.5), KINDS["bridge"].strip({}, 0.3)
        (1.5, 0.5, 0.3)
        """
        return device.get("strip_um", min(of_pairs, self.longest_strip))

    def sides(self, device: Mapping, of_pairs: float) -> tuple[float, float]:
        """Sides of its patch of contact [µm]: of a strip along a beam, or of the whole area of a stopper."""
        return self.release.sides(self, device, of_pairs)

    def shape_of(self, device: Mapping) -> dict:
        """Section of the shape of a device, empty if it is flat."""
        return {key: device[key] for key in self.shape if key in device}

    def area(self, device: Mapping) -> tuple[float, float]:
        """Sides of the area under a device [µm], as stated or from its shape.

        Examples
        --------
        >>> KINDS["probe"].area({"radius_um": 5})
        (2.0, 2.0)
        """
        if "contact_um" in device or not self.shape:
            return tuple(device["contact_um"])
        side = round(from_si(in_si(Probe, self.shape_of(device)).side, "um"), 6)
        return side, side

    def way(self, device: Collection[str]) -> Way:
        """Way in which the section of a device, or its keys, states its restoring force."""
        return next(way for way in self.ways if set(way.keys) <= set(device))

    def question(self, device: Mapping) -> str:
        """Question about a device, a name of tables: how it releases, or its pull-off force where no spring pulls it.

        Examples
        --------
        >>> KINDS["probe"].question({"radius_um": 5}), KINDS["probe"].question({"restoring_force_uN": 1})
        ('pull_off', 'stopper')
        """
        return PULL_OFF if self.ways and self.way(device).per is None else self.release.name

    def stated(self, device: Mapping) -> dict:
        """Section of a device, with the restoring force [µN] that follows from it, if it has a spring.

        Examples
        --------
        >>> KINDS["stopper"].stated({"stiffness_N_per_m": 2, "gap_um": 1.5})["restoring_force_uN"]
        3.0
        """
        if not self.ways or not (way := self.way(device)).per:
            return dict(device)
        return device | {"restoring_force_uN": device[way.keys[0]] * way.per(device)}


#: Ways to state what pulls a stopper or a probe off.
_PULLED = (
    Way(("restoring_force_uN",), lambda _: 1),
    Way(("stiffness_N_per_m", "gap_um"), lambda device: device["gap_um"]),
)
#: All kinds by name.
KINDS = {
    "cantilever": Kind(
        words="beam clamped at one end",
        drawing="cantilever.svg",
        keys=("thickness_um", "gap_um", "width_um"),
        optional=("length_um", "strip_um", "chart", "dimples"),
        has_tip=True,
    ),
    "bridge": Kind(
        words="beam clamped at both ends",
        drawing="bridge.svg",
        keys=("thickness_um", "gap_um", "width_um", "residual_stress_MPa"),
        optional=("length_um", "strip_um", "chart", "dimples"),
        # ASSUME: strips of 0.5 µm resolve the middle of a bridge, which is held on 2 to 6 µm. Shorter ones hold more:
        # on pair b (t = h = 2 µm, 50 MPa, p = 0.001), 0.25, 0.5 and 1.5 µm give 233, 236 and 242 µm at RH 0.44, 176,
        # 175 and 181 µm at 0.67, 112.2, 112.2 and 113.2 µm at 0.92, with standard errors of about 1 %. Windows of one
        # surface give the same as independent strips: 208.7 ± 1.2 and 208.2 ± 0.7 µm on average at RH 0.67.
        longest_strip=0.5,
    ),
    "stopper": Kind(
        words="stopper",
        drawing="stopper.svg",
        keys=("contact_um",),
        ways=_PULLED,
        optional=("mass_ng", "electrode", "tilt_deg"),
        release=STOPPER,
    ),
    "probe": Kind(
        words="probe",
        drawing="probe.svg",
        keys=("radius_um",),
        ways=(*_PULLED, Way(("measured_nN", "measured_error_nN")), Way(())),
        optional=("mass_ng", "electrode", "flat_um", "contact_um"),
        release=STOPPER,
        shape=("radius_um", "flat_um"),
    ),
}


def kind_of(device: Mapping) -> Kind:
    """Kind of a device, from its section of the configuration."""
    return KINDS[device["kind"]]
