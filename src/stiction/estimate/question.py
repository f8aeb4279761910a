"""Question to the estimate: a device on two described surfaces, from a file or from options. Plain Python."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from stiction.config.kinds import KINDS
from stiction.config.units import to_si
from stiction.contact.air import DRY, DRY_AIR, is_humid, is_possible
from stiction.estimate import dry
from stiction.estimate.bridge import Bridge
from stiction.estimate.closed.beams import SlenderBeam
from stiction.estimate.closed.life import BeamLife, Surroundings
from stiction.estimate.force import Stopper
from stiction.estimate.length import Impossible, LengthRow, Lengths, NotLearnt, lengths, most_after
from stiction.estimate.state import Film, TipState, stiffness_of
from stiction.estimate.statistics import Heights, moments_of, slope_of
from stiction.estimate.table import Surrogate
from stiction.estimate.voltage import KEYS as OF_VOLTAGES
from stiction.estimate.voltage import Driven, drive_of, energy_of

Library = Mapping[str, Mapping[str, Any]]

#: Keys of a surface, of a pair, of a cantilever, of a bridge and of a stopper that the estimate knows.
OF_SURFACES = ("rms_nm", "like", "hurst", "corner_rad_per_um", "cutoff_rad_per_um", "skewness", "kurtosis")
OF_SURFACES += ("unknown", "uncertainty", "psd", "published_psd", "mean_summit_radius_um", "summit_density_per_um2")
OF_PAIRS = ("beam", "substrate", "gap_um", "humidities", "attraction", "coarser_mesh")
OF_DEVICES = ("kind", "pair", "length_um", "thickness_um", "gap_um", "width_um", "humidities", "touchdowns")
OF_DEVICES += ("shock_g", *OF_VOLTAGES)
OF_BRIDGES = ("kind", "pair", "length_um", "thickness_um", "gap_um", "width_um", "residual_stress_MPa")
OF_BRIDGES += ("humidities", "touchdowns", "shock_g")
OF_STOPPERS = ("kind", "pair", "contact_um", "restoring_force_uN", "stiffness_N_per_m", "gap_um", "mass_ng")
OF_STOPPERS += ("humidities", "touchdowns", "electrode", "shock_g")
#: Keys that change the length to build alone: the estimate is of exact inputs, and leaves out what a run adds.
LEFT_OUT = ("uncertainty", "requirement", "chart", "roughness")
#: Sections of a file that change no length or force.
OF_FILES = ("run", "surfaces", "pairs", "devices", "figures", "studies", "beam", "chaos", "character", "seed")
#: Sections that change a device only where its device, pair or surface names an entry, with a key that is refused.
OF_NAMES = ("materials", "process", "test_beams", "liquids", "scans")
#: Keys of sections that change no length or force but by their numbers of samples.
OF_SAMPLES = {
    "design": ("accuracy", "beams", "shares", "chart_points", "budget_beams", "budget_samples", "samples_of_patches")
    + ("worst_humidities",),
    "contact": ("samples", "chunks"),
}
#: Sections by what devices have without them.
OF_DEFAULTS = {"attraction": {"reach": "all"}}
#: Keys of numbers that must be positive.
POSITIVE = ("rms_nm", "hurst", "corner_rad_per_um", "cutoff_rad_per_um", "kurtosis", "thickness_um", "gap_um")
POSITIVE += ("width_um", "length_um", "contact_um", "restoring_force_uN", "thickness_nm", "permittivity", "touchdowns")
POSITIVE += ("mass_ng", "stiffness_N_per_m", "area_um2", "surface_tension_mN_per_m", "density_kg_per_m3")
#: Largest contact angle [°].
_STRAIGHT = 180
#: Keys of which the second number must be above the first. A length in metres is not.
_IN_ORDER = ("thickness_um", "length_um"), ("gap_um", "length_um"), ("corner_rad_per_um", "cutoff_rad_per_um")
#: Numbers that a surface may leave open.
_OPEN = ("skewness", "kurtosis", "hurst", "corner_rad_per_um", "cutoff_rad_per_um")
#: These by the words of key ``unknown``. An unknown rms is not among them.
_WORDS = dict(zip(("skewness", "kurtosis", "hurst", "corner", "cutoff"), _OPEN, strict=True))


@dataclass(frozen=True)
class Question:
    """Question about one cantilever."""

    name: str
    surfaces: tuple[Heights, Heights]  #: as stated
    members: tuple[dict[str, Heights], dict[str, Heights]]  #: typical surfaces in place of each that is partly assumed
    humidities: tuple[float, ...]  #: [-]
    thickness: float  #: [m]
    gap: float  #: [m]
    width: float  #: [m]
    length: float | None = None  #: [m]
    touchdowns: int = 1
    left_out: tuple[str, ...] = ()  #: keys that a run would read as well
    averaged: bool = False  #: whether the length is the mean over typical surfaces, not that on the stated one
    added: float = 0.0  #: energy that a voltage adds [J m⁻²]
    constant: float = dry.POLYSILICON  #: Hamaker constant of the solids in dry air [J]
    surroundings: Surroundings = Surroundings()
    unit: ClassVar[str] = "um"  #: of its size, a length

    @property
    def size(self) -> float | None:
        """Its length [m]."""
        return self.length

    @property
    def most(self) -> float:
        """Largest fraction that is known after all touchdowns [-]."""
        return most_after(self.touchdowns)

    @property
    def stated(self) -> float | None:
        """Its length [m]."""
        return self.length

    def _stiffness(self, modulus):
        """Stiffness as of `stiction.estimate.state`."""
        return stiffness_of(modulus, self.thickness, self.gap)

    def closed(self, modulus: float) -> Driven:
        """Closed form of its lengths at its voltage, from the modulus of the solids [Pa]."""
        return Driven(drive_of(self.added, self._stiffness(modulus), self.gap))

    def life(self, modulus: float) -> BeamLife:
        """Its life, from the modulus of the beam [Pa]."""
        return BeamLife(SlenderBeam(1, self.thickness, self.gap, self.width, modulus), self.surroundings)

    def errors(self, table: Mapping[str, Any]) -> Mapping[str, Any]:
        """Part of the table with the errors of its lengths."""
        return table

    def lengths(
        self, heights: Heights, water: Film, table: Mapping[str, Any], tips: Surrogate, full: Surrogate | None
    ) -> Lengths:
        """Lengths at which it sticks on the sum of two surfaces [m]."""
        state = TipState(heights, water, self._stiffness(table["modulus"]), self.width, table["modulus"])
        return lengths(state, self.gap, tips, full)

    def in_dry_air(self, heights: Heights, table: Mapping[str, Any]) -> Lengths:
        """Lengths at which it sticks in dry air [m]."""
        tip = dry.DryTip(heights, self.constant, self._stiffness(table["modulus"]), self.width, table["modulus"])
        return dry.lengths(tip, self.gap, *dry.processes(table["dry"], "tips", "full"))

    def row(self, row: LengthRow) -> LengthRow:
        """Row of lengths as it is.

        Raises
        ------
        NotLearnt
            If it holds beams that are not slender.
        """
        if row.length <= max(self.thickness, self.gap):
            raise NotLearnt("it sticks even at a length below its gap or thickness: change voltage or dielectric")
        return row


def surface(entry: Mapping[str, Any], library: Library) -> tuple[Heights, dict[str, Heights]]:
    """Statistics of a surface, and of each typical surface in its place where numbers are left open.

    As `stiction.config.surfaces.described.complete` and `stiction.config.surfaces.members.members`.
    """
    refuse_impossible(entry)
    if unknown := [key for key in entry if key not in OF_SURFACES]:
        raise NotLearnt(f"{unknown[0]} of a surface is not among what was learnt")
    if "psd" in entry and entry["psd"] != "published":
        raise NotLearnt("a spectrum that is identified from summits was not learnt: state its corner and slope")
    if "psd" in entry:
        numbers = _numbers(entry)
        left_open = [_WORDS[word] for word in entry.get("unknown", ())]
        known = {key: value for key, value in numbers.items() if key not in left_open}
        members = {name: _as(other, known, left_open) for name, other in library.items()} if left_open else {}
        return _statistics(numbers), members
    left_open = [key for key in _OPEN if key not in entry]
    members = {name: _as(other, entry, left_open) for name, other in library.items()} if left_open else {}
    if "like" in entry:
        if entry["like"] not in library:
            raise Impossible(f"like must be one of {', '.join(library)}")
        return _as(library[entry["like"]], entry, left_open), members
    if needed := [key for key in left_open if key in _OPEN[2:]]:
        raise NotLearnt(f"a surface without {needed[0]} needs like: one of {', '.join(library)}")
    means = {key: sum(other[key] for other in library.values()) / len(library) for key in _OPEN[:2]}
    return _statistics(means | entry), members


def _as(other, entry, left_open):
    """Statistics of a surface with those numbers of another one that it leaves open."""
    numbers = _numbers(other)
    return _statistics({key: numbers[key] for key in left_open} | entry)


def _numbers(entry):
    """Numbers of a surface in normal form, as files describe it."""
    psd = entry["published_psd"]
    own = {key: entry[key] for key in ("rms_nm", *_OPEN[:2])} | {key: psd[key] for key in _OPEN[3:]}
    return own | {"hurst": -slope_of(psd) / 2 - 1}


def _statistics(numbers):
    """Statistics of a surface by all of its numbers."""
    ends = (to_si(numbers[key], "rad_per_um") for key in _OPEN[3:])
    moments = moments_of(*ends, -2 * (1 + numbers["hurst"]))
    return Heights(to_si(numbers["rms_nm"], "nm"), numbers["skewness"], numbers["kurtosis"], moments)


def refuse_impossible(numbers: Mapping[str, Any], names: Mapping[str, str] | None = None) -> None:
    """Refuse numbers that no surface or device has, by their keys or by other names of these.

    Raises
    ------
    Impossible
        If a number is impossible.
    """
    names = {key: key for key in numbers} | (names or {})
    for air in numbers.get("humidities", ()):
        if not (air == DRY or is_possible(air)):
            raise Impossible(f"{names['humidities']} must be {DRY}, or above 0 and below 1, got {air}")
    for key in [key for key in POSITIVE if key in numbers]:
        value = numbers[key]
        if not all(0 < each < math.inf for each in (value if isinstance(value, Sequence) else [value])):
            raise Impossible(f"{names[key]} must be above 0, got {value}")
    _refuse_negative(numbers, names)
    for less, more in [pair for pair in _IN_ORDER if numbers.keys() >= set(pair)]:
        if numbers[more] <= numbers[less]:
            got = f"got {numbers[more]}, {numbers[less]}"
            raise Impossible(f"{names[more]} must be above {names[less]}, in the same unit, {got}")


def _refuse_negative(numbers, names):
    """Refuse a bridge that may buckle, a shock without a size, and an impossible angle."""
    for key in ("residual_stress_MPa", "shock_g"):
        if not 0 <= (value := numbers.get(key, 0)) < math.inf:
            raise Impossible(f"{names[key]} must be 0 or above, got {value}")
    if not 0 <= (angle := numbers.get("contact_angle_deg", 0)) <= _STRAIGHT:
        raise Impossible(f"contact_angle_deg must be from 0 to {_STRAIGHT}, got {angle}")


def questions(
    content: Mapping[str, Any], table: Mapping[str, Any]
) -> dict[str, Question | Stopper | Bridge | NotLearnt]:
    """Questions of the devices of a file as it is written, or why the estimate does not know them.

    The table has the typical surfaces, and the pairs of the paper.
    """
    found, devices = {}, content.get("devices", {})
    if "file" in devices:
        return {"Table": NotLearnt("devices of a table were not learnt")}
    for name, device in devices.items():
        try:
            found[name] = _question(name, device, content, table)
        except NotLearnt as reason:
            found[name] = reason
        except (KeyError, TypeError, AttributeError, ArithmeticError, ValueError) as wrong:
            found[name] = NotLearnt(f"its file is not complete, at {wrong}; stiction check says what is wrong")
    return found


def _question(name, device, content, table):
    """Question of one device."""
    others = [f"{part}.{key}" for part, keys in OF_SAMPLES.items() for key in content.get(part, {}) if key not in keys]
    others += [key for key in content if key not in (*OF_FILES, *OF_NAMES, *OF_SAMPLES)]
    if others := [key for key in others if key not in OF_DEFAULTS or content[key] != OF_DEFAULTS[key]]:
        raise NotLearnt(f"{others[0]} was not learnt")
    known, of = _of_kind(device["kind"])
    left_out = tuple(key for key in LEFT_OUT if key in device)
    if others := [key for key in device if key not in known + LEFT_OUT]:
        raise NotLearnt(f"{others[0]} was not learnt")
    pair, library = (table["pairs"] | content.get("pairs", {}))[device["pair"]], table["library"]
    if others := [key for key in pair if key not in OF_PAIRS]:
        raise NotLearnt(f"{others[0]} of a pair was not learnt")
    materials = content.get("materials", {})
    for section in (device | device.get("dielectric", {}), device.get("electrode", {}), *_further(content)):
        refuse_impossible(section)
    surfaces = library | content.get("surfaces", {})
    entries = [dict(surfaces[pair[side]]) for side in ("beam", "substrate")]
    surroundings = Surroundings.of_device(device, content, materials.get(entries[0].get("material"), {}))
    constant = dry.constant_of(entries, materials)
    if any([entry.pop("material", "") for entry in entries]) and any(map(is_humid, airs_of(device))):
        raise NotLearnt("material of a surface was learnt in dry air alone")
    sides = [surface(entry, library) for entry in entries]
    return of(name, device, sides, left_out=left_out, constant=constant, surroundings=surroundings)


def _further(content):
    """Sections of liquids and materials of a file."""
    return [section for key in ("liquids", "materials") for section in content.get(key, {}).values()]


def airs_of(device: Mapping[str, Any]) -> tuple[float, ...]:
    """Humidities of a device, that of dry air by its word or as a number [-]."""
    return tuple(DRY_AIR.humidity if air == DRY else air for air in device["humidities"])


def _of_kind(name):
    """Known keys of devices of a kind, and their question as `of_numbers`."""
    kind = KINDS.get(name)
    if kind is None or not (kind.has_tip or kind.is_patch or kind.has_short_strips):
        raise NotLearnt("only cantilevers, bridges and stoppers were learnt")
    if kind.has_short_strips:
        return OF_BRIDGES, of_middle
    return (OF_DEVICES, of_numbers) if kind.has_tip else (OF_STOPPERS, of_area)


def of_area(name: str, device: Mapping[str, Any], sides: Sequence, **more: Any) -> Stopper:
    """Question about a stopper, as of `of_numbers`."""
    surfaces, members = zip(*sides, strict=True)
    area = tuple(to_si(side, "um") for side in device["contact_um"])
    kind = KINDS.get(device.get("kind"))
    stated = kind.stated(device) if kind and any(set(way.keys) <= device.keys() for way in kind.ways) else device
    force = to_si(stated["restoring_force_uN"], "uN") if "restoring_force_uN" in stated else None
    airs, touchdowns = airs_of(device), device.get("touchdowns", 1)
    return Stopper(name, surfaces, members, airs, area, force, touchdowns, **more)


def of_middle(name: str, device: Mapping[str, Any], sides: Sequence, **more: Any) -> Bridge:
    """Question about a bridge, as of `of_numbers`."""
    more.pop("constant", None)  # counts in dry air alone, where bridges were not learnt
    surfaces, members = zip(*sides, strict=True)
    sizes, length = _sizes(device)
    airs, stress = airs_of(device), to_si(device["residual_stress_MPa"], "MPa")
    return Bridge(name, surfaces, members, airs, *sizes, stress, length, device.get("touchdowns", 1), **more)


def _sizes(device):
    """Thickness, gap and width of a beam, and its length if stated [m]."""
    sizes = [to_si(device[f"{size}_um"], "um") for size in ("thickness", "gap", "width")]
    return sizes, to_si(device["length_um"], "um") if "length_um" in device else None


def of_numbers(name: str, device: Mapping[str, Any], sides: Sequence, **more: Any) -> Question:
    """Question by the numbers of a device in the units of files, and both surfaces with their members."""
    surfaces, members = zip(*sides, strict=True)
    sizes, length = _sizes(device)
    airs, more = airs_of(device), more | {"added": energy_of(device, sizes[1])}
    return Question(name, surfaces, members, airs, *sizes, length, device.get("touchdowns", 1), **more)
