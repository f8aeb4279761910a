"""Declarations: names of files, settings that follow from the fields of a dataclass."""

from dataclasses import dataclass, field, replace

import pytest

from stiction.plan.stage import WILDCARDS, At, Stage, expression, select, subsection


@dataclass(frozen=True)
class Beam:
    thickness: float
    samples: int | None = None


@dataclass(frozen=True)
class Settings:
    seed: int
    beam: Beam
    pairs: dict[str, Beam]
    scatter: float = 0.0
    other: Beam | None = None
    more: dict = field(default_factory=dict)


CONFIG = {
    "seed": 1,
    "beam": {"thickness_um": 2.6, "width_um": 30},
    "pairs": {"a": {"thickness_um": 1, "gap_um": 20}, "b": {"thickness_um": 2, "samples": 3}},
    "water": {"temperature_K": 300},
}


def test_settings_are_exactly_the_fields_of_their_class_at_every_level():
    assert select(Settings, CONFIG) == {
        "seed": 1,
        "beam": {"thickness_um": 2.6},
        "pairs": {"a": {"thickness_um": 1}, "b": {"thickness_um": 2, "samples": 3}},
    }


def test_what_is_given_replaces_the_section_and_may_have_fields_that_it_lacks():
    settings = select(Settings, CONFIG | {"other": {"thickness_um": 5, "width_um": 1}}, seed=2, scatter=0.1)
    assert (settings["seed"], settings["scatter"], settings["other"]) == (2, 0.1, {"thickness_um": 5})


def test_a_missing_key_is_reported_by_the_field_that_needs_it():
    with pytest.raises(KeyError, match="Settings.seed"):
        select(Settings, subsection(CONFIG, ["beam", "pairs"]))


def test_settings_are_converted_to_the_class_and_stay_plain_without_one():
    stage = Stage.writing("one", "one", message="", compute=lambda data, at, settings: settings, kind=Beam)
    assert stage.converted({"thickness_um": 2}).thickness == pytest.approx(2e-6)
    plain = Stage.writing("one", "one", message="", compute=lambda data, at, settings: settings)
    assert plain.converted({"thickness_um": 2}) == {"thickness_um": 2}


def test_a_computation_takes_the_inputs_wildcards_and_settings_that_its_parameters_name():
    def compute(forces, model, settings, fit="no fit"):
        return forces, model, settings, fit

    def of_all(data, at):
        return data, at

    stage = Stage.writing("one", "one_{model}", message="", compute=compute)
    data, at, own = {"forces": 1, "unused": 2}, At(model="NG", case="b_rh067"), {"seed": 3}
    assert stage.result(data, at, own) == (1, "NG", own, "no fit")
    assert stage.result(data | {"fit": 4}, at, own) == (1, "NG", own, 4)
    assert replace(stage, compute=of_all).result(data, at, own) == (data, at)
    with pytest.raises(TypeError, match="forces"):
        stage.result({}, at, own)


def test_a_computation_takes_single_settings_unless_a_class_has_them():
    def compute(forces, seed=0):
        return forces, seed

    stage = Stage.writing("one", "one", message="", compute=compute)
    data, at = {"forces": 1}, At()
    assert stage.result(data, at, {"seed": 3}) == (1, 3)
    assert stage.result(data | {"seed": 4}, at, {"seed": 3}) == (1, 4)
    assert stage.result(data, at, None) == (1, 0)
    assert replace(stage, kind=Beam).result(data, at, Beam(3)) == (1, 0)


@pytest.mark.parametrize(
    ("pattern", "name", "values"),
    [
        ("beams/{case}_{model}", "beams/b_rh067_GEO", {"case": "b_rh067", "model": "GEO"}),
        ("studies/variants/{case}_{variant}", "studies/variants/b_rh067_poisson_ratio_0.28", None),
        ("beams/{case}_{model}", "beams/b_rh67_GEO", {}),
        ("scan/{surface}_{number}", "scan/A.B_0", {}),
    ],
)
def test_a_name_matches_its_pattern_alone(pattern, name, values):
    found = expression(pattern, WILDCARDS).fullmatch(name)
    assert (found.groupdict() if found else {}) == (values if values is not None else found.groupdict())
    if found:
        assert pattern.format(**vars(At(**found.groupdict()))) == name


def test_the_data_of_the_inputs_complete_the_settings_of_a_computation():
    def compute(forces, settings):
        return forces, settings

    stage = Stage.writing(
        "one", "one", message="", complete=lambda settings, data: settings | data["error"], compute=compute
    )
    assert stage.result({"forces": 1, "error": {"b": 2}}, At(), {"a": 1}) == (1, {"a": 1, "b": 2})


def test_a_stage_with_ends_writes_one_dataset_for_each():
    stage = Stage.writing(
        "two", "two/{pair}_{each}", message="", compute=lambda data, at, settings: [], each=lambda plan: plan
    )
    assert stage.patterns(["less", "more"]) == {"less": "two/{pair}_less", "more": "two/{pair}_more"}
    assert stage.log == "two/{pair}"
