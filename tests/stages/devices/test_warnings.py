import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from beams import PAPER
from ground import C1, R1, UM, safe_with_tips, safe_without_tips
from plans import job_settings

from stiction.config.files import load
from stiction.config.units import in_si
from stiction.constants import surface_energy
from stiction.contact.environment import Water
from stiction.contact.meniscus import film
from stiction.devices.limits import rules as limits
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.report.limits import pages
from stiction.report.limits.words import not_modelled, texts
from stiction.stages.beams import pair_warnings
from stiction.stages.devices import device_warnings
from stiction.stages.devices.opening import EITHER, MIDDLE, S_SHAPE
from stiction.stages.surfaces.surface_flags import flagged

PLAN = Plan(load())


def beams(s_shaped, arc, crack=700 * UM):
    """Dataset of stage beams with numbers of S-shaped beams and of arcs."""
    state = np.repeat([0, 1], [s_shaped, arc])
    return xr.Dataset({"state": ("beam", state), "crack_length": ("beam", np.where(state, 1500 * UM, crack))})


def in_words(limits):
    """Sentences on limits by subject, a name or a tuple."""
    return {str(key) if isinstance(key, pair_warnings.Subject) else key: texts(found) for key, found in limits.items()}


def about_beams(*case):
    """Sentences on the beams of a case of the main line."""
    return texts(pair_warnings.beam_warnings(*case))


def about_device(dataset, of, *case, **more):
    """Sentences on a device, by shape."""
    return in_words(of.limits(dataset, *case, **more))


def about_curves(*case):
    """Sentences on the curves of a chart."""
    return in_words(device_warnings.chart_warnings(*case))


def device(energy=2e-3, of=C1):
    tips = energy * np.exp(0.4 * np.random.default_rng(9).standard_normal(400))
    return safe_with_tips(tips), device_warnings.OfDevice(of)


# Main line


def test_s_shaped_beams_of_the_paper_have_no_warning():
    assert about_beams(beams(50, 0), PAPER, 1.5 * UM) == []


def test_arcs_and_what_their_mean_lacks_are_each_said_once():
    arcs, mean = about_beams(beams(58, 42, 1400 * UM), PAPER, 1.5 * UM)
    assert "42 % of the beams end as arcs" in arcs
    assert "1.5 µm" in arcs
    assert "1400 µm" in mean
    assert "1500 µm" in mean


def test_beams_that_all_end_as_arcs_have_no_mean_to_warn_about():
    (sentence,) = about_beams(beams(0, 10), PAPER, 1.5 * UM)
    assert "100 % of the beams end as arcs" in sentence


@pytest.mark.parametrize(
    ("beam", "words"),
    [
        (replace(PAPER, gap=60 * UM), "700 µm the beam reaches a slope of 0.129"),
        (replace(PAPER, thickness=50 * UM), "14 times as long"),
        (replace(PAPER, width=700 * UM), "bends as a plate"),
    ],
)
def test_each_dimension_beyond_the_model_is_said_once(beam, words):
    (sentence,) = about_beams(beams(9, 0), beam, 1.5 * UM)
    assert words in sentence


def about_pairs(cases, plasticity, plan=PLAN):
    settings = job_settings(plan, "warnings.md")
    nominal = in_si(pair_warnings.OfPairs, settings["pairs"])
    return in_words(pair_warnings.main_line_warnings(cases, plasticity, settings["materials"], nominal))


@pytest.mark.parametrize(("replica", "is_said"), [(None, False), ({}, False), ({"play_nm": 20}, True)])
def test_pairs_with_play_say_that_their_strips_move_alone(replica, is_said):
    stated = {} if replica is None else {"pairs": {"b": {"replica": {"coherence": 0.5} | replica}}}
    plan = Plan(load(stated | {"run": {"pairs": ["b"]}}))
    assert ("replicas" in job_settings(plan, "warnings.md")["pairs"]) is (replica is not None)
    (said,) = about_pairs({}, {}, plan).values()
    assert any("a play of 20 nm" in sentence for sentence in said) is is_said


NOT_MEASURED = {"estimates": {}, "spectra": {}}
#: Two flags of a measured surface, as the datasets of its estimate and spectrum hold them.
MEASURED = {
    "estimates": {"Etched": xr.Dataset(flagged([("spectrum_ends", "the spectrum ends near 125 rad/µm")]))},
    "spectra": {"Etched": xr.Dataset(flagged([("grid_ends", "cut by the grid")]))},
}
FLAGS = ["surface Etched: the spectrum ends near 125 rad/µm", "surface Etched: cut by the grid"]


def test_flags_of_a_surface_stand_beside_everything_that_rests_on_it(warned):
    settings = job_settings(PLAN, "warnings.md") | {"surfaces": {"a": ["Etched"], "b": []}}
    page = pages.as_markdown(*pages.STAGES[0].result({"beams": {}, "plasticity": PLASTIC} | MEASURED, At(), settings))
    for flag in FLAGS:
        (line,) = (line for line in page.splitlines() if flag in line)
        assert line.startswith("- pair a: ")
    assert in_words(pair_warnings.surface_notes(MEASURED, settings["surfaces"])) == {"a": FLAGS, "b": []}, (
        "in Table III"
    )
    assert warned({"S1": stopper()}, surfaces=MEASURED).patches["S1"][-2:] == FLAGS
    assert not set(FLAGS) & set(warned({"S1": stopper()}).patches["S1"])
    lengths = {("C1", 0.67): device()[0]}
    found = warned({"C1": {"beam": BEYOND}}, lengths, surfaces=MEASURED).lengths
    assert found
    assert all(said[-2:] == FLAGS for said in found.values())


SHARES = {"a": 0.0, "b": 0.02, "c": 0.58}
PLASTIC = {pair: xr.Dataset({"plastic_share": share, "pressure": 1.04e8}) for pair, share in SHARES.items()}


def test_only_pairs_with_plastic_contact_are_said_to_be_plastic():
    cases = {("b", 0.67, "NG"): beams(20, 0), ("b", 0.67, "G"): beams(10, 10)}
    found = about_pairs(cases, PLASTIC)
    assert {subject for subject, sentences in found.items() if sentences} == {"pair c", "pair b, RH 0.67, G"}
    assert found["pair c"][0].startswith("58 % of the area in contact is plastic")
    assert "pressed together with 104 MPa" in found["pair c"][0]


def test_pairs_whose_plasticity_was_not_studied_are_said_to_be_unchecked():
    found = about_pairs({}, {"a": PLASTIC["a"], "c": PLASTIC["c"]})
    assert found["pair a"] == []
    (sentence,) = found["pair b"]
    assert "was not checked" in sentence


@pytest.mark.parametrize(("studies", "named"), [([], True), (["plasticity"], False), (None, False)])
def test_the_remedy_names_the_list_of_studies_where_it_leaves_plasticity_out(studies, named):
    plan = Plan(load({"run": {"pairs": ["b"]} | ({} if studies is None else {"studies": studies})}))
    data = {"beams": {}, "plasticity": {}} | NOT_MEASURED
    page = pages.as_markdown(*pages.STAGES[0].result(data, At(), job_settings(plan, "warnings.md")))
    assert "give its distance in studies.plasticity.distance_nm" in page
    assert (", and name plasticity in run.studies." in page) == named


@pytest.mark.parametrize(("modulus", "missing"), [(164, False), (150, False), (180, False), (70, True), (200, True)])
def test_a_solid_far_from_polysilicon_is_said_to_keep_its_other_properties(modulus, missing):
    found = about_pairs({}, PLASTIC, Plan(load({"solid": {"young_modulus_GPa": modulus}})))
    words = "3 properties of the solid are not stated", "hardness, Hamaker constant, contact angle."
    assert all(word in " ".join(found["pair a"]) for word in words) == missing
    assert len(found["pair a"]) == missing


def test_a_pair_of_stated_materials_does_not_have_the_solid():
    gold = dict.fromkeys(("young_modulus_GPa", "hardness_GPa"), 80) | {"poisson_ratio": 0.4, "contact_angle_deg": 0}
    of_gold = {"materials": {"Gold": gold | {"hamaker_constant_zJ": {"water": 250, "dry": 400}}}}
    of_gold |= {"solid": {"young_modulus_GPa": 70}, "surfaces": {"B2": {"material": "Gold"}}}
    one = about_pairs({}, PLASTIC, Plan(load(of_gold)))["pair b"]
    assert [sentence.split(" are not")[0] for sentence in one] == ["3 properties of the solid"]
    both = Plan(load(of_gold, {"surfaces": {"Sub1": {"material": "Gold"}}}))
    assert about_pairs({}, PLASTIC, both)["pair b"] == []


#: Table III of the last run in the documentation.
TABLE = Path(__file__).parents[3] / "docs" / "tables" / "table_3.csv"


def test_beams_of_pairs_a_and_b_at_the_humidities_of_the_paper_have_the_warnings_that_are_true_of_them():
    with TABLE.open() as file:
        rows = [row for row in csv.DictReader(file) if row["pair"] in "ab"]
    assert len(rows) == 36
    arcs = []
    for row in rows:
        shares = [float(row[f"share_{state}"]) for state in ("s_shape", "arc", "free")]
        mean = float(row["crack_length_um"] or "nan") * UM
        ended = xr.Dataset({"state": ("beam", np.repeat([0, 1, 2], np.round(np.multiply(shares, 1000)).astype(int)))})
        ended["crack_length"] = "beam", np.where(ended.state == 0, mean, 1500 * UM)
        found = about_beams(ended, PAPER, 1.5 * UM)
        # Gaussian surfaces and all in the driest air adhere so little that some end as arcs: two sentences, else none.
        assert len(found) == (shares[1] > 0) + (0 < shares[0] < 1)
        assert all("end as arcs" in sentence or "end S-shaped" in sentence for sentence in found)
        arcs += [row["model"]] * (shares[1] > 0)
    assert 0 < len(arcs) < len(rows) / 2


# Devices


def only(found, of, shape=EITHER, **more):
    """Warnings about a device in one shape."""
    return about_device(found, of, **{"plastic": (0.0, 3e7)} | more)[shape]


def test_a_device_within_the_limits_has_no_warning():
    found, of = device()
    assert about_device(found, of, plastic=(0.02, 3e7)) == {S_SHAPE: [], EITHER: []}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"device": replace(C1, gap=100 * UM)}, "reaches a slope of"),
        ({"device": replace(C1, thickness=50 * UM)}, "times as long as the beam is thick"),
        ({"device": replace(C1, width=700 * UM)}, "bends as a plate"),
        ({"materials": (("Gold", ("hardness",)),)}, "4 properties of Gold are not stated"),
        ({"materials": (("polysilicon", ("coating",)),)}, "coating of polysilicon counts as a spacer"),
    ],
)
def test_each_limit_of_a_device_is_said_once(changes, words):
    found, of = device()
    (sentence,) = only(found, replace(of, **changes))
    assert words in sentence


def test_a_shape_has_the_warnings_of_its_own_length():
    found, of = device(energy=20e-3)
    alone, tip = (1e6 * float(found.safe_length.sel(shape=shape).min()) for shape in (S_SHAPE, EITHER))
    assert tip < 0.7 * alone
    steep = replace(of, device=replace(C1, gap=0.08 / 1.5 * alone * UM))
    assert only(found, steep, S_SHAPE) == []
    (sentence,) = only(found, steep, EITHER)
    assert sentence.startswith(f"At a length of {tip:.0f} µm the beam reaches a slope of {0.08 * alone / tip:.3g}")


def test_a_smooth_pair_is_said_of_what_forces_hold_and_not_of_energies_along_a_beam():
    found, of = device()
    on_summits = replace(of, on_summits=(0.9,))
    for rms, said in ((1e-9, True), (3.4e-9, False)):  # a smooth pair and, as control, a rough one
        smooth = found.assign(rms=rms)
        for shape, dimples, forces in ((S_SHAPE, False, False), (EITHER, False, True), (S_SHAPE, True, True)):
            told = only(smooth, replace(on_summits, has_dimples=dimples), shape, humidity=0.9)
            assert any("Forces on summits are then too small, the unsafe side" in one for one in told) == (
                said and forces
            )
        assert not any("Forces on summits" in one for one in only(smooth, of, humidity=0.9)), "corrected"


def changes_of_forces(**ratios):
    """Dataset of changes at two humidities, of which those with a ratio are applied."""
    over = {"tip_ratio": ("slope", "humidity"), "pull_off_ratio": ("humidity",)}
    known = {name: (over[name], np.array(values)) for name, values in ratios.items()}
    ends = {name: np.reshape(ratios.get(f"{name}_ratio", np.nan * np.ones(2)), (-1, 2)) for name in ("tip", "pull_off")}
    flags = {f"{name}_applied": ("humidity", np.isfinite(of).all(axis=0)) for name, of in ends.items()}
    return xr.Dataset(known | flags, coords={"humidity": [0.5, 0.9]}).assign(nearest=((), True))


def test_where_full_contact_of_forces_is_not_known_they_rest_on_summits_and_this_is_said():
    """A tip is unknown at 0.9 at one slope, at both without a dataset; a device of both needs both."""
    found, of = device()
    of = replace(of, on_summits=(0.5, 0.9))
    tips, both = [[0.4, np.nan], [0.5, 0.6]], {"tip_ratio": [[0.4, 0.5]], "pull_off_ratio": [np.nan, 1.1]}
    cases = [({"tip_ratio": tips}, False, (0.9,)), ({}, False, (0.5, 0.9)), (both, False, ()), (both, True, (0.5,))]
    for ratios, dimples, unknown in cases:
        left = device_warnings._left_on_summits(
            replace(of, has_dimples=dimples), {"model_error": changes_of_forces(**ratios)}
        )
        assert left.unknown == left.on_summits == unknown
        for humidity in (0.5, 0.9):
            told = only(found, left, EITHER, humidity=humidity)
            assert any("does not settle, or takes too long" in one for one in told) == (humidity in unknown)
    uncertain = changes_of_forces(tip_ratio=[[0.4, 0.5]]).assign(tip_applied=("humidity", [False, True]))
    left = device_warnings._left_on_summits(of, {"model_error": uncertain})
    assert (left.on_summits, left.unknown) == ((0.5,), ()), "control: known, and too uncertain to be applied"


def test_a_device_is_checked_at_its_safe_length_not_at_the_longer_estimate():
    found, of = device()
    assert only(found.assign(estimate=0.1 * found.estimate), of) == []
    (sentence,) = only(found.assign(safe_length=0.5 * found.safe_length), of)
    assert "reaches a slope of" in sentence


def test_plastic_contact_of_a_device_is_said_and_so_is_that_it_was_not_studied():
    found, of = device()
    (sentence,) = only(found, of, plastic=(0.58, 1.04e8))
    assert "58 %" in sentence
    assert "when the surfaces are pressed together with 104 MPa: beams that were pressed" in sentence
    assert ["was not checked" in sentence for sentence in about_device(found, of)[S_SHAPE]] == [True]


def test_a_gap_that_the_film_fills_is_said():
    found, of = device()
    (sentence,) = only(found.assign(film=2e-6), of)
    assert "less than 20 times the sum of film height and roughness" in sentence


def test_a_bridge_that_stretches_is_said_and_has_half_its_length_as_crack():
    wide = safe_without_tips()
    crack = float(wide.safe_length.min()) / 2
    assert only(wide, device_warnings.OfDevice(replace(R1, thickness=5 * UM)), MIDDLE) == []
    (sentence,) = only(wide, device_warnings.OfDevice(R1), MIDDLE)
    assert "equal to the thickness of the bridge" in sentence
    steep = device_warnings.OfDevice(replace(R1, gap=0.11 / 1.5 * crack, thickness=80 * UM))
    assert any("slope of 0.11" in sentence for sentence in only(wide, steep, MIDDLE))


BEYOND = {"device": {"kind": "cantilever", "pair": "c", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}}
BEYOND["device"] |= {"young_modulus_GPa": 164, "strip_um": 1.5, "hamaker_constant_zJ": 97.5}
BEYOND |= {"materials": []}


@pytest.fixture
def warned(tmp_path):
    """Warnings about devices as the workflow writes and reads them, from their settings and datasets."""
    stage = next(stage for stage in device_warnings.STAGES if stage.name == "device_warnings")

    def read(sections, lengths=(), charts=(), surfaces=NOT_MEASURED, share_flat=0.0, rms=3e-9):
        files = {}
        for name, section in sections.items():
            own = [
                {key: found for key, found in dict(datasets).items() if key[0] == name}
                for datasets in (lengths, charts)
            ]
            stoppers = {name: xr.Dataset({"share_flat": share_flat, "rms": rms})} if "stopper" in section else {}
            data = {"lengths": own[0], "charts": own[1], "stoppers": stoppers, "plasticity": PLASTIC} | surfaces
            files[name] = tmp_path / f"{name}.json"
            stage.save(stage.result(data, At(), section), {"json": files[name]})
        return device_warnings.OfDevices(*map(in_words, device_warnings.read(files)))

    return read


def test_warnings_about_all_devices_have_their_names(warned):
    found, _ = device()
    warnings = warned({"C1": {"beam": BEYOND}}, {("C1", 0.67): found}).lengths
    assert list(warnings) == [("C1", 0.67, S_SHAPE), ("C1", 0.67, EITHER)]
    assert all(len(sentences) == 1 for sentences in warnings.values())


def test_settings_of_jobs_are_those_of_the_warnings():
    sizes = {"thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
    c1 = {"kind": "cantilever", "pair": "c"} | sizes
    plan = Plan(load({"devices": {"C1": c1 | {"chart": {"thicknesses_um": [2, 3], "humidities": [0.5, 0.9]}}}}))
    job = Graph(plan).job("devices/warnings/C1.json")
    assert job.settings == {"beam": BEYOND | {"on_summits": [0.67]}}
    assert len(job.inputs["charts"]) == plan.config["design"]["chart_points"] + 1, "with its own humidity"
    assert job.inputs["plasticity"] == {"c": "studies/plasticity/c"}


def test_a_film_that_is_hardly_a_liquid_is_said_of_a_device():
    found, of = device()
    (sentence,) = only(found.assign(film=film(0.39, 300.0)[0]), of)
    assert sentence.startswith("The film of water is 1.1 nm high, thinner than 4 molecules")
    assert only(found.assign(film=film(0.4, 300.0)[0]), of) == []


def test_cases_of_the_main_line_in_air_that_is_hardly_humid_enough_are_said():
    cases = {("b", 0.39, "NG"): beams(9, 0), ("b", 0.39, "G"): beams(9, 0), ("b", 0.4, "NG"): beams(9, 0)}
    said = {subject for subject, sentences in about_pairs(cases, PLASTIC).items() if "thinner" in " ".join(sentences)}
    assert said == {"pair b, RH 0.39, NG", "pair b, RH 0.39, G"}
    ((subject, (sentence,)),) = in_words(pair_warnings.film_warnings(cases, {"b": Water(300.0)})).items()
    assert subject == "Pair b, RH 0.39"
    assert sentence.startswith("The film of water is 1.1 nm high")


# Charts


def charted(longest, film=3e-9, longest_strip=1.5):
    """Dataset of stage chart of two thicknesses and two shapes, whose arcs are half as long as beams alone."""
    lengths = longest * np.array([[[[1.0, 0.9], [0.5, 0.45]]], [[[1.5, 1.4], [0.75, 0.7]]]])
    return xr.Dataset(
        {
            "safe_length": (("thickness", "gap", "shape", "share"), lengths),
            "flooded_length": (("thickness", "gap", "shape"), UM * np.array([[[300, 200]], [[400, 210]]])),
            "film": film,
            "rms": 3e-9,
            "longest_strip": (("thickness", "gap"), UM * np.array([[longest_strip], [2]])),
            "resampled": 0,
            "repetition": 0.0,
        },
        coords={"thickness": [2 * UM, 3 * UM], "gap": [20 * UM], "shape": [S_SHAPE, EITHER], "share": [1e-2, 1e-3]},
    )


def test_a_curve_of_a_chart_has_the_warnings_of_its_shortest_length(warned):
    found = {("C1", 0.5): charted(700 * UM), ("C1", 0.9): charted(500 * UM), ("C2", 0.9): charted(900 * UM)}
    section = {"beam": BEYOND | {"device": BEYOND["device"] | {"pair": "b"}}}
    warnings = warned(dict.fromkeys(("C1", "C2"), section), charts=found).curves
    given = {curve: sentences for curve, sentences in warnings.items() if sentences}
    assert list(given) == [("C1", 2 * UM, 20 * UM, EITHER)]
    assert given["C1", 2 * UM, 20 * UM, EITHER][0].startswith("At a length of 225 µm the beam reaches a slope of 0.13")
    assert len(warnings) == 8


def test_the_air_of_the_shortest_length_of_a_curve_counts():
    less_certain = xr.DataArray([1.0, 0.7], dims="share")
    along = [charted(700 * UM), charted(800 * UM, film=2 * UM)]
    along[1]["safe_length"] = along[1].safe_length * less_certain  # longer than the others at the largest share alone
    of = device_warnings.OfDevice(C1)
    assert "sum of film height and roughness" in about_curves(along, of, (0.0, 3e7))[3 * UM, 20 * UM, S_SHAPE][0]
    assert about_curves(along[:1], of, (0.0, 3e7))[3 * UM, 20 * UM, S_SHAPE] == []


def test_the_thinnest_film_of_a_curve_counts_whatever_the_air_of_its_shortest_length():
    along = [charted(800 * UM, film=1e-9), charted(700 * UM)]
    found = about_curves(along, device_warnings.OfDevice(C1), (0.0, 3e7))
    assert all("The film of water is 1 nm high" in " ".join(sentences) for sentences in found.values())


def test_the_thickness_of_a_curve_counts():
    found = about_curves([charted(50 * UM)], device_warnings.OfDevice(C1), (0.0, 3e7))
    thin, thick = ([text for text in found[t * UM, 20 * UM, EITHER] if "thick" in text] for t in (2, 3))
    assert thin[0].startswith("A crack of 22 µm is only 11.2 times as long as the beam is thick")
    assert thick[0].startswith("A crack of 35 µm is only 11.7 times as long as the beam is thick")


# Stoppers


def stopper(humidities=(0.44, 0.9), worst=(0.4, 0.98), side=3, angle=0, **more):
    """Settings of the warnings about a stopper."""
    water = {"temperature_K": 300, "contact_angles_deg": [angle, angle]}
    plain = {"pair": "b", "materials": [], "water": water, "contact_um": [side, side]}
    return {"stopper": plain | {"humidities": list(humidities), "worst_humidities": list(worst)} | more}


@pytest.mark.parametrize("humid", [{"humidities": [0.9999]}, {"worst": [0.4, 0.9999]}])
def test_a_film_that_is_not_small_against_a_stopper_is_said(humid, warned):
    wet = warned({"S1": stopper(**humid), "S2": stopper(side=300, **humid)}).patches
    (sentence,) = wet["S1"]
    assert "The film of water is up to 10.4 µm high, not small against the area in contact" in sentence
    assert "adds up to 693 % of the force of the film, more than 10 %" in sentence
    assert "unsafe side" in sentence
    assert wet["S2"] == []


def test_the_rim_of_a_film_adds_its_share_to_the_force_of_the_film():
    # Surface energy times the length of the rim, over tension times area.
    height, tension = film(0.995, 300.0)
    share = surface_energy(300.0) * (2 * 3e-6 + 2 * 5e-6) / (tension * 3e-6 * 5e-6)
    assert f"adds up to {100 * share:.3g} %" in texts([limits.wide_meniscus(height, (3e-6, 5e-6))])[0]


@pytest.mark.parametrize(
    "dry", [{"humidities": [0.39, 0.9]}, {"worst": [0.3, 0.9]}, {"humidities": [0.6], "worst": [0.6, 0.9], "angle": 60}]
)
def test_a_stopper_in_air_that_is_hardly_humid_enough_for_a_liquid_is_said(dry, warned):
    (sentence,) = warned({"S1": stopper(**dry)}).patches["S1"]
    assert sentence.startswith("The film of water is ")
    assert "thinner than 4 molecules, 1.12 nm: the air is too dry for the theory of a liquid" in sentence


def test_a_stopper_has_the_warnings_of_its_contact(warned):
    plain = {"S1": stopper(pair="c", materials=[["Gold", ["hardness"]]]), "S2": stopper(pair="d")}
    found = warned(plain).patches
    assert [sentence.split()[0] for sentence in found["S1"]] == ["58", "4"]
    assert "stoppers that were pressed hold more than the elastic model predicts, which is the" in found["S1"][0]
    assert "was not checked" in found["S2"][0]


# Page


SPACERS = [limits.spacer(name, ("coating",)) for name in ("One", "Two", "Three", "Four")]


def test_the_page_has_each_sentence_once_with_its_subjects_and_what_is_not_modelled():
    one, two = SPACERS[:2]
    found = {"pair a": [], "pair b": [one, two], "pair c": [two]}
    page = pages.as_markdown({pair_warnings.Subject(pair): of_pair for pair, of_pair in found.items()}, {})
    lines = [line for line in page.splitlines() if line.startswith("-")]
    assert [line.partition(" counts")[0] for line in lines] == [
        "- pair b: The coating of One",
        "- pair b; pair c: The coating of Two",
    ]
    assert page.endswith(f"{not_modelled()}\n")


def test_steep_lengths_of_one_device_have_one_line_about_the_steepest():
    lengths = {("C1", ()): 250, ("C1", ("chart",)): 200, ("C1", ("length",)): 220, ("C2", ()): 210}
    found = {
        pair_warnings.Subject(*subject): [limits.large_rotation(20 * UM, length * UM), SPACERS[0]]
        for subject, length in lengths.items()
    }
    steep = [one for one in pages.sentences(pages.by_limit(found)) if "a slope of" in one]
    assert [one.partition(": ")[0] for one in steep] == ["C1, chart", "C2"]
    assert "length of 200 µm" in steep[0]
    assert steep[0].endswith("; 2 more results are beyond the same limit.")
    assert "more results" not in steep[1], "the control: one alone"
    assert len(pages.by_limit(found)) == 5, "files for programs keep all"


def test_subjects_are_named_in_words():
    one, two, three, four = ([limit] for limit in SPACERS)
    devices = {("C1", 0.67, S_SHAPE): one, ("C1", 0.67, EITHER): two}
    curves = {("C1", 2.6 * UM, 20 * UM, EITHER): three}
    found = device_warnings.subjects(device_warnings.OfDevices(devices, curves, {"S1": four}))
    assert {str(subject): limits for subject, limits in found.items()} == {
        "C1, RH 0.67, held by the beam": one,
        "C1, RH 0.67, held by the beam or tip": two,
        "C1, chart, 2.6 µm thick, gap 20 µm, held by the beam or tip": three,
        "S1": four,
    }


def test_a_page_without_warnings_says_so():
    assert "No result is beyond the limits" in pages.as_markdown({pair_warnings.Subject("pair a"): []}, {})


#: Settings, and what is not in the results of devices with them.
IN_FORCE = [
    ({}, []),
    ({"contact": {"model": "summits"}}, ["interaction of neighbouring summits"]),
    ({"attraction": {"reach": "touching"}}, ["attraction of solids across gaps"]),
    ({"contact": {"model": "full"}}, []),
    ({"van_der_waals": "none"}, ["van der Waals attraction of solids"]),
]


@pytest.mark.parametrize(("changes", "left_out"), IN_FORCE)
def test_what_is_not_in_the_model_follows_from_the_settings_in_force(changes, left_out):
    devices = {"C1": {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}}
    devices["S1"] = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20}
    devices = {name: section | {"humidities": [0.55, 0.8]} for name, section in devices.items()}
    plan = Plan(load({"devices": devices, "design": {"worst_humidities": [0.5, 0.9]}}, changes))
    everything = {words for _, listed in IN_FORCE for words in listed}
    files = [
        "devices/C1.html",
        "devices/S1.html",
        "devices/warnings.md",
        "tables/safe_lengths.csv",
        "tables/stoppers.csv",
    ]
    for file in files:
        said = not_modelled(**Graph(plan).job(file).settings["not_modelled"])
        assert {words for words in everything if words in said} == set(left_out)
        assert "water" in said


def test_what_is_not_in_the_model_of_dry_devices_is_about_no_water():
    dry = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": ["dry"]}
    said = not_modelled(**Graph(Plan(load({"devices": {"S1": dry}}))).job("devices/S1.html").settings["not_modelled"])
    assert "water" not in said
    assert "across gaps" not in said
    assert "bending" not in said, "full elastic contact is the default there"


@pytest.mark.parametrize(
    ("model", "humidity", "bent"),
    [({"model": "summits"}, "dry", True), ({"model": "summits"}, 0.6, False), ({"model": "full"}, "dry", False)]
    + [({}, "dry", False), ({}, 0.6, False)],
)
def test_devices_in_dry_air_say_that_summits_leave_out_the_bending_of_surfaces(model, humidity, bent):
    pair = {"mine": {"beam": "B2", "substrate": "Sub1", "gap_um": 20, "humidities": ["dry", 0.6]}}
    lever = {"kind": "cantilever", "pair": "mine", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    devices = {"C1": lever | {"humidities": [humidity]}}
    study = {"run": {"pairs": ["mine"]}, "figures": {"humidity": 0.6}, "contact": model}
    config = load(study | {"pairs": pair, "devices": devices})
    left_out = Graph(Plan(config)).job("devices/C1.html").settings["not_modelled"]["left_out"]
    assert ("bent" in left_out) == bent
    assert ("summits" in left_out) == (humidity != "dry" and bool(model)), "full contact is the default"


def test_what_pairs_leave_out_is_named_with_those_of_the_paper():
    mine = {"beam": "B1", "substrate": "Sub1", "gap_um": 20, "humidities": [0.5]}
    said = Graph(Plan(load({"pairs": {"mine": mine}, "run": {"pairs": ["a", "mine"]}}))).job("warnings.md")
    assert "attraction of solids across gaps (pairs a)," in not_modelled(**said.settings["not_modelled"])


# Patches that count as flat surfaces


def test_patches_that_count_as_flat_surfaces_are_said_of_beams_and_stoppers(warned):
    found, of = device()
    (sentence,) = only(found.assign(share_flat=0.02), of)
    assert sentence.startswith("2 % of the patches of surface have too few summits to resist the adhesion.")
    assert warned({"S1": stopper()}, share_flat=0.02).patches["S1"] == [sentence]
    assert warned({"S1": stopper()}).patches["S1"] == []


# Strips that are too long


BRIDGE = safe_without_tips(), device_warnings.OfDevice(R1)


@pytest.mark.parametrize(("found", "of", "side"), [(*device(), "is the safe side"), (*BRIDGE, "off to either side")])
def test_strips_that_are_too_long_are_said_of_lengths(found, of, side):
    def said(longest):
        every = about_device(found.assign(longest_strip=longest), of)
        return [sentence for sentences in every.values() for sentence in sentences if sentence.startswith("Strips of")]

    sentences = said(of.device.strip / 1.2)
    assert len(sentences) == len(of.device.opening.shapes)
    assert all(f"{1e6 * of.device.strip / 1.2:.3g} µm that resolve" in one and side in one for one in sentences)
    assert said(of.device.strip) == []


def test_strips_that_are_too_long_for_one_size_are_said_of_its_curves():
    along = [charted(800 * UM), charted(700 * UM, longest_strip=1.4), charted(600 * UM)]
    found = about_curves(along, device_warnings.OfDevice(C1))
    said = {curve for curve, sentences in found.items() if any("longer than the 1.4 µm" in one for one in sentences)}
    assert said == {(2 * UM, 20 * UM, S_SHAPE), (2 * UM, 20 * UM, EITHER)}


def test_strips_that_are_too_long_are_said_of_pairs():
    (sentence,) = about_beams(beams(50, 0).assign(longest_strip=1.4 * UM), PAPER, 1.5 * UM)
    assert sentence.startswith("Strips of 1.5 µm are longer than the 1.4 µm that resolve the cracks")
    assert about_beams(beams(50, 0).assign(longest_strip=1.6 * UM), PAPER, 1.5 * UM) == []
