"""Relations between keys: violations are reported with all values; values at the limit of a relation are valid."""

import copy
import re

import pytest
import yaml
from configurations import LEAVES, NUMBERS, PAPER, ROOT, SCHEMA, changed, problems, without
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from wrong_configurations import STOPPER, WRONG_RELATIONS

from stiction.chaos.model import MAX_ORDER
from stiction.config import meetings, validation
from stiction.config.keys import Keys, Unknown
from stiction.config.merging import merged

FUZZ = settings(max_examples=250, suppress_health_check=[HealthCheck.too_slow])


def test_the_case_study_of_the_paper_is_valid():
    assert problems(PAPER) == ()


@pytest.mark.parametrize(
    ("overlay", "key", "value", "message"), WRONG_RELATIONS, ids=[f"{row[1]}={row[2]}" for row in WRONG_RELATIONS]
)
def test_a_violated_relation_is_rejected_in_one_line_with_key_value_and_what_is_allowed(overlay, key, value, message):
    (line,) = problems(changed(overlay))
    assert line.startswith(f"{key} is {value}, must ")
    assert message in line


@pytest.mark.parametrize(
    "overlay",
    [
        (ROOT / "workflow/smoke.yaml").read_text(encoding="utf-8"),
        "surfaces: {Mine: {rms_nm: 2, skewness: -0.5, kurtosis: 3.5, psd: identified, mean_summit_radius_um: 0.5, "
        "summit_density_per_um2: 30}}\npairs: {d: {beam: Mine, substrate: Sub2, gap_um: 3.5, humidities: [0.675]}}\n"
        "run: {pairs: [d]}",
        "surfaces: {B1: {skewness: 0, kurtosis: 3}}",
        "surfaces: {B1: {skewness: 0, kurtosis: 2}}",
        "surfaces: {B1: {kurtosis: 1.7, rms_nm: 10}}",
        "surfaces: {B1: {psd: identified}}",
        "surfaces: {B1: {published_psd: {cutoff_rad_per_um: 314.159}}}",
        "surfaces: {B1: {published_psd: {corner_rad_per_um: 137.9, floor_nm4: 524}}}",
        "sampling: {margin_um: 0.9}",
        "sampling: {strip_length_um: 1.25}\nstudies: {variants: {every: []}}",
        "sampling: {spacing_nm: 5}",
        "character: {spacing_nm: 10}",
        "character: {spacing_nm: 500}",
        "identification: {patch_um: 0.9}",
        "contact: {every: 2}",
        "studies: {variants: {every: [3, 10], spacing_nm: [7.5, 11.71875]}}",
        "studies: {variants: {every: [], spacing_nm: []}}",
        "studies: {mesh: {elements_um: [7, 30], strips_um: [4, 3]}}",
        "contact: {chunks: 5000}",
        "contact: {samples: 1820}",
        "chaos: {order: 1}",
        "beam: {elements: 1000}",
        "beam: {scatter: 0}",
        "beam: {length_um: 21, width_um: 20.98, elements: 7}",
        "pairs: {a: {humidities: [0.2903, 0.998, 0.5]}}",
        "pairs: {b: {gap_um: 0.318}}",
        "solid: {poisson_ratio: -0.99}",
        "surfaces: {B2: {rms_nm: 30}}",
        "pairs: {c: {gap_um: 0.01}}\nrun: {pairs: [a, b]}",
        "figures: {humidity: 0.9902}\nrun: {pairs: [a, b]}",
        "beam: {thickness_um: 1.5}",
        "surfaces: {B1: {skewness: -0.1, kurtosis: 3.05}}",
        pytest.param(
            "surfaces: {B1: {skewness: -0.5, kurtosis: 4}, Sub1: {skewness: 1.0e-9, kurtosis: 3}}",
            marks=pytest.mark.slow,
        ),
        "pairs: {a: {substrate: B1}}",
        "van_der_waals: none",
        "run: {pairs: [c, a]}",
        "run: {studies: []}\nstudies: {mesh: {elements_um: [7]}}",
        f"run: {{pairs: []}}\ncontact: {{samples: 100}}\ndevices: {{S1: {STOPPER}}}",
    ],
)
def test_values_at_the_limit_of_a_relation_are_valid(overlay):
    assert problems(changed(overlay)) == ()


#: Wrong keys of one configuration, each with another value, by the steps of its check: form, names, values.
STEPS = [
    {
        "surfaces.B1.rms_nm": "surfaces: {B1: {rms_nm: -1}}",
        "pairs.a.gap": "pairs: {a: {gap: 3}}",
        "contact.chunks": "contact: {chunks: 1.0}",
        "chaos.order": "chaos: {order: 20}",
    },
    {"pairs.a.beam": "pairs: {a: {beam: B9}}", "figures.pair": "figures: {pair: d}"},
    {
        "surfaces.B2.kurtosis": "surfaces: {B2: {kurtosis: 1.5}}",
        "pairs.b.humidities": "pairs: {b: {humidities: [0.5, 0.5]}}",
    },
]


@pytest.mark.parametrize("step", range(len(STEPS)))
def test_all_problems_of_a_step_are_found_at_once_and_each_only_once(step):
    """Those of later steps appear when they are corrected."""
    config = PAPER
    for wrong in STEPS[step:]:
        for overlay in wrong.values():
            config = merged(config, yaml.safe_load(overlay))
    lines = problems(config)
    assert sorted(line.split()[0] for line in lines) == sorted(STEPS[step])


def violated(config, files):
    """Violated relations of a configuration whose measured surfaces have these files."""
    return list(map(str, validation.RELATIONS.problems(Keys(validation._OPTIONAL | config, files))))


def test_a_problem_of_a_device_or_a_pair_names_the_files_of_its_own_surfaces():
    files = {name: [f"{name}.spm"] for name in ("B1", "B2", "Sub1")}
    device = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 0.1, "width_um": 30, "strip_um": 1.5}
    near = {"devices": {"B1": device | {"humidities": [0.6]}}, "pairs": {"b": {"gap_um": 0.1}}}
    for key in ("devices.B1.gap_um", "pairs.b.gap_um"):
        lines = [line for line in violated(merged(PAPER, near), files) if line.startswith(f"{key} is 0.1, must be at")]
        assert lines
        assert all("surfaces.B2.scans.files = ['B2.spm'], surfaces.Sub1.scans" in line for line in lines)
        assert not any("B1.spm" in line for line in lines)


def test_a_key_that_is_not_given_is_unknown():
    config = Keys({"pairs": {"a": {"gap_um": 20}, "b": {"gaps_um": [1, 2]}}, "seed": 1})
    assert config["pairs.a.gap_um"] == 20
    assert config["pairs.b.gaps_um.1"] == 2
    for key in ("pairs.b.gap_um", "pairs.c", "seed.a", "pairs.a.gap_um.0", "pairs.b.gaps_um.2"):
        with pytest.raises(Unknown):
            config[key]
    assert config.names("pairs") == ["a", "b"]
    assert list(config.entries("pairs", "gap_um")) == [("a", 20)]
    assert list(config.items("pairs.b.gaps_um")) == [("pairs.b.gaps_um.0", 1), ("pairs.b.gaps_um.1", 2)]
    assert list(config.given_items("seed", "sead")) == [("seed", 1)]


def test_numbers_of_measured_surfaces_are_named_by_their_files():
    files = {"B2": ["folder/a.spm", "folder/b.spm"], "B1": ["c.spm"]}
    overlay = "surfaces: {B2: {kurtosis: 1.2}}\nsampling: {margin_um: 0.1}\npairs: {b: {gap_um: 0.1}}"
    lines = violated(changed(overlay), files)
    shown = "surfaces.B2.scans.files = ['a.spm', 'b.spm']"
    (kurtosis,) = [line for line in lines if "skewness²" in line]
    assert kurtosis == (
        "surfaces.B2.scans.files is ['a.spm', 'b.spm'], which gives kurtosis = 1.2, must be above skewness² + 1 = "
        f"1.5776 (given {shown})"
    )
    (gap,) = [line for line in lines if line.startswith("pairs.b.gap_um is 0.1, must be at least")]
    assert gap.endswith(f"{shown})")
    assert [
        line for line in lines if line.startswith("sampling.margin_um is 0.1") and line.endswith(f"(given {shown})")
    ]
    others = [line for line in lines if "surfaces.Sub1.published_psd = {" in line]
    assert others
    assert not any(shown in line for line in others)


def test_two_missing_keys_are_named_once_each():
    config = without(("beam", "width_um"))
    del config["beam"]["samples"]
    (line,) = problems(config)
    assert line.startswith("beam.width_um is missing")
    assert line.endswith("; samples is missing as well")


@pytest.mark.parametrize("overlay", ["beam: 5", "surfaces: {B1: {published_psd: {plateau_nm4: x}}}", "pairs: {a: 1}"])
def test_no_relation_is_checked_for_a_key_that_is_invalid_or_inside_an_invalid_section(overlay):
    assert len(problems(changed(overlay))) == 1


def test_references_are_checked_against_all_entries():
    lines = problems(changed("pairs: {a: {beam: B9}}\nfigures: {pair: d}"))
    assert "figures.pair is 'd', must be one of a, b, c" in lines
    assert "pairs.a.beam is 'B9', must be one of B1, B2, Sub1, Sub2" in lines


def test_an_identified_spectrum_needs_its_targets_and_a_published_one_its_parameters():
    identified = without(("surfaces", "B1", "mean_summit_radius_um"))
    identified["surfaces"]["B1"]["psd"] = "identified"
    (line,) = problems(identified)
    assert line.startswith("surfaces.B1.mean_summit_radius_um is missing")
    (line,) = problems(without(("surfaces", "B1", "published_psd")))
    assert line.startswith("surfaces.B1.published_psd is missing")


def test_the_highest_order_is_that_of_the_chaos_model():
    assert SCHEMA["properties"]["chaos"]["properties"]["order"]["maximum"] == MAX_ORDER


def within(entry):
    """Values that the schema allows."""
    if "enum" in entry:
        return st.sampled_from(entry["enum"])
    if entry["type"] == "integer":
        return st.integers(entry["minimum"], entry["maximum"])
    return st.floats(
        entry.get("minimum", entry.get("exclusiveMinimum")),
        entry.get("maximum", entry.get("exclusiveMaximum")),
        exclude_min="exclusiveMinimum" in entry,
        exclude_max="exclusiveMaximum" in entry,
    )


SCALARS = NUMBERS + [leaf for leaf in LEAVES if "enum" in leaf.entry]


@pytest.mark.slow
@FUZZ
@given(
    st.lists(
        st.sampled_from(SCALARS).flatmap(lambda leaf: st.tuples(st.just(leaf.path), within(leaf.entry))), max_size=8
    )
)
def test_values_within_the_schema_can_only_violate_relations(values):
    config = copy.deepcopy(PAPER)
    for path, value in values:
        section = config
        for key in path[:-1]:
            section = section[key]
        section[path[-1]] = value
    for line in problems(config):
        assert re.match(r"[\w.\[\]]+ is .*, must ", line)
        assert not any(leaf.entry["description"] in line for leaf in SCALARS)


@pytest.mark.parametrize(("more", "wet"), [(0, True), (4.9, True), (5.1, False)])
def test_water_condenses_up_to_contact_angles_that_add_up_to_180_degrees(more, wet):
    angles = {"One": {"contact_angle_deg": 100}, "Other": {"contact_angle_deg": 70}}
    surfaces = {name: {"rms_nm": 1, "material": name} for name in angles}
    pairs = {"d": {"beam": "One", "substrate": "Other"}}
    config = Keys({"run": {"pairs": ["d"]}, "pairs": pairs, "surfaces": surfaces, "materials": angles})
    (meeting,) = meetings.pair_meetings(config)
    assert bool(meeting.wetting(more)) == wet


def test_adsorbed_water_is_part_of_the_film_that_a_gap_must_exceed():
    narrow = {"run": {"pairs": ["b"]}, "pairs": {"b": {"gap_um": 0.35}}}
    assert not problems(merged(PAPER, narrow))
    lines = problems(merged(PAPER, narrow | {"water": {"adsorbed_nm": 4}}))
    (line,) = [one for one in lines if one.startswith("pairs.b.gap_um")]
    assert "is 0.35, must be at least 0.3973 µm, 20 times the sum of the height of the water film, 16.463 nm" in line
    assert "water.adsorbed_nm = 4" in line


def test_a_gap_is_refused_once_in_the_air_that_needs_the_largest():
    for narrow, airs in ({"gap_um": 0.1}, "humidities"), ({"gap_um": 0.1, "humidities": [0.3]}, "figures.humidity"):
        study = {"run": {"pairs": ["b"]}, "pairs": {"b": narrow}, "figures": {"humidity": 0.66}}
        lines = problems(merged(PAPER, study))
        (line,) = [one for one in lines if one.startswith("pairs.b.gap_um") and "water film" in one]
        assert f"{airs} = " in line


def test_grids_of_variants_need_memory_only_where_variants_run():
    wide = {"beam": {"width_um": 250}, "sampling": {"strip_length_um": 15}}
    fine = {"studies": {"variants": {"spacing_nm": [2.5], "every": []}}}
    refused = {
        studies: any(
            line.startswith("studies.variants") for line in problems(merged(PAPER, wide | fine | {"run": run}))
        )
        for studies, run in {"some": {"studies": ["variants"]}, "none": {"studies": []}}.items()
    }
    assert refused == {"some": True, "none": False}


@pytest.mark.parametrize("value", [-0.1, 5.1, "thick", None, [0.5]])
@pytest.mark.parametrize("key", ["water.adsorbed_nm", "devices.C1.uncertainty.adsorbed_nm"])
def test_a_height_of_adsorbed_water_that_no_surface_has_is_refused_in_one_sentence(key, value):
    device = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    overlay = {"devices": {"C1": device | {"humidities": [0.67], "uncertainty": {}}}, "water": {}}
    section = overlay
    for name in key.split(".")[:-1]:
        section = section[name]
    section["adsorbed_nm"] = value
    (line,) = problems(merged(PAPER, overlay))
    assert line.startswith(f"{key} is ")
    assert "must be a number at least 0 and at most 5" in line
