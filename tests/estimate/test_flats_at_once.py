"""What flat surfaces hold, beside an estimate: the bounds of a run, at random devices and for files."""

import csv
import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from plans import job_settings

from stiction.command.at_once import estimate as command
from stiction.config.files import load
from stiction.config.reading import paper, read
from stiction.config.units import in_si
from stiction.contact.environment import Gaps, Water, flooded_law
from stiction.devices import bridges
from stiction.estimate.answer import answer
from stiction.estimate.closed import flats
from stiction.estimate.closed.beams import SlenderBeam
from stiction.estimate.closed.flats import EDGE, WAVELENGTH, FlatBound
from stiction.estimate.question import questions
from stiction.estimate.solids import SolidPair
from stiction.estimate.state import film
from stiction.estimate.table import content, known
from stiction.plan.plan import Plan
from stiction.stages.devices.opening import DesignedBeam
from stiction.stages.devices.safe_lengths import Settings
from stiction.stages.devices.sticking import flooded_lengths

ROOT = Path(__file__).parents[2]
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
R1 = C1 | {"kind": "bridge", "thickness_um": 2, "gap_um": 2, "residual_stress_MPa": 50}
S1 = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.67]}
#: Random devices of each kind.
NUMBER = 60


@pytest.fixture(autouse=True)
def exact(monkeypatch):
    """Run whose root of a bridge is not cut off at 2e-12 m."""
    monkeypatch.setattr(bridges, "brentq", partial(bridges.brentq, xtol=1e-18))


def drawn(rng):
    """Random solids, humidity, which can be that of dry air, and water of a run between them."""
    angles = tuple(rng.uniform(0, 1.2, 2))
    wet, dry = rng.uniform(5e-21, 3e-19), rng.uniform(1e-19, 4e-19)
    air, temperature = float(rng.choice([0.0, rng.uniform(0.7, 0.95)])), rng.uniform(275, 370)
    solids = SolidPair(through_water=wet, in_dry_air=dry, wetting=sum(map(math.cos, angles)))
    between = Water(temperature, angles, Gaps({"water": wet, "dry": dry}, "water", WAVELENGTH))
    return solids, air, between


def attracted(solids, air, water):
    """Attractions of flats in the closed form."""
    return flats.attractions(film(air, water.temperature, solids.wetting) if air else None, solids)


def drawn_beam(rng, kind):
    """Random beam of a kind, and that of a run."""
    sizes = rng.uniform(0.8e-6, 6e-6), rng.uniform(0.5e-6, 5e-6), rng.uniform(5e-6, 40e-6)
    modulus, stress = rng.uniform(60e9, 400e9), float(rng.choice([0.0, rng.uniform(1e6, 2e8)]))
    stress *= kind == "bridge"
    return SlenderBeam(1 + (kind == "bridge"), *sizes, modulus, stress), DesignedBeam(
        kind, "b", *sizes, modulus, 1e-6, stress
    )


def lengths_of(bound):
    """Lengths of a bound as those of a run."""
    return [length for length in (bound.size, bound.at_tip) if length is not None]


@pytest.mark.parametrize("kind", ["cantilever", "bridge"])
def test_random_beams_have_the_bounds_of_a_run(kind):
    rng, of_flats = np.random.default_rng(2), flats.of_bridge if kind == "bridge" else flats.of_cantilever
    others = []
    for _ in range(NUMBER):
        beam, device = drawn_beam(rng, kind)
        solids, air, water = drawn(rng)
        found = lengths_of(of_flats(beam, attracted(solids, air, water)))
        np.testing.assert_allclose(found, flooded_lengths(device, water, air, EDGE), rtol=1e-9)
        unretarded = replace(water, gaps=replace(water.gaps, wavelength=np.inf))
        others.append(np.abs(np.log(found) - np.log(flooded_lengths(device, unretarded, air, EDGE))).max())
        others[-1] += air == 0  # whose flats in contact know no retardation
        sharper = flooded_lengths(device, water, air, EDGE / 2)
        assert (abs(math.log(found[-1] / sharper[-1])) > 0.01) == (kind == "cantilever"), "control"
    assert min(others) > 1e-8, "control"


def test_random_stoppers_have_the_largest_pressure_of_a_run():
    rng = np.random.default_rng(3)
    for _ in range(NUMBER):
        solids, air, water = drawn(rng)
        area = rng.uniform(1e-12, 36e-12)
        _, pull = flooded_law(air, water.at(air), 0.0)
        bound = flats.of_stopper(area, attracted(solids, air, water))
        assert bound == FlatBound(pytest.approx(area * pull, rel=1e-9))
        assert bound.size > 1.001 * area * flooded_law(air, Water(water.temperature, water.contact_angles), 0.0)[1]


def test_a_bridge_that_nothing_holds_has_no_length():
    beam = SlenderBeam(2, 2e-6, 2e-6, 30e-6, 164e9)
    assert flats.of_bridge(beam, [flats.FlatPull(1e6, 1e15)]).size == 0.0
    assert flats.of_bridge(beam, [flats.FlatPull(0.1, 1e9)]).size > beam.thickness, "control"


def test_edge_and_retardation_are_those_that_devices_have_by_default():
    assert pytest.approx(1e6 * EDGE) == paper()["design"]["edge_radius_um"]
    assert paper()["attraction"] == {"retarded": True, "wavelength_nm": pytest.approx(1e9 * WAVELENGTH)}


#: Sections of other solids.
OTHERS = {
    "materials": {
        "Oxide": {"young_modulus_GPa": 73, "hamaker_constant_zJ": {"water": 5, "dry": 66}, "contact_angle_deg": 30},
        "Metal": {"young_modulus_GPa": 80, "hamaker_constant_zJ": {"water": 300, "dry": 400}},
    },
    "surfaces": {"B2": {"material": "Oxide"}, "Sub1": {"material": "Metal"}},
    "water": {"temperature_K": 320},
}


def file_of(device, sections):
    """File with one device."""
    return {"run": {"pairs": [], "studies": []}, "devices": {"D": device}} | sections


def asked(device, sections):
    """Question about one device."""
    return questions(file_of(device, sections), content())["D"]


@pytest.mark.parametrize("sections", [{}, OTHERS])
@pytest.mark.parametrize("air", [0.67, "dry"])
@pytest.mark.parametrize("device", [C1, R1])
def test_a_file_has_the_bounds_of_its_run(device, air, sections):
    device = device | {"humidities": [air]}
    plan = Plan(load(file_of(device, sections)))
    case = "D_dry" if air == "dry" else "D_rh067"
    ((_, settings),) = [("beam", job_settings(plan, f"devices/safe_lengths/{case}"))]
    own = in_si(Settings, settings)
    of_run = flooded_lengths(own.device, own.water, own.humidity, own.edge_radius)
    question = asked(device, sections)
    (humidity,) = question.humidities
    np.testing.assert_allclose(lengths_of(question.on_flats(question.attractions(humidity))), of_run, rtol=1e-9)


@pytest.mark.parametrize("name", ["", "drawn_"])
def test_the_bounds_of_the_example_are_those_of_its_table(name):
    asked_about = questions(read(ROOT / "examples" / f"{name}devices.yaml"), content())
    with (ROOT / "docs" / "tables" / f"{name}safe_lengths.csv").open(encoding="utf-8") as file:
        rows = {
            (row["device"], float(row["relative_humidity"] or 0), row["held_by"]): row for row in csv.DictReader(file)
        }
    for (device, air, held_by), row in rows.items():
        question = asked_about[device]
        bound = question.on_flats(question.attractions(air))
        length = bound.at_tip if held_by == "beam or tip" else bound.size
        assert float(row["bound_um"]) == pytest.approx(1e6 * length, rel=3e-8), "as far as that run finds a root"
    assert len({device for device, *_ in rows}) > 1


@pytest.mark.parametrize(("device", "worst"), [(C1, min), (R1, min), (S1, max)])
def test_the_bound_of_some_airs_is_the_worst_of_each(device, worst):
    airs = [0.5, 0.67, 0.9]
    together = answer(asked(device | {"humidities": airs}, {}), *known()).flat
    alone = [answer(asked(device | {"humidities": [air]}, {}), *known()).flat for air in airs]
    assert together.size == worst(bound.size for bound in alone)
    if device is C1:
        assert together.at_tip == min(bound.at_tip for bound in alone)
    else:
        assert together.at_tip is None
    assert len({bound.size for bound in alone}) == len(airs), "control"


def said(device, **keys):
    """Sentences of the command on flat surfaces."""
    lines = command.shown(answer(asked(device | keys, {}), *known()))
    (line,) = [line.strip() for line in lines if "lat" in line and " surfaces " in line]
    return line


def test_the_command_says_what_flats_hold_and_that_a_rough_tip_can_stick_harder():
    assert said(C1) == (
        "Flat, flooded surfaces stick from 103 µm on at the tip and from 294 µm on along the underside. "
        "Rough ones can stick harder, but at the tip alone."
    )
    assert said(C1, humidities=["dry"]).startswith("Flat surfaces stick from ")
    assert said(C1, humidities=["dry", 0.67]).startswith("Flat, flooded surfaces stick from ")
    assert said(R1) == "Flat, flooded surfaces stick from 48.8 µm on. No surface sticks at a shorter length."
    assert said(S1) == "Flat, flooded surfaces hold 14 300 µN. No surface of this area holds more."
    driven = said(C1, voltage_V=3, dielectric={"thickness_nm": 100, "permittivity": 3.9})
    assert driven == said(C1).replace("Flat, flooded", "Without its voltage, flat, flooded")
