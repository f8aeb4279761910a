"""Relations between the sizes of a device: what is refused has no room, and what has room is not refused.

Devices are drawn, and their parts laid out as points and rectangles: no formula is that of the relations.
"""

import functools
import itertools

import numpy as np
import pytest
from configurations import PAPER, ROOT, problems

from stiction.config import relations_devices
from stiction.config.files import joined
from stiction.config.keys import Keys, Relations
from stiction.config.merging import merged
from stiction.config.surfaces import process

ALONE = {"run": {"pairs": []}}
_NAMES = ["tilted_stoppers_fit_into_their_gap", "dimples_have_room", "dimples_are_whole_on_their_beam"]
_NAMES += ["strips_are_parts_of_their_beam", "dielectrics_fit_into_the_gap", "uncertain_stresses_are_tensile"]
SIZES = Relations(one for one in relations_devices.relation if getattr(one, "__name__", "") in _NAMES)
SIZES += relations_devices.relation_of_tips
#: Rounded to what a user writes, so that sizes are equal now and then.
WRITTEN = 3


def among(rng, low, high):
    """Number between two ends, by equal factors."""
    return float(f"{low * (high / low) ** rng.uniform():.{WRITTEN}g}")


def drawn(number):
    """Device and radius of the edges [µm], of a kind by its number."""
    rng = np.random.default_rng([67, number])
    common = {"pair": "b", "humidities": [0.67], "gap_um": among(rng, 0.3, 30), "voltage_V": 5}
    common["dielectric"] = {"thickness_nm": among(rng, 30, 30_000), "permittivity": 4}
    if number % 3 == 0:
        sides = [among(rng, 0.5, 50), among(rng, 0.5, 50)]
        own = {"kind": "stopper", "contact_um": sides, "stiffness_N_per_m": 2, "tilt_deg": [0, among(rng, 0.1, 10)]}
        return common | own, 0.1
    beam = {"thickness_um": among(rng, 0.2, 10), "width_um": float(rng.integers(2, 60)), "length_um": 300.0}
    beam["strip_um"] = float(rng.choice([1, 150, 301, 400]))
    if number % 3 == 1:
        stress, deviation = among(rng, 1, 1000), among(rng, 1, 1000)
        own = {"kind": "bridge", "residual_stress_MPa": stress, "uncertainty": {"residual_stress_MPa": deviation}}
        return common | beam | own, 0.1
    rows = sorted({among(rng, 1, 299) for _ in range(rng.integers(1, 4))})
    dimples = {"number": int(rng.integers(1, 6)), "at_um": rows, "height_um": common["gap_um"] / 2}
    dimples["contact_um"] = [among(rng, 0.5, 40), among(rng, 0.5, 40)]
    return common | beam | {"kind": "cantilever", "dimples": dimples}, among(rng, 0.05, 10)


def overlap(boxes):
    """Whether any two boxes (x0, x1, y0, y1) share area."""
    return any(
        min(a[1], b[1]) - max(a[0], b[0]) > 1e-9 and min(a[3], b[3]) - max(a[2], b[2]) > 1e-9
        for a, b in itertools.combinations(boxes, 2)
    )


def laid_out(device, along, across):
    """Whether dimples of these sides lie on the beam apart from each other, those of a row beside each other."""
    number, width = device["dimples"]["number"], device["width_um"]
    boxes = [
        (x - along / 2, x + along / 2, k * across, (k + 1) * across)
        for x in device["dimples"]["at_um"]
        for k in range(number)
    ]
    on_beam = all(x0 >= -1e-9 and x1 <= device["length_um"] + 1e-9 and y1 <= width + 1e-9 for x0, x1, _, y1 in boxes)
    return on_beam and not overlap(boxes)


def highest_corner(sides, degrees):
    """Height of the highest point of a plate with a point on the substrate, turned as a matrix does [µm]."""
    turn = np.array([[np.cos(np.radians(degrees)), -np.sin(np.radians(degrees))],
                     [np.sin(np.radians(degrees)), np.cos(np.radians(degrees))]])  # fmt: skip
    heights = (turn @ np.array([[-sides[0] / 2, sides[0] / 2], [0, 0]]))[1]
    return np.ptp(heights)


def impossible(device, radius):
    """Pairs of keys that contradict each other, by laying out the parts of a device."""
    gap, kind = device["gap_um"], device["kind"]
    if device["dielectric"]["thickness_nm"] / 1000 >= gap:
        yield "dielectric.thickness_nm", "gap_um"
    if kind == "stopper" and highest_corner(device["contact_um"], device["tilt_deg"][1]) > gap:
        yield "tilt_deg", "gap_um"
    if kind != "stopper" and device["strip_um"] not in np.linspace(0, device["length_um"], 3001):
        yield "strip_um", "length_um"
    if kind == "bridge" and device["residual_stress_MPa"] - device["uncertainty"]["residual_stress_MPa"] < 0:
        yield "uncertainty.residual_stress_MPa", "residual_stress_MPa"
    if kind == "cantilever":
        yield from impossible_ends_and_dimples(device, radius)


def impossible_ends_and_dimples(device, radius):
    """The same for a cantilever."""
    arc = radius * (1 - np.cos(np.linspace(0, np.pi / 2, 50)))  # from the underside up to the end
    if arc[-1] > device["thickness_um"] * (1 + 1e-12):
        yield "design.edge_radius_um", "thickness_um"
    if not any(laid_out(device, *order) for order in itertools.permutations(device["dimples"]["contact_um"])):
        yield "dimples", "contact_um"


def configured(number):
    device, radius = drawn(number)
    return merged(PAPER, ALONE | {"devices": {"D": device}, "design": {"edge_radius_um": radius}})


def refused(number, relations=SIZES):
    """Sentences of relations between sizes about a drawn device."""
    return list(
        map(str, relations.problems(Keys({"materials": {}, "test_beams": {}, "process": {}} | configured(number))))
    )


@functools.cache
def of_all(count=400):
    """Contradictions of drawn devices."""
    return [list(impossible(*drawn(number))) for number in range(count)]


def test_what_has_no_room_is_refused_with_both_keys_and_nothing_else_is():
    for number, pairs in enumerate(of_all()):
        lines = refused(number)
        assert bool(lines) == bool(pairs), (number, drawn(number), lines, pairs)
        for first, second in pairs:
            assert any(first in line and second in line for line in lines), (number, lines)


@pytest.mark.parametrize("number", range(12))
def test_a_whole_configuration_is_refused_in_the_same_words(number):
    assert set(refused(number)) <= set(problems(configured(number)))


@pytest.mark.parametrize("relation", SIZES)
def test_without_any_relation_a_device_without_room_would_be_computed(relation):
    """The control: the drawn devices need every relation."""
    others = Relations([one for one in SIZES if one is not relation])
    assert any(pairs and not refused(number, others) for number, pairs in enumerate(of_all()))


def test_a_film_is_not_stretched_to_twice_its_length():
    soft = {"materials": {"Gel": {"young_modulus_GPa": 0.1}}, "surfaces": {"B2": {"material": "Gel"}}}
    bridge = drawn(1)[0] | {"dielectric": {"thickness_nm": 100, "permittivity": 4}, "strip_um": 1, "gap_um": 2}
    for stress, text in ((99.9, None), (100, "below Young's modulus of the beam, 100 MPa")):
        device = bridge | {"residual_stress_MPa": stress, "uncertainty": {}}
        lines = problems(merged(PAPER, ALONE | soft | {"devices": {"D": device}}))
        assert [text in line for line in lines] == [True] * bool(text)


def test_hardness_is_at_most_the_modulus_of_the_material_or_of_all_solids():
    for own, known in (({}, 164), ({"young_modulus_GPa": 70}, 70)):
        for hardness, refusals in ((known, 0), (known * 1.001, 1)):
            gold = {"materials": {"Gold": own | {"hardness_GPa": hardness}}}
            lines = problems(merged(PAPER, gold))
            assert len(lines) == refusals
            assert all("young_modulus_GPa" in line and "hardness_GPa" in line for line in lines)


def beam(**keys):
    """A cantilever on pair b alone, under changes."""
    sizes = {"thickness_um": 2.6, "gap_um": 2, "width_um": 30, "length_um": 300, "humidities": [0.67]}
    return {"kind": "cantilever", "pair": "b"} | sizes | keys


def test_the_roughest_surface_of_a_range_needs_the_gap_that_it_needs_alone():
    """The second route: the same rms as a surface of its own."""
    needed = {"requirement": {"share": 0.001}}
    for rms in (10, 90, 99, 110, 900):
        alone = merged(PAPER, ALONE | {"devices": {"D": beam()}, "surfaces": {"B2": {"rms_nm": rms}}})
        ends = needed | {"roughness": {"surface": "B2", "rms_nm": [1, rms]}}
        ends["requirement"] = {"share": 0.001, "length_um": 300}
        lines = problems(merged(PAPER, ALONE | {"devices": {"D": beam(**ends)}}))
        assert bool(lines) == any("devices.D.gap_um" in line for line in problems(alone))
        assert all("roughness.rms_nm" in line and "gap_um" in line for line in lines)


def test_the_roughest_setting_of_a_process_needs_its_gap_too():
    required = {"process": "etch", "requirement": {"share": 0.001, "length_um": 300}}
    for rms, refusals in ((50, 0), (500, 1)):
        settings = [
            {"value": value, "rms_nm": own, "uncertainty": {"rms_nm": 0.1}} for value, own in ((1, 3), (2, rms))
        ]
        etch = {"process": {"etch": {"variable": "time_s", "surface": "B2", "settings": settings}}}
        config = process.with_surfaces(merged(PAPER, ALONE | etch | {"devices": {"D": beam(**required)}}))
        lines = problems(config)
        assert len(lines) == refusals, lines
        assert all("devices.D.process" in line and "gap_um" in line for line in lines)


def test_a_required_length_is_that_of_a_slender_beam():
    for length, refusals in ((2.6, 1), (2.7, 0)):
        required = {
            "requirement": {"share": 0.001, "length_um": length},
            "roughness": {"surface": "B2", "rms_nm": [1, 8]},
        }
        lines = problems(
            merged(PAPER, ALONE | {"devices": {"D": {k: v for k, v in beam(**required).items() if k != "length_um"}}})
        )
        assert len(lines) == refusals
        assert all("requirement.length_um" in line and "thickness_um" in line for line in lines)


# Surfaces and processes


def test_uncertain_moments_are_those_of_possible_heights():
    """The second route: heights drawn from mixtures, whose true moments scatter by as much as they can.

    Every sample of heights has a kurtosis of at least skewness² + 1, so that no spread of samples is refused.
    """
    rng = np.random.default_rng(3)
    for _ in range(40):
        moments = []
        for _ in range(20):
            heights = rng.standard_normal(12) ** rng.integers(1, 4)
            z = (heights - heights.mean()) / heights.std()
            moments.append((np.mean(z**3), np.mean(z**4)))
        (skewness, kurtosis), (spread, own) = np.mean(moments, axis=0), np.std(moments, axis=0)
        entry = {"skewness": skewness, "kurtosis": kurtosis, "uncertainty": {"skewness": spread, "kurtosis": own}}
        assert "uncertainty.skewness" not in refused_uncertainties(entry)
        entry["uncertainty"]["skewness"] = 1.001 * np.sqrt(kurtosis - 1 - skewness**2)
        assert "uncertainty.skewness" in refused_uncertainties(entry)


def refused_uncertainties(entry):
    """Keys of impossible uncertainties of a surface with these moments."""
    from stiction.config.surfaces.described import _impossible_uncertainties

    return dict(_impossible_uncertainties(entry, entry))


@pytest.mark.parametrize("key", ["rms_nm", "correlation_length_nm", "corner_rad_per_um"])
@pytest.mark.parametrize("part", [0.99, 1.0, 30])
def test_positive_quantities_of_surfaces_err_by_less_than_themselves(key, part):
    described = {"rms_nm": 5, "hurst": 0.8, "correlation_length_nm": 60, "cutoff_rad_per_um": 125}
    if key == "corner_rad_per_um":
        described = {"rms_nm": 5, "hurst": 0.8, "corner_rad_per_um": 12, "cutoff_rad_per_um": 125}
    mine = described | {"uncertainty": {key: part * described[key]}}
    pairs = {"pairs": {"mine": {"beam": "Mine", "substrate": "Sub1", "gap_um": 20, "humidities": [0.5]}}}
    lines = problems(merged(PAPER, pairs | ALONE | {"surfaces": {"Mine": mine}, "devices": {"D": beam()}}))
    assert [f"uncertainty.{key} is" in line and f"below {key} itself" in line for line in lines] == [True] * (part >= 1)


@pytest.mark.parametrize(
    ("unit", "possible", "refused"),
    [
        ("K", [0, 300], [-5]),
        ("Pa", [0, 5], [-1]),
        ("C", [-273.15, 400], [-274]),
        ("s", [0, 9], [-0.1]),
        ("percent", [0, 100], [-1, 150]),
        ("ratio", [-1, 1.5], []),
        ("V", [-3, 3], []),
        ("um", [-3, 3], []),
    ],
)
def test_settings_are_those_that_their_unit_can_have(unit, possible, refused):
    settings = [{"value": value, "rms_nm": 3, "uncertainty": {"rms_nm": 0.1}} for value in possible + refused]
    etch = {"process": {"etch": {"variable": f"etch_{unit}", "surface": "B2", "settings": settings}}}
    lines = problems(process.with_surfaces(merged(PAPER, etch)))
    assert len(lines) == len(refused)
    for line, value in zip(lines, refused, strict=True):
        assert line.startswith("process.etch.settings[")
        assert f"is {value}, must be at least" in line
        assert f"process.etch.variable = 'etch_{unit}'" in line


@pytest.mark.parametrize("file", ["devices", "life"])
def test_examples_have_room(file):
    assert problems(joined(ROOT / f"examples/{file}.yaml")) == ()
