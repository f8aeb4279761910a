"""The grid of a configuration follows its surfaces, unless the configuration states it."""

import numpy as np
import pytest
import yaml
from configurations import ROOT, problems

from stiction.config import memory
from stiction.config.files import load, paper
from stiction.config.keys import Keys, Relations
from stiction.config.merging import merged
from stiction.config.reading import read
from stiction.config.relations import strips_fit_into_memory
from stiction.config.surfaces.grid import completed, published_correlation

#: Grid of the paper.
PAPER = {"spacing_nm": 10, "margin_um": 1, "strip_length_um": 1.5}
BASE = read(ROOT / "config.yaml")


def b2(corner=12.0, cutoff=125.0, slope=-4.6):
    """Section of the surface of pair b with another spectrum [rad/µm]."""
    psd = {"plateau_nm4": 1.0, "floor_nm4": (cutoff / corner) ** slope}
    return {"surfaces": {"B2": {"published_psd": psd | {"corner_rad_per_um": corner, "cutoff_rad_per_um": cutoff}}}}


def sampling(*changes, estimates=()):
    config = BASE
    for change in changes:
        config = merged(config, change)
    return completed(config, dict(estimates))["sampling"]


def test_surfaces_of_the_paper_have_its_grid():
    assert load()["sampling"] == paper()["sampling"] == PAPER
    assert completed(BASE, {})["studies"] == BASE["studies"]


@pytest.mark.parametrize("cutoff", [100.0, 314.159, 314.2, 500.0, 1608.5, 2000.0])
def test_the_grid_carries_every_spectrum_with_no_more_points_than_needed(cutoff):
    spacing = sampling({"run": {"pairs": ["b"]}}, b2(12.0, cutoff))["spacing_nm"]
    parts = 10 / spacing
    assert parts == pytest.approx(round(parts))
    assert cutoff <= 1.000001 * 1e3 * np.pi / spacing
    assert spacing == 10 or cutoff > 1e3 * np.pi * (parts - 1) / 10


@pytest.mark.parametrize("cutoff", [1e6, 1e30])
def test_a_grid_that_does_not_fit_into_memory_is_as_fine_as_fits(cutoff):
    spacing = sampling({"run": {"pairs": ["b"]}}, b2(cutoff=cutoff))["spacing_nm"]
    field = memory.FIELD_UM, memory.FIELD_UM
    assert (
        memory.field_memory(*field, spacing)
        <= memory.LARGEST / 2
        < memory.field_memory(*field, 10 / (10 / spacing + 1))
    )


@pytest.mark.parametrize("corner", [0.5, 2.0, 12.0, 50.0])
def test_the_margin_exceeds_the_correlation_length_by_half_a_micrometre_at_most(corner):
    found = sampling({"run": {"pairs": ["b"]}}, b2(corner))["margin_um"]
    length = published_correlation(**b2(corner)["surfaces"]["B2"]["published_psd"])
    assert max(1, length) <= found <= max(1, length + 0.5)
    assert (found > 1) == (corner < 10)


@pytest.mark.parametrize(
    ("more", "finer"),
    [
        ("run: {pairs: [b]}", True),
        ("run: {pairs: [a]}", False),
        ("run: {pairs: []}", False),
        ("run: {pairs: []}\ndevices: {C1: {kind: bridge, pair: b, width_um: 1}}", True),
        ("run: {pairs: []}\ntest_beams: {T1: {pair: b}}", True),
        ("run: {pairs: []}\ndevices: {C1: {kind: bridge, pair: a, width_um: 1}}", False),
    ],
)
def test_surfaces_count_that_are_drawn(more, finer):
    found = sampling(b2(cutoff=500.0), yaml.safe_load(more))
    assert (found["spacing_nm"] == 5) == finer


def test_what_is_stated_stays():
    found = sampling(b2(0.5, 900.0), {"run": {"pairs": ["b"]}, "sampling": {"spacing_nm": 8, "margin_um": 0.7}})
    assert found == {"spacing_nm": 8, "margin_um": 0.7, "strip_length_um": 1.504}  # 188 points, where none is stated
    one = sampling(b2(0.5, 900.0), {"run": {"pairs": ["b"]}, "sampling": {"spacing_nm": 8}})
    assert one["spacing_nm"] == 8
    assert one["margin_um"] > 1


def test_variants_have_finer_grids_than_that_of_the_surfaces():
    changes = {"run": {"pairs": ["b"]}, "studies": {"variants": {"spacing_nm": [5, 2]}}}
    config = completed(merged(merged(BASE, b2(cutoff=500.0)), changes), {})
    assert config["studies"]["variants"]["spacing_nm"] == [2]
    assert problems(config) == ()


@pytest.mark.parametrize(("corner", "left"), [(12.0, [5]), (0.1, []), (0.5, [5])])
def test_variants_whose_fields_do_not_fit_into_memory_with_a_longer_margin_are_left_out(corner, left):
    lever = {"kind": "cantilever", "pair": "b", "width_um": 30}
    wide = {"run": {"pairs": []}, "devices": {"C1": lever}, "beam": {"width_um": 30}}
    config = completed(merged(merged(BASE, b2(corner)), wide), {})
    assert config["studies"]["variants"]["spacing_nm"] == left


LEVER = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}


@pytest.mark.parametrize(
    "users", [{"run": {"pairs": ["b"]}}, {"run": {"pairs": []}}, {"run": {"pairs": ["b"]}, "beam": {"width_um": 40}}]
)
def test_waves_too_long_for_the_memory_are_refused_once_and_as_those_of_their_surface(users):
    """The margin of pairs and devices follows from the waves. Nobody stated it, so that its refusal helps nobody."""
    spectrum = b2(corner=0.05, cutoff=1.0)["surfaces"]["B2"]["published_psd"]
    changes = {"surfaces": {"B2": {"published_psd": spectrum}}, "devices": {"C1": LEVER}}
    found = [line for line in problems(completed(merged(merged(BASE, changes), users), {})) if "memory" in line]
    assert len(found) == 1
    assert found[0].startswith("surfaces.B2.published_psd.corner_rad_per_um is 0.05, must leave fields within 8 GB")
    length = published_correlation(**spectrum)
    assert f"heights correlate over {length:.3g} µm" in found[0]
    wide = problems(merged(merged(BASE, users), {"run": {"pairs": []}, "devices": {"C1": LEVER | {"width_um": 9000}}}))
    assert [line.split(" is ")[0] for line in wide] == ["devices.C1.width_um"], "a field too large without any wave"


def test_waves_of_scans_too_long_for_the_memory_are_refused_as_those_of_their_files():
    spectrum = b2()["surfaces"]["B2"]["published_psd"]
    described = {"published_psd": spectrum, "correlation_um": 124.0}
    config = merged(BASE, {"surfaces": {"B2": described}, "sampling": PAPER | {"margin_um": 124.5}})
    ((path, text),) = strips(Keys(config, {"B2": ["scans/a.sur"]}))
    assert path == ("surfaces", "B2", "scans", "files")
    assert text.startswith("is ['a.sur'], which gives correlation_um = 124, must leave fields within 8 GB of memory")
    short = merged(config, {"surfaces": {"B2": {"correlation_um": 2.0}}})
    ((path, _),) = strips(Keys(short, {"B2": ["scans/a.sur"]}))
    assert path == ("sampling", "spacing_nm"), "a stated margin"


def strips(keys):
    """Paths and messages of the problems of strips with the memory of a job."""
    found = Relations([strips_fit_into_memory]).problems(keys)
    return dict.fromkeys((problem.path, problem.message) for problem in found if problem.path[0] != "studies")


def test_a_measured_surface_counts_up_to_the_end_of_its_spectrum():
    mine = {"surfaces": {"Mine": {"scans": {"files": ["a.gwy"]}}}, "run": {"pairs": []}}
    mine |= {"pairs": {"m": {"beam": "Mine", "substrate": "Sub1"}}}
    mine |= {"devices": {"C1": {"kind": "bridge", "pair": "m", "width_um": 1}}}
    numbers = {
        "measured": [0.0, 3.0],
        "feasible": [0.0, 3.0],
        "end_rad_per_um": 1608.0,
        "correlation_um": {"fitted": 3.2, "tabulated": 7.1},
    }
    found = sampling(mine, estimates={"Mine": numbers}.items())
    assert found["spacing_nm"] == pytest.approx(10 / 6)
    assert found["margin_um"] == 3.5
    tabulated = merged(mine, {"surfaces": {"Mine": {"psd": "tabulated"}}})
    assert sampling(tabulated, estimates={"Mine": numbers}.items())["margin_um"] == 7.5


@pytest.mark.parametrize(
    "unused",
    [
        "character: {spacing_nm: 25}",
        "character: {spacing_nm: 510}",
        "beam: {width_um: 30.005}",
        "beam: {elements: 333, length_um: 1501}",
        "identification: {patch_um: 0.755}",
        "studies: {mesh: {elements_um: [7]}}",
        "surfaces: {B2: {published_psd: {cutoff_rad_per_um: 900}}}",
    ],
)
def test_studies_that_do_not_run_refuse_nothing(unused):
    stopper = {"kind": "stopper", "pair": "a", "contact_um": [4, 4], "restoring_force_uN": 5, "humidities": [0.6]}
    alone = merged(completed(BASE, {}), {"run": {"pairs": []}, "devices": {"S1": stopper}})
    config = merged(alone, yaml.safe_load(unused))
    assert problems(config) == ()
    assert problems(merged(config, {"run": {"pairs": ["a", "b"]}})) != (), "control"
