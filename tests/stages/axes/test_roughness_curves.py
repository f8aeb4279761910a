"""Devices over the roughness of a surface: today's results at the given one, required values put back, limits."""

from dataclasses import replace
from types import SimpleNamespace
from unittest.mock import patch

import numpy as np
import pytest
import xarray as xr
from legends import covering
from noted import noted

import stiction
from stiction.contact.correction import Correction, ElasticChange
from stiction.contact.environment import Water
from stiction.devices import stoppers
from stiction.devices.risk import LengthBounds
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.report.axes import figures as figures_roughness
from stiction.report.axes import roughness as sentences
from stiction.report.axes import tables
from stiction.report.limits.words import text
from stiction.report.style import png
from stiction.run.stored_limits import as_text, of_text
from stiction.stages.axes import points, requirement, roughness
from stiction.stages.axes.roughness import POINTS
from stiction.stages.devices import sticking
from stiction.stages.devices.opening import S_SHAPE
from stiction.surface.feasible import largest_kurtosis

SAMPLES, SHARE = 200, 0.05
S1 = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 3, "humidities": [0.45, 0.6]}
S1 |= {"requirement": {"share": SHARE}, "roughness": {"surface": "B2", "rms_nm": [2, 8]}}
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 10, "width_um": 6, "humidities": [0.88]}
C1 |= {"requirement": {"share": 0.02, "length_um": 300}, "roughness": {"surface": "B2", "rms_nm": [3.4, 8]}}
SECTIONS = {
    "devices": {"S1": S1, "C1": C1},
    "contact": {"samples": SAMPLES, "model": "summits"},
    "chaos": {"order": 2},
    "design": {"beams": 200, "shares": [0.02], "worst_humidities": [0.45, 0.6]},
    "run": {"pairs": [], "studies": []},
}
CONFIG = stiction.load(SECTIONS)


@pytest.fixture(scope="module")
def stopper():
    return stiction.Device("S1", Results.of(CONFIG))


@pytest.fixture(scope="module")
def cantilever():
    return stiction.Device("C1", Results.of(stiction.load(SECTIONS, {"contact": {"model": "summits"}})))


def forces_at(rms, **changed):
    """Pull-off forces of the stopper on surfaces of an rms [m], at the second humidity (m,) [N]."""
    surfaces = {"surfaces": {"B2": {"rms_nm": 1e9 * rms}}}
    return stiction.Device("S1", Results.of(stiction.load(SECTIONS, surfaces, changed))).forces().pull_off[1].values


def test_the_curve_of_a_stopper_at_the_given_roughness_is_todays_result(stopper):
    found, today = stopper.roughness(), stopper.forces()
    given = found.sel(roughness=float(found.given))
    np.testing.assert_array_equal(given.stuck[:, 0], today.stuck.T)
    assert float(found.given) == float(stopper.results["heights/B2"].rms)


@pytest.mark.slow
def test_the_curve_of_a_cantilever_at_the_given_roughness_is_todays_result(cantilever):
    today = cantilever.safe_lengths(0.88).sel(share=0.02)
    given = cantilever.results[f"devices/roughness/points/C1_{POINTS - 1}"].sel(humidity=0.88)
    for name, theirs in (("safe", "safe_length"), ("estimate", "estimate"), ("bound", "flooded_length")):
        np.testing.assert_array_equal(given[name], today[theirs])
    both = today.beams_error**2 + today.surfaces_error.fillna(0) ** 2
    np.testing.assert_allclose(given.error, np.sqrt(both), rtol=1e-12)
    assert given.error[0] > today.beams_error[0]


IN_DRY_AIR = {"attraction": {"reach": "all"}, "contact": {"samples": 60}, "chaos": {"order": 1}}
IN_DRY_AIR |= {"studies": {"full_contact": {"samples": 8}}}
IN_DRY_AIR |= {
    "devices": {"S1": {"humidities": ["dry", 0.6], "restoring_force_uN": 0.2}, "C1": {"humidities": ["dry"]}}
}


@pytest.fixture(scope="module")
def dry():
    """Results in dry air, where full contact decides."""
    return Results.of(stiction.load(SECTIONS | {"contact": {}}, IN_DRY_AIR))


@pytest.mark.nightly
def test_points_at_the_given_roughness_are_todays_results_in_dry_and_in_humid_air(dry):
    stopper, cantilever = (dry[f"devices/roughness/points/{name}_{POINTS - 1}"] for name in ("S1", "C1"))
    np.testing.assert_array_equal(stopper.stuck[:, 0], dry["devices/stoppers/S1"].stuck.T)
    assert np.all(stopper.estimate[0] < stopper.estimate[1])  # no water pulls
    today = stiction.Device("C1", dry).safe_lengths("dry").sel(share=0.02)
    for name, theirs in (("safe", "safe_length"), ("estimate", "estimate"), ("bound", "flooded_length")):
        np.testing.assert_array_equal(cantilever[name].sel(humidity=0), today[theirs])


@pytest.mark.slow
def test_smooth_stoppers_in_dry_air_are_held_more_than_rough_ones_and_the_page_says_what_suffices(dry):
    found = stiction.Device("S1", dry).roughness()
    assert np.all(np.diff(found.estimate.sel(humidity=0, shape="force")) < 0)
    first, second, flag = sentences.answers(found)
    assert first.startswith("For a restoring force of 0.2 µN, in dry air, ")
    assert "(dry)" in flag
    assert text(requirement.SMOOTHER) in flag
    assert "at a relative humidity of 0.6" in second
    figure = figures_roughness.roughness(found)
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    assert any(entry.startswith("dry, estimate and 95 % band") for entry in entries)
    assert covering(figure) == []


@pytest.mark.slow
def test_surfaces_that_no_water_wets_are_held_at_any_humidity_as_in_dry_air():
    wax = {"materials": {"Wax": {"contact_angle_deg": 100}}}
    wax |= {"surfaces": dict.fromkeys(("B2", "Sub1"), {"material": "Wax"})}
    config = stiction.load(SECTIONS | {"contact": {}}, IN_DRY_AIR, wax, {"contact": {"samples": 20}})
    config["studies"]["full_contact"]["samples"] = 3
    found = Results.of(config)["devices/roughness/points/S1_0"]
    dry, humid = (found.sel(humidity=humidity, drop=True) for humidity in (0.0, 0.6))
    xr.testing.assert_identical(dry, humid)
    assert float(dry.estimate[0]) > 0


@pytest.mark.slow
def test_the_legend_of_a_cantilever_names_the_bounds_of_beam_and_tip(cantilever):
    given = cantilever.results[f"devices/roughness/points/C1_{POINTS - 1}"]
    figure = figures_roughness.roughness(joined([given.assign(roughness=2e-9), given]))
    assert {"flat surfaces, beam", "flat surfaces, beam or tip"} < {
        text.get_text() for text in figure.legends[0].get_texts()
    }
    assert covering(figure) == []


def test_a_required_roughness_put_back_has_the_share_within_its_error(stopper):
    found = stopper.roughness()
    place, error = (float(found[name][-1]) for name in ("crossing_place", "crossing_error"))
    assert float(found.crossing_humidity[-1]) == 0.6
    statistical = np.sqrt(SHARE * (1 - SHARE) / SAMPLES)
    assert abs(np.mean(forces_at(place) > 3e-6) - SHARE) < statistical  # on the surfaces of the curve
    for rms, holds in ((place, True), (place - 5 * error, False)):
        share = np.mean(forces_at(rms, seed=7) > 3e-6)  # on others, whose share has an error of its own
        assert bool(abs(share - SHARE) < 3 * np.sqrt(2) * statistical) is holds


def test_forces_of_a_stopper_in_dry_air_decrease_with_the_roughness(stopper):
    found = stopper.roughness().sel(humidity=0.45, shape="force")
    assert np.all(np.diff(found.estimate) < 0)
    assert np.all(np.diff(found.stuck.sel(end="estimate")) <= 0)
    assert np.all(found.safe > found.estimate)


def test_water_alone_holds_smooth_stoppers_by_its_tension_and_rough_ones_less():
    wet = {"van_der_waals": "none", "contact": {"samples": 60, "model": "summits"}}
    wet |= {"devices": {"S1": {"humidities": [0.95], "roughness": {"rms_nm": [0.3, 30]}}}}
    found = stiction.Device("S1", Results.of(stiction.load(SECTIONS, wet))).roughness().isel(humidity=0, shape=0)
    flooded = Water(300.0).film(0.95)[1] * 1e-12
    # The largest attraction is the vertex of a parabola, which exceeds the end of a plateau a little.
    np.testing.assert_allclose(found.estimate[0], flooded, rtol=5e-3)
    assert np.all(np.diff(found.estimate) <= 5e-3 * flooded)
    assert float(found.estimate[-1]) < 0.5 * flooded


def test_a_share_that_needs_more_stoppers_than_were_drawn_has_them():
    more = Plan(stiction.load(SECTIONS, {"devices": {"S1": {"requirement": {"share": 1e-3}}}}))
    assert patches(more) == 2995
    assert patches(Plan(CONFIG)) == SAMPLES


def patches(plan):
    """Number of patches at a point of the stopper."""
    contacts = Graph(plan).job("devices/roughness/points/S1_0").settings["device"]["humid"]
    return contacts["contact"]["contact"]["samples"]


def test_points_are_spaced_by_equal_factors_or_evenly_and_the_last_one_is_the_given_surface():
    (values,) = roughness.axes_of(Plan(CONFIG), "S1").values()
    assert values[-1] is None
    np.testing.assert_allclose(np.diff(np.log(values[:-1])), np.log(8 / 2) / (POINTS - 2), rtol=1e-8)
    skewness = roughness.spaced("skewness", -1, 0.5, POINTS - 1)
    np.testing.assert_allclose(np.diff(skewness), 1.5 / (POINTS - 2), rtol=1e-8)


def test_a_range_that_ends_at_the_given_roughness_has_it_once():
    points = [point(value) for value in (1e-9, 2e-9, 3.4e-9, 3.4e-9 * (1 + 1e-15))]
    found = joined(points)
    np.testing.assert_array_equal(found.roughness, [1e-9, 2e-9, 3.4e-9 * (1 + 1e-15)])


WATER = Water(300.0)


def point(rms, refused="", force=None, flagged="", water=WATER):
    """Point of a curve of a stopper with the force 1e-6 (4 nm / rms)³, or with another one [N]."""
    settings = requirement.RequiredStopper(
        seed=1, water=water, humidities=(0.6,), contact=(1e-6, 1e-6), share=0.05, restoring_force=1e-6
    )
    force = 1e-6 * (4e-9 / rms) ** 3 if force is None else force
    response = requirement.Response(1.1 * force, force, 0.03 * force, np.nan, (0.1, 0.05, 0.15))
    said = {"flagged": ("humidity", [flagged]), "refused": ("humidity", [refused])}
    return requirement.layout([[response]], 400, settings).assign(said | {"roughness": rms})


def joined(points, key="rms_nm"):
    """Curve over a quantity of B2."""
    return roughness.curve_or_map(points, "B2", key)


RANGE = np.geomspace(1e-9, 8e-9, POINTS - 1)
RANGE8 = [*RANGE, 3.4e-9]


def test_page_and_table_say_which_roughness_suffices_with_its_error():
    found = joined([*map(point, RANGE), point(3.4e-9)])
    (sentence,) = sentences.answers(found)
    assert "at most 1 in 20 sticks where the rms of B2 is 4.13 to 8 nm" in sentence  # 4 nm (1.1)^(1/3)
    assert "exactly 1 in 20 sticks at 4.000 ± 0.040 nm." in sentence
    assert "at 3.4 nm, 10 % (5 to 15 %) stick" in sentence
    table = tables.of_roughness({"S1": found})
    assert sentence in table.caption
    np.testing.assert_allclose(table.frame.value, np.sort([*(1e9 * RANGE), 3.4]))
    np.testing.assert_allclose(table.frame.required, 1)
    assert set(table.frame.unit) == {"µN"}
    assert png(figures_roughness.roughness(found))[:4] == b"\x89PNG"


SURE = "by simulation alone, 95 % confidence, given the drawn surfaces"


@pytest.mark.parametrize(
    ("force", "said"),
    [
        (2e-6, "no rms of B2 of 1 to 8 nm suffices: nowhere there is it certain that at most 1 in 20 sticks."),
        (0.5e-6, f"at most 1 in 20 sticks at any rms of B2 of 1 to 8 nm ({SURE})."),
        (0.0, f"at most 1 in 20 sticks at any rms of B2 of 1 to 8 nm ({SURE})."),
    ],
)
def test_none_and_all_of_a_range_are_answers(force, said):
    points = [point(rms, force=force) for rms in (*RANGE, 3.4e-9)]
    (sentence,) = sentences.answers(joined(points))
    assert said in sentence


def test_a_beam_that_sticks_at_no_length_is_an_answer():
    device = SimpleNamespace(opening=SimpleNamespace(shapes=(S_SHAPE,)))
    common = {"seed": 1, "chaos": None, "water": WATER, "humidities": (0.6,), "device": device, "beams": 100}
    beam = requirement.RequiredBeam(**common, share=SHARE, length=1e-4, edge_radius=0.0)
    known, lengths = LengthBounds(2e-4, 5e-5, 5e-5), np.full(100, np.inf)
    never = beam._response(lengths, *sticking.safe_lengths(lengths, beam, known), known)
    points = [
        requirement.layout([[never]], 100, beam).assign(
            flagged=("humidity", [""]), refused=("humidity", [""]), roughness=rms
        )
        for rms in RANGE
    ]
    found = joined(points)
    (sentence,) = sentences.answers(found)
    assert "at most 1 in 20 sticks at any rms of B2 of 1 to 8 nm" in sentence
    assert "at 8 nm, at most " in sentence
    frame = tables.of_roughness({"C1": found}).frame
    np.testing.assert_allclose(frame.required, 100)
    assert set(frame.unit) == {"µm"}
    assert png(figures_roughness.roughness(found))[:4] == b"\x89PNG"


def test_a_margin_errs_by_the_relative_error_of_its_length_and_not_at_all_where_no_beam_sticks():
    lengths = {"estimate": ("point", [5e-5, np.inf]), "error": ("point", [1e-6, np.nan])}
    curve = xr.Dataset(lengths | {"required": ((), 1e-4, {"units": "m"})})
    np.testing.assert_allclose(requirement.relative_errors(curve), [0.02, 0])


def test_a_stopper_that_is_held_most_inside_the_range_has_a_worst_roughness():
    forces = 4e-6 * np.exp(-(np.log(RANGE / 2e-9) ** 2))
    found = joined([*map(point, RANGE, [""] * len(RANGE), forces), point(3.4e-9, force=3e-6)])
    (sentence,) = sentences.answers(found)
    assert "The worst rms of B2 is inside this range, near 2 nm: less and more of it hold less." in sentence
    (monotone,) = sentences.answers(joined([*map(point, RANGE), point(3.4e-9)]))
    assert "worst" not in monotone


def test_what_cannot_be_computed_is_named_with_its_reason_and_leaves_the_rest():
    points = [point(RANGE[0], "too smooth", np.nan), *map(point, RANGE[1:]), point(3.4e-9)]
    sentence, refusal = sentences.answers(joined(points))
    assert "where the rms of B2 is 4.13 to 8 nm" in sentence
    assert "computed for 1.41 to 8 nm" in sentence
    assert refusal == "Not computed where the rms of B2 is 1 nm (RH 0.6): too smooth."
    nowhere = [point(rms, "too smooth", np.nan) for rms in RANGE8]
    sentence, _ = sentences.answers(joined(nowhere))
    assert "nothing is computed" in sentence


def test_what_is_less_accurate_is_named_with_its_place():
    points = [point(RANGE[0], flagged=as_text([noted("Strips are long.")])), *map(point, RANGE[1:]), point(3.4e-9)]
    _, flag = sentences.answers(joined(points))
    assert flag == "Where the rms of B2 is 1 nm (RH 0.6): surface B2: Strips are long."


def test_smoother_surfaces_than_those_of_full_contact_are_flagged_and_no_others():
    """Their forces are corrected by the ratios of the given surface, which are too small for them."""
    full = replace(WATER, correction=Correction(np.array([0.5, 0.8]), ElasticChange(1.2), ElasticChange(1.3)))
    values = [*RANGE, 3.4e-9]
    points = [point(value, flagged=as_text([noted("Long.")] * (k == 0)), water=full) for k, value in enumerate(values)]
    flags = joined(points).flagged.sel(humidity=0.6)
    assert of_text(flags.values[0]) == [noted("Long."), requirement.SMOOTHER]
    for flag, rms in zip(flags.values, flags.roughness.values, strict=True):
        assert (requirement.SMOOTHER in of_text(flag)) == (rms < 3.4e-9)
    for key, water in (("skewness", full), ("rms_nm", WATER)):
        others = joined([point(value, water=water) for value in values], key)
        assert not others.flagged.values.any()


# Two quantities


FEW = {"contact": {"samples": 60}, "chaos": {"order": 1}}
MAP = FEW | {"devices": {"S1": {"humidities": [0.6], "roughness": {"skewness": [-1, 0.2]}}}}


@pytest.fixture(scope="module")
def mapped():
    """A device with a map of three curves."""
    device = stiction.Device("S1", Results.of(stiction.load(SECTIONS, MAP)))
    with patch.object(roughness, "CURVES", 3):
        device.roughness()
    return device


@pytest.mark.slow
def test_the_curve_of_a_map_at_the_given_second_quantity_is_that_of_one_quantity_bit_for_bit(mapped):
    plain = stiction.load(SECTIONS, FEW, {"devices": {"S1": {"humidities": [0.6]}}})
    alone = stiction.Device("S1", Results.of(plain)).roughness()
    found = mapped.roughness()
    (row,) = [one for one in roughness.curves_of(found) if one.other == found.other_given]
    own = row[list(alone.variables)].drop_vars(["other"], errors="ignore")
    xr.testing.assert_equal(own, alone)
    assert not alone.estimate.equals(roughness.curves_of(found)[0].estimate.drop_vars("other"))


@pytest.mark.slow
def test_every_other_curve_of_a_map_is_that_of_a_surface_with_this_second_quantity(mapped):
    found = mapped.roughness()
    skewness = float(found.other[0])
    assert skewness == -1
    surface = FEW | {"surfaces": {"B2": {"skewness": skewness}}, "devices": {"S1": {"humidities": [0.6]}}}
    forces = stiction.Device("S1", Results.of(stiction.load(SECTIONS, surface))).forces().pull_off[0].values
    one = found.sel(other=skewness, roughness=float(found.given), humidity=0.6, shape="force")
    (expected,) = stoppers.safe_forces(forces[None], SHARE, np.random.default_rng(0))  # sampled, not fitted
    np.testing.assert_allclose(one.estimate, expected.estimate, rtol=1e-5)


@pytest.mark.slow
def test_peaks_of_a_skewed_surface_keep_stoppers_apart(mapped):
    found = mapped.roughness().sel(roughness=float(mapped.roughness().given), humidity=0.6, shape="force")
    assert found.other.values.tolist() == sorted(found.other.values)
    assert np.all(np.diff(found.estimate) < 0)  # the more positive the skewness, the more peaks and the less valleys


@pytest.mark.slow
def test_a_map_is_told_curve_by_curve_and_drawn(mapped):
    found = mapped.roughness()
    said = sentences.answers(found)
    assert len(said) == found.sizes["other"] == 3
    assert said[0].startswith(
        "Where the skewness of B2 is -1 and the kurtosis 3.9: For a restoring force of 3 µN, at a relative humidity of "
        "0.6, "
    )
    given = [sentence.partition(", as given: ")[2] for sentence in said if ", as given: " in sentence]
    assert len(given) == len(sentences.briefly(found)) == 1
    assert given[0].startswith(sentences.briefly(found)[0].removesuffix("."))
    table = tables.of_roughness({"S1": found})
    assert len(table.frame) == POINTS * 3
    assert "and" in table.cells
    for drawn in (figures_roughness.roughness_map, figures_roughness.roughness):
        assert png(drawn(found))[:4] == b"\x89PNG"


def skewed(rms, skewness):
    """Point of a map over rms and skewness, as given without skewness."""
    return point(rms).assign(other=skewness, other_given=0.0, kurtosis=3 + skewness**2)


@pytest.mark.parametrize("varied", [{"skewness": [-1, 0.5]}, {"rms_nm": [2, 8], "skewness": [-1, 0.5]}])
def test_a_skewness_comes_with_the_largest_kurtosis_up_to_that_of_the_surface_and_states_it(varied):
    section = {"surface": "B2"} | varied
    device = S1 | {"roughness": section, "humidities": [0.6]}
    plan = Plan(stiction.load({"devices": {"S1": device}, "contact": {"model": "summits"}}))
    seen = []
    with patch.object(points.DeviceAtPoint, "on", lambda *given: seen.append(given[2][0]["B2"]) or [xr.Dataset()]):
        for number in range(0, 40, POINTS) if len(varied) > 1 else (0, 3, 6):
            job = Graph(plan).job(f"devices/roughness/points/S1_{number}")
            found = job.compute(Results(Graph(plan)).inputs(job))
            assert float(found.kurtosis) == seen[-1].kurtosis
            assert seen[-1].kurtosis == pytest.approx(min(3.9, largest_kurtosis(abs(seen[-1].skewness))), rel=1e-6)
    assert len({surface.kurtosis for surface in seen}) > 1  # control: it does change


def test_the_kurtosis_stands_beside_every_skewness_in_sentences_tables_and_figures():
    over_both = roughness.curve_or_map(
        [skewed(rms, value) for value in (0, -1, 0.5) for rms in RANGE8], "B2", "rms_nm", "skewness"
    )
    alone = [point(3e-9).assign(roughness=value, kurtosis=3 + value**2) for value in (-1.0, 0.5, 0.0)]
    over_one = joined(alone, "skewness")
    for found, axis, between in ((over_both, "yaxis", " "), (over_one, "xaxis", "\n")):
        draw = figures_roughness.roughness_map if "other" in found.dims else figures_roughness.roughness
        labels = [text.get_text() for text in getattr(draw(found).axes[0], axis).get_ticklabels()]
        assert labels == [f"−1{between}(4)", f"0{between}(3)", f"0.5{between}(3.25)"]
        table = tables.of_roughness({"S1": found})
        assert set(table.cells["kurtosis"]) == {"4", "3", "3.25"}
        assert "kurtosis" in table.caption
        assert "kurtosis" in sentences.form(found)
    assert [sentence.partition(": ")[0] for sentence in sentences.answers(over_both)] == [
        "Where the skewness of B2 is -1 and the kurtosis 4",
        "Where the skewness of B2 is 0 and the kurtosis 3, as given",
        "Where the skewness of B2 is 0.5 and the kurtosis 3.25",
    ]
    plain = joined([point(rms) for rms in RANGE8])  # control: nothing of it elsewhere
    assert "kurtosis" not in tables.of_roughness({"S1": plain}).caption + sentences.form(plain)


def test_a_second_value_that_is_the_given_one_is_there_once():
    points = [skewed(rms, value) for value in (0, -1, -0.5, 1e-14, 1) for rms in RANGE8]
    found = roughness.curve_or_map(points, "B2", "rms_nm", "skewness")
    assert found.other.values.tolist() == [-1, -0.5, 0, 1]
    assert [len(one.crossing) for one in roughness.curves_of(found)] == [1] * 4


def test_a_map_of_a_stopper_has_positive_margins_where_the_restoring_force_exceeds_the_adhesion():
    points = [skewed(rms, value) for value in (0, -1) for rms in RANGE8]
    figure = figures_roughness.roughness_map(roughness.curve_or_map(points, "B2", "rms_nm", "skewness"))
    panel, bar = figure.axes
    assert bar.get_ylabel() == "restoring force / force needed"
    figure.draw_without_rendering()
    ticks = zip(bar.get_yticks(), bar.get_yticklabels(), strict=True)
    assert all(abs(np.log10(float(text.get_text())) - at) < 0.02 for at, text in ticks)
    assert "sticks" in {text.get_text() for text in panel.texts}
    margins = panel.collections[0]
    np.testing.assert_allclose([margins.zmin, margins.zmax], 3 * np.log10([1 / 4, 2]))


@pytest.mark.slow
def test_a_stopper_of_30_micronewton_sticks_at_3_4_nm_and_not_at_5_nm():
    bump = {"contact_um": [5, 5], "restoring_force_uN": 30, "humidities": [0.6], "requirement": {"share": 0.01}}
    bump |= {"roughness": {"rms_nm": [3.4, 5]}}
    few = {"contact": {"samples": 300}, "chaos": {"order": 6}, "devices": {"S1": bump}}
    few |= {"attraction": {"reach": "touching"}}  # as where these numbers are from
    found = stiction.Device("S1", Results.of(stiction.load(SECTIONS, few))).roughness()
    ends = found.stuck.sel(shape="force", humidity=0.6).isel(roughness=[0, -1])
    np.testing.assert_allclose(ends.sel(end="estimate"), [0.84, 0], atol=0.005)


@pytest.mark.parametrize(("share", "samples"), [(1e-6, 29_956), (1e-3, 2995), (1e-4, 1000), (1e-6, 2_995_731)])
def test_a_share_beyond_samples_and_verification_is_called_extrapolated(share, samples):
    found = xr.Dataset({"share": share, "samples": samples})
    (said,) = sentences.note_on_extrapolation(found) or [""]
    assert said.startswith("The result for 1 in 1 000 000 is extrapolated from 29956") == (samples == 29_956)
    assert bool(said) == (samples == 29_956)


def test_rare_shares_of_stoppers_need_no_more_patches_than_the_rarest_that_was_verified():
    def samples(share):
        asked = {"requirement": {"share": share}, "roughness": {"surface": "B2", "rms_nm": [1, 8]}}
        bump = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 1, "humidities": [0.5]}
        few = {"contact": {"samples": 100}, "run": {"pairs": []}}
        return patches(Plan(stiction.load(few, {"devices": {"S1": bump | asked}})))

    assert [samples(share) for share in (0.05, 1e-3, 1e-4, 1e-5, 1e-6)] == [100, 2995, 29_956, 29_956, 29_956]
