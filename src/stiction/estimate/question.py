"""Question to the estimate: a device on two described surfaces, from a file or from options. Plain Python."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from stiction.config.kinds import KINDS
from stiction.config.units import to_si
from stiction.constants import HAMAKER_CONSTANT
from stiction.contact.air import DRY, DRY_AIR, is_possible
from stiction.estimate import dry
from stiction.estimate.asked import Asked
from stiction.estimate.bridge import Bridge
from stiction.estimate.closed import flats
from stiction.estimate.closed.beams import SlenderBeam
from stiction.estimate.closed.flats import FlatBound, FlatPull
from stiction.estimate.closed.life import BeamLife, Surroundings
from stiction.estimate.force import Stopper
from stiction.estimate.length import Impossible, LengthRow, Lengths, NotLearnt, lengths
from stiction.estimate.solids import SolidPair
from stiction.estimate.state import Film, TipState, stiffness_of
from stiction.estimate.statistics import Heights, moments_of, slope_of
from stiction.estimate.table import Surrogate, processes
from stiction.estimate.voltage import KEYS as OF_VOLTAGES
from stiction.estimate.voltage import Driven, drive_of, energy_of, tension_of

Library = Mapping[str, Mapping[str, Any]]

#: Keys of a surface, of a pair, of a cantilever, of a bridge and of a stopper that the estimate knows.
OF_SURFACES = ("rms_nm", "like", "hurst", "corner_rad_per_um", "cutoff_rad_per_um", "skewness", "kurtosis")
OF_SURFACES += ("unknown", "uncertainty", "psd", "published_psd", "mean_summit_radius_um", "summit_density_per_um2")
OF_PAIRS = ("beam", "substrate", "gap_um", "humidities", "attraction", "coarser_mesh")
OF_DEVICES = ("kind", "pair", "length_um", "thickness_um", "gap_um", "width_um", "humidities", "touchdowns")
OF_DEVICES += ("shock_g", *OF_VOLTAGES)
OF_BRIDGES = ("kind", "pair", "length_um", "thickness_um", "gap_um", "width_um", "residual_stress_MPa")
OF_BRIDGES += ("humidities", "touchdowns", "shock_g", *OF_VOLTAGES)
OF_STOPPERS = ("kind", "pair", "contact_um", "restoring_force_uN", "stiffness_N_per_m", "gap_um", "mass_ng")
OF_STOPPERS += ("humidities", "touchdowns", "electrode", "shock_g", *OF_VOLTAGES)
#: Keys of a material, of which the last two change no length or force.
OF_MATERIALS = ("young_modulus_GPa", "poisson_ratio", "hamaker_constant_zJ", "contact_angle_deg")
OF_MATERIALS += ("hardness_GPa", "density_kg_per_m3")
#: Keys that change the length to build alone: the estimate is of exact inputs, and leaves out what a run adds.
LEFT_OUT = ("uncertainty", "requirement", "chart", "roughness")
#: Sections of a file that change no length or force.
OF_FILES = ("run", "surfaces", "pairs", "devices", "figures", "studies", "beam", "chaos", "character", "seed")
#: Sections that change a device only where its device, pair or surface names an entry, with a key that is refused.
OF_NAMES = ("materials", "process", "test_beams", "liquids", "scans")
#: Keys of sections that the estimate reads, or that change no length or force but by their numbers of samples.
OF_SECTIONS = {
    "solid": ("young_modulus_GPa", "poisson_ratio"),
    "water": ("temperature_K",),
    "design": ("accuracy", "beams", "shares", "chart_points", "budget_beams", "budget_samples", "samples_of_patches")
    + ("worst_humidities",),
    "contact": ("samples", "chunks"),
}
#: Sections by what devices have without them.
OF_DEFAULTS = {"attraction": {"reach": "all"}}
#: Keys of numbers that must be positive.
POSITIVE = ("rms_nm", "hurst", "corner_rad_per_um", "cutoff_rad_per_um", "kurtosis", "thickness_um", "gap_um")
POSITIVE += ("width_um", "length_um", "contact_um", "restoring_force_uN", "thickness_nm", "permittivity", "touchdowns")
POSITIVE += ("mass_ng", "stiffness_N_per_m", "area_um2", "surface_tension_mN_per_m")


class Ends(NamedTuple):
    """Ends of a number in a configuration, as its schema has them."""

    low: float
    high: float
    least: str = "at least"  #: or above
    most: str = "at most"  #: or below

    def refusal(self, value: float) -> str | None:
        """Refusal of a value beyond them, as the end of a sentence."""
        is_low = value < self.low or (value == self.low and self.least == "above")
        is_high = value > self.high or (value == self.high and self.most == "below")
        allowed = f"must be a number {self.least} {self.low:g} and {self.most} {self.high:g}"
        return f"is {value}, {allowed}" if is_low or is_high else None


#: Ends of the numbers of surfaces, solids and water.
ENDS = {
    "rms_nm": Ends(0.001, 1000),
    "skewness": Ends(-10, 10),
    "kurtosis": Ends(1, 100, "above"),
    "mean_summit_radius_um": Ends(0.001, 1000),
    "summit_density_per_um2": Ends(0, 100_000, "above"),
    "hurst": Ends(0, 1),
    "corner_rad_per_um": Ends(0.01, 100_000),
    "cutoff_rad_per_um": Ends(0.01, 100_000),
    "young_modulus_GPa": Ends(0, 2000, "above"),
    "poisson_ratio": Ends(-1, 0.5, "above", "below"),
    "contact_angle_deg": Ends(0, 180),
    "density_kg_per_m3": Ends(50, 30_000),
    "temperature_K": Ends(273, 373),
}
#: The same of a Hamaker constant through any medium.
OF_ATTRACTION = dict.fromkeys(HAMAKER_CONSTANT, Ends(0, 10_000, "above"))
#: Keys of which the second number must be above the first. A length in metres is not.
_IN_ORDER = ("thickness_um", "length_um"), ("gap_um", "length_um"), ("corner_rad_per_um", "cutoff_rad_per_um")
#: Numbers that a surface may leave open.
_OPEN = ("skewness", "kurtosis", "hurst", "corner_rad_per_um", "cutoff_rad_per_um")
#: These by the words of key ``unknown``. An unknown rms is not among them.
_WORDS = dict(zip(("skewness", "kurtosis", "hurst", "corner", "cutoff"), _OPEN, strict=True))


@dataclass(frozen=True)
class Question(Asked):
    """Question about one cantilever."""

    thickness: float  #: [m]
    gap: float  #: [m]
    width: float  #: [m]
    length: float | None = None  #: [m]

    @property
    def size(self) -> float | None:
        """Its length [m]."""
        return self.length

    @property
    def _stiffness(self):
        """Stiffness as of `stiction.estimate.state`."""
        return stiffness_of(self.solids.beam_modulus, self.thickness, self.gap)

    @property
    def closed(self) -> Driven:
        """Closed form of its lengths at its voltage."""
        return Driven(drive_of(self.added, self._stiffness, self.gap))

    @property
    def life(self) -> BeamLife:
        """Its life."""
        sizes = self.thickness, self.gap, self.width, self.solids.beam_modulus
        return BeamLife(SlenderBeam(1, *sizes), self.surroundings)

    def on_flats(self, attracted: Sequence[FlatPull]) -> FlatBound:
        """Lengths that flat surfaces hold by their attractions."""
        return flats.of_cantilever(self.life.beam, attracted)

    def errors(self, table: Mapping[str, Any]) -> Mapping[str, Any]:
        """Part of the table with the errors of its lengths."""
        return table

    def lengths(
        self, heights: Heights, water: Film, table: Mapping[str, Any], tips: Surrogate, full: Surrogate | None
    ) -> Lengths:
        """Lengths at which it sticks on the sum of two surfaces [m]."""
        solids, ratios = self.solids, self.solids.beside_water(water.energy)
        state = TipState(heights, water, self._stiffness, self.width, solids.modulus, ratios)
        return lengths(state, self.gap, tips, full, *processes(table))

    def in_dry_air(self, heights: Heights, table: Mapping[str, Any]) -> Lengths:
        """Lengths at which it sticks in dry air [m]."""
        tip = dry.DryTip(heights, self.solids.in_dry_air, self._stiffness, self.width, self.solids.modulus)
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
    _refuse_keys(entry)
    if "psd" in entry and entry["psd"] != "published":
        raise NotLearnt("a spectrum that is identified from summits was not learnt: state its corner and slope")
    if "psd" in entry:
        numbers = _numbers(entry)
        left_open = [_WORDS[word] for word in entry.get("unknown", ())]
        stated = {key: value for key, value in numbers.items() if key not in left_open}
        members = {name: _as(other, stated, left_open) for name, other in library.items()} if left_open else {}
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


def _refuse_keys(entry):
    """Refuse keys of a surface that are not known, or that come alone."""
    if unknown := [key for key in entry if key not in OF_SURFACES]:
        raise NotLearnt(f"{unknown[0]} of a surface is not among what was learnt")
    for key, other in (_OPEN[:2], _OPEN[1::-1]):
        if key in entry and other not in entry:
            raise Impossible(f"{key} of a surface must come with {other}: both are stated or neither")


def _as(other, entry, left_open):
    """Statistics of a surface with those numbers of another one that it leaves open."""
    numbers = _numbers(other)
    return _statistics({key: numbers[key] for key in left_open} | entry)


def _numbers(entry):
    """Numbers of a surface in normal form, as files describe it."""
    psd = entry["published_psd"]
    numbers = {key: entry[key] for key in ("rms_nm", *_OPEN[:2])} | {key: psd[key] for key in _OPEN[3:]}
    return numbers | {"hurst": -slope_of(psd) / 2 - 1}


def _statistics(numbers):
    """Statistics of a surface by all of its numbers."""
    corner, cutoff = ends = [to_si(numbers[key], "rad_per_um") for key in _OPEN[3:]]
    if not corner < cutoff:
        raise Impossible("no spectrum has a corner that is not below its cut-off")
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


def refuse_beyond(numbers: Mapping[str, Any], section: str, ends: Mapping[str, Ends] = ENDS) -> None:
    """Refuse numbers of a section beyond their ends.

    Raises
    ------
    Impossible
        If a number is beyond them.
    """
    for key in [key for key in ends if key in numbers]:
        if refusal := ends[key].refusal(numbers[key]):
            raise Impossible(f"{section}.{key} {refusal}")


def _refuse_negative(numbers, names):
    """Refuse a bridge that may buckle, and a shock without a size."""
    for key in ("residual_stress_MPa", "shock_g"):
        if not 0 <= (value := numbers.get(key, 0)) < math.inf:
            raise Impossible(f"{names[key]} must be 0 or above, got {value}")


def questions(
    content: Mapping[str, Any], table: Mapping[str, Any]
) -> dict[str, Question | Stopper | Bridge | NotLearnt]:
    """Questions of the devices of a file as it is written, or why the estimate does not know them.

    The table has the typical surfaces, and the pairs of the paper.
    """
    by_device, devices = {}, content.get("devices", {})
    if "file" in devices:
        return {"Table": NotLearnt("devices of a table were not learnt")}
    for name, device in devices.items():
        try:
            by_device[name] = _question(name, device, content, table)
        except NotLearnt as reason:
            by_device[name] = reason
        except (KeyError, TypeError, AttributeError, ArithmeticError, ValueError) as wrong:
            by_device[name] = NotLearnt(f"its file is not complete, at {wrong}; stiction check says what is wrong")
    return by_device


def _question(name, device, content, table):
    """Question of one device."""
    others = [
        f"{section}.{key}"
        for section, keys in OF_SECTIONS.items()
        for key in content.get(section, {})
        if key not in keys
    ]
    others += [key for key in content if key not in (*OF_FILES, *OF_NAMES, *OF_SECTIONS)]
    if others := [key for key in others if key not in OF_DEFAULTS or content[key] != OF_DEFAULTS[key]]:
        raise NotLearnt(f"{others[0]} was not learnt")
    keys_known, make = _of_kind(device["kind"])
    left_out = tuple(key for key in LEFT_OUT if key in device)
    if others := [key for key in device if key not in keys_known + LEFT_OUT]:
        raise NotLearnt(f"{others[0]} was not learnt")
    pair, library = (table["pairs"] | content.get("pairs", {}))[device["pair"]], table["library"]
    if others := [key for key in pair if key not in OF_PAIRS]:
        raise NotLearnt(f"{others[0]} of a pair was not learnt")
    _refuse_life(device, content)
    surfaces = library | {key: library.get(key, {}) | entry for key, entry in content.get("surfaces", {}).items()}
    entries = [dict(surfaces[pair[side]]) for side in ("beam", "substrate")]
    names = [entry.pop("material", None) for entry in entries]
    solids, material = solids_of(names, content), materials_of(names, content).get(names[0], {})
    surroundings = Surroundings.of_device(device, content, material)
    for side, entry in zip(("beam", "substrate"), entries, strict=True):
        refuse_beyond(entry, f"surfaces.{pair[side]}")
    sides = [surface(entry, library) for entry in entries]
    more = {"left_out": left_out, "solids": solids, "surroundings": surroundings} | temperature_of(content)
    return make(name, device, sides, **more)


def _refuse_life(device, content):
    """Refuse impossible numbers of a device, of its life, and of liquids."""
    refuse_impossible(device | device.get("dielectric", {}))
    refuse_impossible(device.get("electrode", {}))
    for name, liquid in content.get("liquids", {}).items():
        refuse_impossible(liquid)
        refuse_beyond(liquid, f"liquids.{name}")


def temperature_of(content: Mapping[str, Any]) -> dict[str, float]:
    """Temperature of the water of a file by its name in a question, if the file states one.

    Raises
    ------
    Impossible
        If water is not liquid there.
    """
    water = content.get("water", {})
    refuse_beyond(water, "water")
    return {"temperature": float(water["temperature_K"])} if "temperature_K" in water else {}


def materials_of(names: Sequence[str | None], content: Mapping[str, Any]) -> Mapping[str, Any]:
    """Materials of a file, with those by name that it does not state itself."""
    materials = content.get("materials", {})
    if not any(name and (name not in materials or "like" in materials[name]) for name in names):
        return materials
    from stiction.config.materials import with_named  # imports NumPy

    used = {str(k): {"material": name} for k, name in enumerate(names)}
    return with_named({"surfaces": used, "materials": materials})["materials"]


def solids_of(names: Sequence[str | None], content: Mapping[str, Any]) -> SolidPair:
    """SolidPair of materials by name, or of section solid where a surface has none.

    Raises
    ------
    NotLearnt
        If something else of a material matters.
    """
    solid, materials = content.get("solid", {}), materials_of(names, content)
    refuse_beyond(solid, "solid")
    return SolidPair.of(*(solid | _material(name, materials) for name in names))


def _material(name, materials):
    """Possible properties of a material."""
    if name is None:
        return {}
    if name not in materials:
        raise Impossible(f"material {name} is not among {', '.join(materials) or 'materials'}")
    stated = {key: value for key, value in materials[name].items() if not (key == "coating_nm" and value == 0)}
    if others := [key for key in stated if key not in OF_MATERIALS]:
        raise NotLearnt(f"{others[0]} of {name} was not learnt")
    refuse_beyond(stated, f"materials.{name}")
    constants = stated.get("hamaker_constant_zJ", {})
    refuse_beyond(constants, f"materials.{name}.hamaker_constant_zJ", OF_ATTRACTION)
    return stated


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
    added = tension_of(device) * math.prod(area)
    return Stopper(name, surfaces, members, airs_of(device), area, force, added=added, **_often(device), **more)


def of_middle(name: str, device: Mapping[str, Any], sides: Sequence, **more: Any) -> Bridge:
    """Question about a bridge, as of `of_numbers`."""
    surfaces, members = zip(*sides, strict=True)
    sizes, length = _sizes(device)
    airs, stress = airs_of(device), to_si(device["residual_stress_MPa"], "MPa")
    more = more | {"added": energy_of(device, sizes[1]), "tension": tension_of(device)}
    return Bridge(name, surfaces, members, airs, *sizes, stress, length, **_often(device), **more)


def _often(device):
    """Touchdowns of a device, if it states them."""
    return {"touchdowns": device["touchdowns"]} if "touchdowns" in device else {}


def _sizes(device):
    """Thickness, gap and width of a beam, and its length if stated [m]."""
    sizes = [to_si(device[f"{size}_um"], "um") for size in ("thickness", "gap", "width")]
    return sizes, to_si(device["length_um"], "um") if "length_um" in device else None


def of_numbers(name: str, device: Mapping[str, Any], sides: Sequence, **more: Any) -> Question:
    """Question by the numbers of a device in the units of files, and both surfaces with their members."""
    surfaces, members = zip(*sides, strict=True)
    sizes, length = _sizes(device)
    airs, more = airs_of(device), more | {"added": energy_of(device, sizes[1])}
    return Question(name, surfaces, members, airs, *sizes, length, **_often(device), **more)
