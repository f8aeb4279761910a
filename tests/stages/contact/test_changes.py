"""Contacts with one thing changed: each change does what its name states, and nothing else."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings
from published import SURFACES

from stiction.analysis.shifts import STEPS
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.reading import paper
from stiction.config.units import in_si
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.stages.contact import contact as stage_contact
from stiction.stages.contact.changes import moments, quantities, table, variants
from stiction.stages.contact.changes.patches import GROUND, STRIPS, TILTED, TIPS
from stiction.stages.contact.changes.table import TABLE
from stiction.stages.surfaces import heights, measured_heights, parameters
from stiction.surface.empirical import MeasuredDensity

BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 20, "humidities": [0.67]}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 2], "restoring_force_uN": 20, "humidities": [0.67]}
DEVICES = {"C1": BEAM, "S1": STOPPER | {"tilt_deg": [0, 0.1]}}
FEW = {"design": {"beams": 700, "budget_samples": 30}, "studies": {"slopes": {"samples": 30}}}
PLAN = Plan(load({"devices": DEVICES} | FEW))
#: Wildcards of any contact of the table; the patches are those of the device.
SIDES = {GROUND: PLAN.devices.ground("C1")._asdict(), TIPS: PLAN.devices.tips("C1")._asdict(), STRIPS: {"pair": "b"}}
SIDES |= {TILTED: PLAN.devices.ground("S1")._asdict()}
OTHERS = {"surface": "B2", "quantity": "rms", "each": "rms_less", "choice": "beyond", "side": "less"}
OTHERS |= {"solid_property": "modulus", "variant": "poisson_ratio_0.28", "member": "Sub1"}
CELLS = [(change, place) for change, row in TABLE.items() for place in row]


def named(change, place):
    """Name of a contact of a cell of the table."""
    ends = OTHERS | {"each": "less"} if change is table.QUANTITY else OTHERS
    return table.file_of(change, place, **{name: str(value) for name, value in (SIDES[place] | ends).items()})


def stage(rule):
    """Stage of a rule."""
    (found,) = (stage for stage in table.STAGES if stage.name == rule)
    return found


def by_stage(surfaces):
    """Data of both surfaces as a job gets them."""
    of_heights, spectra = zip(*surfaces, strict=True)
    return {"heights": of_heights, "spectrum": spectra}


# Table


def test_every_contact_of_the_table_is_found_by_its_name():
    assert len(CELLS) > 12
    for change, place in CELLS:
        rule, _ = TABLE[change][place]
        assert Graph(PLAN).job(named(change, place)).stage.name == rule


#: Samples and further settings of the changes that draw their surfaces; variants have settings of their own.
OWN = {
    table.AS_IT_IS: (PLAN.config["contact"]["samples"], set()),
    table.QUANTITY: (30, set()),
    table.MOMENTS: (PLAN.config["studies"]["sensitivity"]["samples"], {"moments", "step"}),
    table.SCAN_OPTION: (30, {"sources"}),
    table.SOLID: (30, {"solid"}),
    table.VARIANT_OF_SOLIDS: (30, {"solid"}),
}


def test_every_change_keeps_all_settings_of_the_patch_but_its_own_and_each_beam_has_a_tip():
    for change, place in (cell for cell in CELLS if cell[0] in OWN):
        samples, own = OWN[change]
        samples = 700 if (change, place) == (table.AS_IT_IS, TIPS) else samples
        found, plain = job_settings(PLAN, named(change, place)), place.settings(PLAN, At(**SIDES[place]), samples)
        assert {key for key in {*found, *plain} if found.get(key) != plain.get(key)} == own
        assert found["contact"]["samples"] == samples


def test_a_patch_of_the_size_of_the_strips_has_their_settings_and_tips_have_a_tilt_and_larger_steps():
    length, width = PLAN.config["sampling"]["strip_length_um"], PLAN.config["beam"]["width_um"]
    at = At(pair="b", length=str(round(1000 * length)), width=str(round(1000 * width)))
    strips = STRIPS.settings(PLAN, at, 30)
    assert GROUND.settings(PLAN, at, 30) == strips
    tips = TIPS.settings(PLAN, At(**SIDES[TIPS]), 30)
    assert {key for key in tips if tips[key] != strips.get(key)} == {"sampling", "beam", "contact", "tilt"}
    assert tips["contact"]["distance_step_nm"] > strips["contact"]["distance_step_nm"]


# Moments (Fig. 13)


@pytest.fixture(scope="module")
def shifted():
    """Datasets of less and more skewness, and their settings."""
    plain = job_settings(small.PLAN, "studies/sensitivity/contact/b_rms_less") | {"moments": ["skewness"]}
    settings = small.settings_of(moments, plain)
    return stage("sensitivity_contact").result(by_stage(small.surfaces()), At(pair="b"), settings), settings


def test_less_and_more_of_a_moment_bracket_that_of_the_surface(shifted):
    less, more = map(moments.moment, shifted[0])
    assert (less, more) == pytest.approx((-0.76 * 1.1, -0.76 * 0.9))


@pytest.fixture
def asked(monkeypatch):
    """Arguments of the calls that would draw surfaces."""
    found, contact = [], small.contact_of_pair()
    monkeypatch.setattr(
        stage_contact, "compute_each", lambda *given: found.append(given) or [contact for _ in given[0]]
    )
    return found


@pytest.mark.parametrize(
    ("moment", "place", "factor"),
    [
        ("rms", 0, 0.9),
        *(pytest.param(*row, marks=pytest.mark.slow) for row in (("rms", 1, 1.1), ("kurtosis", 3, 1.1))),
    ],
)
def test_a_shifted_moment_changes_that_of_the_beams_surface_alone(asked, shifted, moment, place, factor):
    settings = replace(shifted[1], moments=("rms", "kurtosis"))
    found = moments.compute(small.surfaces(), "b", settings)[place]
    ((alternatives, pair, model, _),) = asked
    (changed, shape), substrate = alternatives[place]
    ends = table.MOMENTS.each(SimpleNamespace(shifted_moments=settings.moments))
    assert ends[place] == f"{moment}_{'less' if factor < 1 else 'more'}"
    before = heights.moments(small.heights_of("B2"))
    assert heights.moments(changed) == replace(before, **{moment: getattr(before, moment) * factor})
    assert moments.moment(found) == pytest.approx(getattr(before, moment) * factor, rel=1e-14)
    assert parameters.spectrum_of(shape) == SURFACES["B2"].published_psd
    assert_array_equal(shape.wavenumber, small.spectrum_of("B2").wavenumber)
    assert substrate is small.surfaces()[1]
    assert (pair, model) == ("b", "NG")


def test_a_step_of_nothing_is_the_contact_of_the_pair(shifted):
    found, _ = moments.compute(small.surfaces(), "b", replace(shifted[1], step=0.0))
    assert_allclose(found.solid_pressure, small.contact_of_pair().solid_pressure[:4], rtol=1e-5, atol=1)
    assert_allclose(found.bearing_area, small.contact_of_pair().bearing_area[:4], rtol=1e-6)


# Quantities, for slopes with common random numbers


def slope_settings(**changes):
    return replace(
        small.settings_of(quantities, job_settings(small.PLAN, "studies/slopes/contact/b_B2_rms_less")), **changes
    )


@pytest.mark.parametrize(("surface", "changed"), [("B2", (True, False)), ("Sub1", (False, True))])
@pytest.mark.parametrize("side", [0, 1])
def test_a_shifted_quantity_changes_the_named_surface_alone(asked, surface, changed, side):
    found = quantities.compute(small.surfaces(), "b", surface, "corner", slope_settings())[side]
    ((alternatives, pair, model, _),) = asked
    for ours, theirs, is_changed in zip(alternatives[side], small.surfaces(), changed, strict=True):
        assert (ours is not theirs) == is_changed
        corner, before = (parameters.spectrum_of(spectrum).corner for _, spectrum in (ours, theirs))
        assert corner / before == pytest.approx(np.exp((-0.05, 0.05)[side]) if is_changed else 1)
        assert heights.moments(ours[0]) == heights.moments(theirs[0])
    assert (pair, model) == ("b", "NG")
    assert quantities.difference(found) == pytest.approx(0.1)


def test_a_surface_on_both_sides_is_shifted_on_both(asked):
    twice = [small.surfaces()[0]] * 2
    quantities.compute(twice, "b", "B2", "rms", slope_settings(surfaces=("B2", "B2")))
    more = asked[0][0][1]
    assert [heights.moments(changed[0]).rms for changed in more] == pytest.approx([3.4e-9 * np.exp(0.05)] * 2)


def test_modes_are_shifted_around_the_measured_heights_of_an_estimate(asked, monkeypatch):
    kept, moments = [], heights.moments(small.surfaces()[0][0])
    form = heights.layout(MeasuredDensity(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9)), moments)
    monkeypatch.setattr(measured_heights, "compute", lambda *given: kept.append(given) or form)
    quantities.compute(small.surfaces(), "b", "B2", "mode3", slope_settings(), "estimate of B2")
    assert kept == [("estimate of B2", "B2", "measured")]
    less, more = (heights.density(changed[0][0], "NG").quantile_of_normal(2.0) for changed in asked[0][0])
    assert more > less


# Variants of the model


def contact_under(variant, samples=3):
    """Contact of pair b under a variant."""
    plain = small.PLAN.variants.summits("b", variant)
    base, changed = (small.settings_of(variants, merged(plain["base"], c)) for c in ({}, plain["changes"]))
    fewer = replace(changed, contact=replace(changed.contact, samples=samples))
    solids = in_si(variants.SolidsOfPair, small.PLAN.variants.solids("b", variant))
    return variants.contact_of(variants.summits_under({}, "b", base, fewer), solids)


@pytest.mark.parametrize("variant", ["asperity_island", "base"])
def test_the_contact_of_islands_under_a_variant_is_that_of_pairs_of_its_settings(variant):
    """If the asperities of the base are islands, those of all its variants are found in this way."""
    plain = small.PLAN.variants.summits("b", variant)
    solids = {"solids": small.PLAN.variants.solids("b", variant)}
    plain = merged(plain, {"base": {"contact": {"samples": 3}}}) | solids
    at, data = SimpleNamespace(pair="b", variant=variant), {"identifications": {}, "heights": {}, "spectrum": {}}
    found = stage("variant_islands").result(data, at, plain)
    changed = merged(job_settings(small.PLAN, "contact/b_NG"), small.PLAN.variants.changes[variant])
    settings = small.settings_of(stage_contact, merged(changed, {"contact": {"samples": 3}}))
    plain_way = stage_contact.compute(small.surfaces(), "b", "NG", settings)
    for name in found:
        assert_array_equal(found[name], plain_way[name])
    assert np.array_equal(found.solid_pressure, contact_under("base").solid_pressure) == (variant == "base")


def test_the_contact_of_the_base_variant_is_that_of_the_pair():
    found, pair = contact_under("base"), small.contact_of_pair().isel(strip=slice(3))
    assert set(found) == set(pair)
    for name in [*found, *found.coords]:
        assert_array_equal(found[name], pair[name])
        assert found[name].dtype == pair[name].dtype


@pytest.mark.parametrize(
    "variant",
    ["van_der_waals_none", *(pytest.param(name, marks=pytest.mark.slow) for name in ("poisson_ratio_0.28", "every_2"))],
)
def test_the_contact_of_a_variant_is_that_of_pairs_of_its_settings(variant):
    plain = merged(job_settings(small.PLAN, "contact/b_NG"), small.PLAN.variants.changes[variant])
    settings = small.settings_of(stage_contact, merged(plain, {"contact": {"samples": 3}}))
    plain_way = stage_contact.compute(small.surfaces(), "b", "NG", settings)
    found = contact_under(variant)
    for name in found:
        assert_array_equal(found[name], plain_way[name])
    assert not np.array_equal(found.solid_pressure, contact_under("base").solid_pressure)


def test_a_measured_surface_is_the_same_under_every_variant():
    plain = small.PLAN.variants.summits("b", "base")
    base = small.settings_of(variants, plain["base"])
    described = {name: entry for name, entry in base.surfaces.items() if name != "B2"}
    changed = replace(base, contact=replace(base.contact, samples=3))
    measured = {"B2": small.surfaces()[0]}
    found = variants.summits_under({}, "b", replace(base, surfaces=described), changed, measured)
    assert_array_equal(found.top, variants.summits_under({}, "b", base, changed).top)


# Large uncertainties


@pytest.mark.parametrize(("deviation", "step"), [(0.0, 0.05), (0.02, 0.05), (0.8, 0.8), (3.0, np.log(125 / 12) / 2)])
def test_a_quantity_is_shifted_as_far_as_it_is_uncertain(asked, deviation, step):
    found = quantities.compute(small.surfaces(), "b", "B2", "corner", slope_settings(deviation=deviation))
    corners = [parameters.spectrum_of(beam[1]).corner for beam, _ in asked[0][0]]
    np.testing.assert_allclose(np.log(np.divide(corners, 12e6)), [-step, step], rtol=1e-9)
    assert [quantities.is_large(contact, "corner") for contact in found] == [step > 0.05] * 2
    assert quantities.difference(found[0]) == pytest.approx(2 * step)


def test_assumed_surfaces_alone_are_shifted_by_their_uncertainty():
    etched = {"Etched": {"like": "B2", "rms_nm": 3, "uncertainty": {"rms_nm": 0.3}}}
    pairs = {"mine": {"beam": "Etched", "substrate": "Sub1", "gap_um": 20, "humidities": [0.67]}}
    plan = Plan(load({"run": {"pairs": ["mine"], "studies": []}, "surfaces": etched, "pairs": pairs}))
    spread = np.log([entry["published_psd"]["corner_rad_per_um"] for entry in paper()["surfaces"].values()]).std(ddof=1)
    stated = {"rms": 0.1, "corner": spread}
    for quantity, deviation in stated.items():
        assert plan.deviation("Etched", quantity) == pytest.approx(deviation, rel=1e-8)
        settings = job_settings(plan, f"studies/slopes/contact/mine_Etched_{quantity}_less")
        assert settings["deviation"] == pytest.approx(deviation, rel=1e-8)
    for surface in ("B1", "B2", "Sub1", "Sub2"):
        assert not any(small.PLAN.deviation(surface, quantity) for quantity in STEPS)
    assert "deviation" not in job_settings(small.PLAN, "studies/slopes/contact/b_B2_rms_less")
