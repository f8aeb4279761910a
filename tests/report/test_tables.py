"""Tables from datasets with known numbers."""

from pathlib import Path
from unittest.mock import patch

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hostile import HOSTILE, HOSTILE_FILE, Reading
from noted import noted
from numpy.testing import assert_allclose

from stiction.models import surface_model
from stiction.plan.stage import At
from stiction.report import checks, published
from stiction.report import table as tables
from stiction.report.beams import tables as tables_beams
from stiction.report.limits import pages
from stiction.report.studies import tables as tables_studies
from stiction.report.surfaces import tables as tables_surfaces
from stiction.run.markdown import plain
from stiction.stages.beams.pair_warnings import Subject
from stiction.stages.contact import pair_model_error
from stiction.stages.laws import forces as stage_forces

RESOURCES = Path(published.__file__).with_name("resources")
PUBLISHED = published.read(RESOURCES / "table_3.csv")
LENGTHS = np.array([600e-6, 640e-6, 1500e-6])
ENERGIES = np.array([8e-3, 10e-3, 9e-3, 13e-3])


def beams(*states):
    return xr.Dataset(
        {
            "state": ("beam", np.array(states)),
            "crack_length": ("beam", LENGTHS),
            "apparent_energy": ("beam", 1.0 / LENGTHS),
        }
    )


def forces(spread=1.0, weak=False):
    """Samples; if ``weak``, the first one has no force law: 0.5 f_max / a_left is more than its energy."""
    mean = ENERGIES.mean()
    pull_off = np.full(len(ENERGIES), 1e6) * np.where(np.arange(len(ENERGIES)) == 0, 100.0 if weak else 1.0, 1.0)
    v = [mean + spread * (ENERGIES - mean), pull_off, np.full(len(ENERGIES), 8e-9), np.full(len(ENERGIES), 6.5e-9)]
    return stage_forces.layout(np.column_stack(v), 1e8, np.arange(3.0), np.zeros((1, 3)))


def row(model="NG", spread=1.0, states=(0, 0, 1), pair="a"):
    key = (pair, 0.45, model)
    return tables_beams.table_3(
        {key: beams(*states)}, {(pair, 0.45, surface_model(model)): forces(spread)}, PUBLISHED
    ).frame.iloc[0]


def test_averages_are_those_of_s_shaped_beams_and_shares_of_all():
    found = row()
    assert_allclose(found.crack_length_um, 620)
    assert_allclose(found.crack_length_std_um, 40 / np.sqrt(2))
    assert_allclose((found.share_s_shape, found.share_arc, found.share_free), (2 / 3, 1 / 3, 0))
    assert_allclose(found.meso_energy_J_per_m2, ENERGIES.mean())
    assert_allclose(found.meso_energy_cv, ENERGIES.std(ddof=1) / ENERGIES.mean())


def test_energies_without_a_force_law_are_reported_separately():
    key = ("a", 0.45, "G")
    table = tables_beams.table_3({key: beams(0, 0, 1)}, {key: forces(weak=True)}, PUBLISHED).frame
    assert_allclose(table.share_without_law, 1 / 4)
    assert_allclose(table.meso_energy_J_per_m2, ENERGIES.mean())
    assert_allclose(table.meso_energy_lawful_J_per_m2, ENERGIES[1:].mean())
    assert row().share_without_law == 0


def test_the_error_of_the_model_stands_beside_all_but_gaussian_surfaces():
    known = {name: (np.array([1.1, 1.05]), np.array([0.01, 0.02])) for name in ("energy_ratio", "length_factor")}
    errors = {"a": pair_model_error.layout(known, np.array([0.45, 0.6]), [0.45], 20)}
    keys = [("a", humidity, model) for humidity in (0.45, 0.6) for model in ("NG", "G")]
    given = {key: beams(0, 0, 1) for key in keys}, {key: forces() for key in keys}, PUBLISHED
    table, plain = tables_beams.table_3(*given, errors=errors), tables_beams.table_3(*given)
    assert table.cells["model error [%]"].tolist() == ["+10.0 ± 1.0", "–", "+5.0 ± 2.0 *", "–"]
    assert table.frame[list(plain.frame)].equals(plain.frame)
    assert "model error [%]" not in plain.cells
    assert table.caption.startswith(plain.caption)
    assert "is part of no standard error" in table.caption


def test_a_small_share_of_beams_is_not_rounded_to_zero():
    key = ("b", 0.55, "G")
    few = xr.Dataset(
        {
            "state": ("beam", [0] + 199 * [1]),
            "crack_length": ("beam", np.full(200, 1e-3)),
            "apparent_energy": ("beam", np.full(200, 1e-3)),
        }
    )
    assert " 0.5/99.5/0 |" in tables_beams.table_3({key: few}, {key: forces()}, PUBLISHED).markdown


def test_standard_errors_are_those_of_beams_and_of_the_pairs_that_they_share():
    pairs = row().meso_energy_se_J_per_m2 / row().meso_energy_J_per_m2
    assert_allclose(row(spread=0).crack_length_se_um, 20)
    assert_allclose(row().crack_length_se_um, np.hypot(20, 620 * pairs / 4))
    own = row(spread=0).adhesion_energy_se_J_per_m2
    assert_allclose(row().adhesion_energy_se_J_per_m2, np.hypot(own, row().adhesion_energy_J_per_m2 * pairs))


@pytest.mark.parametrize(("model", "known", "bias"), [("NG", 716, 0.4), ("GEO", 715, None), ("G", None, None)])
def test_each_model_is_compared_with_its_own_published_values_and_all_with_the_experiment(model, known, bias):
    found = row(model)
    assert_allclose(found.deviation_percent, 100 * (620 / known - 1) if known else np.nan)
    assert_allclose(found.experiment_deviation_percent, 100 * (620 / 718 - 1))
    assert_allclose(found.published_bias_error_percent, bias or np.nan)


def test_a_pair_of_the_user_has_no_published_values():
    found = row(pair="mine")
    assert np.isnan([found.published_um, found.experiment_um, found.deviation_percent]).all()
    assert_allclose(found.crack_length_um, 620)


def test_beams_that_do_not_stick_have_no_crack_length():
    found = row(states=(1, 1, 2))
    assert np.isnan([found.crack_length_um, found.crack_length_se_um, found.adhesion_energy_J_per_m2]).all()
    key = ("a", 0.45, "G")
    text = tables_beams.table_3({key: beams(1, 1, 2)}, {key: forces()}, PUBLISHED).markdown
    assert "±" not in text.splitlines()[-1].split("|")[4]
    assert "0/66.7/33.3" in text


def test_published_bias_error_is_the_deviation_of_the_published_model_from_experiment():
    bias = 100 * np.abs(PUBLISHED.ng / PUBLISHED.experiment - 1)
    assert_allclose(PUBLISHED.bias_error_percent, bias, atol=0.7)


def spectra(corner):
    """Stages identification and spectrum, with the parameters of B1 but for the corner, and a spectrum as published."""
    shape = {"plateau": 525e-36, "floor": 0.8e-36, "corner": corner, "cutoff": 138e6}
    known = {"mean_radius": 0.42e-6, "summit_density": 67e12, "mean_radius_error": 4e-9, "summit_density_error": 1e12}
    targets = {"target_mean_radius": 0.4e-6, "target_summit_density": 68e12, "target_rms": 1.7e-9}
    found = xr.Dataset({name: ((), value) for name, value in (shape | known | targets).items()})
    used = xr.Dataset({name: ((), value) for name, value in (shape | {"corner": 32e6, "defect": 0.01}).items()})
    return {"B1": found}, {"B1": used}


def table_2(corner, source):
    return tables_surfaces.table_2(*spectra(corner), published.read(RESOURCES / "table_2.csv"), {"B1": source})


def test_identified_parameters_are_listed_with_the_published_and_with_their_residuals():
    known, identified = (row for _, row in table_2(33e6, "published").frame.iterrows())
    assert_allclose(known.rms_residual_percent, 100 * (1.743 / 1.7 - 1), atol=0.1)  # 1.743 nm by the formula of m₂
    assert_allclose(identified.corner_rad_per_um, 33)
    assert_allclose((identified.radius_residual_percent, identified.radius_residual_se_percent), (5, 1))
    assert_allclose(identified.density_residual_percent, 100 * (67 / 68 - 1))


@pytest.mark.parametrize(("source", "defects"), [("published", [1, np.nan]), ("identified", [np.nan, 1])])
@pytest.mark.parametrize("corner", [32e6, 33e6])
def test_defect_is_that_of_the_spectrum_in_use(source, defects, corner):
    table = table_2(corner, source)
    assert_allclose(table.frame.gaussian_defect_percent, defects)
    assert "nan" not in table.markdown


def test_a_surface_of_the_user_has_identified_parameters_only():
    known = published.rows_of_paper(published.read(RESOURCES / "table_2.csv"), ["B2"])
    table = tables_surfaces.table_2(*spectra(33e6), known, {"B1": "identified"})
    assert table.frame.psd.tolist() == ["identified"]


def character(strips=40):
    """Stage character: moments of strips of independent Gaussian heights."""
    z = 1.7e-9 * np.random.default_rng(3).standard_normal((strips, 4000))
    return xr.Dataset(
        {
            "power": (("strip", "order"), np.stack([np.mean(z**order, axis=1) for order in (1, 2, 3, 4)], axis=1)),
            "summit_density": ("strip", np.linspace(60e12, 70e12, strips)),
            "mean_curvature": ("strip", np.linspace(2.4e6, 2.6e6, strips)),
        }
    )


def test_statistics_are_compared_with_the_published_ones_and_listed_with_the_measured_ones():
    known = published.read(RESOURCES / "table_1.csv")
    measured = {"B1": {"rms_nm": 1.7}, "mine": {}}
    notes = {"B1": "", "mine": "the heights have other moments"}
    table = tables_surfaces.table_1({("B1", "NG"): character(), ("mine", "NG"): character()}, measured, known, notes)
    assert table.markdown.splitlines()[0].endswith("of the CSV file. mine: the heights have other moments.")
    first, other = (row for _, row in table.frame.iterrows())
    assert_allclose((first.summit_density_per_um2, first.mean_summit_radius_um), (65, 0.4), rtol=1e-3)
    assert_allclose(first.rms_nm, 1.7, rtol=0.01)
    assert_allclose((first.summit_density_per_um2_published, first.rms_nm_afm), (63, 1.7))
    assert_allclose(first.summit_density_per_um2_deviation_percent, 100 * (65 / 63 - 1))
    assert np.isnan([other.rms_nm_published, other.rms_nm_afm, other.rms_nm_deviation_percent]).all()
    assert "(63) |" in table.markdown.splitlines()[-2]
    assert "(" not in table.markdown.splitlines()[-1]


def test_measured_statistics_are_those_of_the_configuration_and_those_estimated_from_scans():
    estimated = {"skewness": 0.3}
    data = {
        "heights": {},
        "estimates": {"mine": object()},
        "characters": {(name, "NG"): character() for name in ("B1", "mine")},
        "published": RESOURCES / "table_1.csv",
    }
    with patch.object(tables_surfaces.estimate, "statistics", return_value=estimated):
        frame = (
            tables_surfaces.STAGES[0].result(data, At(), {"measured": {"B1": {"rms_nm": 1.7}}, "of_paper": []}).frame
        )
    assert_allclose([frame.rms_nm_afm[0], frame.skewness_afm[1]], [1.7, 0.3])


def test_resampling_compares_the_means_of_stuck_beams_with_errors_of_the_beams():
    longer = beams(0, 0, 0).assign(crack_length=("beam", np.array([630e-6, 650e-6, 670e-6])))
    (found,) = tables_beams.resampling({("b", 0.8): beams(0, 0, 1)}, {("b", 0.8): longer}).frame.itertuples()
    assert_allclose((found.chaos_um, found.chaos_se_um, found.samples_um), (620, 20, 650))
    assert_allclose(found.difference_percent, 100 * (620 / 650 - 1))
    assert_allclose(found.difference_se_percent, 100 * np.hypot(20, 20 / np.sqrt(3)) / 650)


def test_a_table_is_saved_as_numbers_as_markdown_and_as_html(tmp_path):
    key = ("a", 0.45, "NG")
    table = tables_beams.table_3({key: beams(0, 0, 1)}, {key: forces()}, PUBLISHED)
    paths = {kind: tmp_path / kind for kind in ("csv", "markdown", "html")}
    tables.save(table, paths, "Table 3: cracks")
    assert_allclose(pd.read_csv(paths["csv"]).crack_length_um, 620)
    assert paths["markdown"].read_text(encoding="utf-8").startswith("Table III")
    page = paths["html"].read_text(encoding="utf-8")
    assert "<title>Table 3: cracks</title>" in page
    assert page.count("<tr") == 2
    assert "<td>620 ± 28</td>" in page


MINUS = "\N{MINUS SIGN}"


def test_markdown_and_html_show_the_same_text_even_if_it_looks_like_a_number():
    cells = pd.DataFrame({"pair": ["a|b", "c"], "deviation [%]": ["+1.0", "-0.50"]})
    table = tables.Table(pd.DataFrame({"x": [1.0]}), "Caption & units.", cells)
    for text in ("+1.0", "-0.50"):
        assert f" {text} |" in table.markdown
        assert f"<td>{text.replace('-', MINUS)}</td>" in table.page("T")
    assert '<td class="word">a|b</td>' in table.page("T"), "words from the left, numbers from the right"
    assert table.page("T").count("<td") == 4


def test_a_page_of_a_table_explains_its_terms_below_it_and_leads_back():
    table = tables.Table(
        pd.DataFrame(),
        ["All rows.", tables.Term("Limit", "the least."), *tables.warned(["(1) Too steep: 0.1."])],
        pd.DataFrame({"x": ["1"]}),
    )
    shown = Reading(table.page("T"))
    assert shown.text["dt"] == ["Limit"]
    assert shown.text["dd"] == ["the least."]
    assert shown.text["p"][-3:] == ["All rows.", "Warnings:", "(1) Too steep: 0.1."]
    assert table.page("T").index("</table>") < table.page("T").index("<details>")
    assert 'href="../index.html"' in table.page("T")
    assert "<details>" not in tables.Table(pd.DataFrame(), "", table.cells).page("T")


def variant(*states):
    """Study variants of one humidity."""
    return xr.Dataset(
        {
            "adhesion_energy": (("humidity", "strip"), ENERGIES[None]),
            "crack_length": (("humidity", "beam"), LENGTHS[None]),
            "state": (("humidity", "beam"), np.array([states])),
        },
        {"humidity": [0.45]},
    )


@pytest.mark.parametrize("pair", ["a", "mine"])
def test_a_variant_under_which_no_beam_sticks_has_no_crack_length_but_an_energy(pair):
    studies = {(pair, "base"): variant(0, 0, 1), (pair, "van_der_waals_none"): variant(1, 1, 2)}
    table = tables_studies.variants(studies, PUBLISHED)
    assert_allclose(table.frame.crack_length_um, [620, np.nan])
    assert_allclose(table.frame.meso_energy_shift_percent, 0)
    weak = table.markdown.splitlines()[-1]
    assert "nan" not in weak
    assert weak.count("–") >= 3


def test_a_redefined_pair_with_a_name_of_the_paper_is_compared_with_nothing():
    known, key = published.rows_of_paper(PUBLISHED, ["b", "c"]), ("a", 0.45, "NG")
    (row,) = tables_beams.table_3({key: beams(0, 0, 1)}, {key: forces()}, known).frame.itertuples()
    assert np.isnan([row.published_um, row.experiment_um, row.published_bias_error_percent]).all()
    (row,) = tables_studies.variants({("a", "base"): variant(0, 0, 1)}, known).frame.itertuples()
    assert np.isnan([row.published_um, row.experiment_um]).all()


def test_errors_by_scans_are_columns_of_their_own_and_only_of_measured_pairs():
    keys = [("a", 0.45, model) for model in ("G", "NG", "GEO")]
    laws = {("a", 0.45, model): forces() for model in ("G", "NG")}
    plain, scanned = (
        tables_beams.table_3({key: beams(0, 0, 1) for key in keys}, laws, PUBLISHED, by_scans)
        for by_scans in ({}, {("a", 0.45): 0.1})
    )
    assert not [name for name in [*plain.frame, *plain.cells] if "scans" in name]
    assert "scans" not in plain.caption
    pd.testing.assert_frame_equal(plain.frame, scanned.frame[list(plain.frame)])
    gaussian, *others = scanned.frame.itertuples()
    assert np.isnan(gaussian.crack_length_scans_se_um)
    for found in others:
        assert_allclose(found.crack_length_scans_se_um, 0.025 * found.crack_length_um)
        assert_allclose(found.meso_energy_scans_se_J_per_m2, 0.1 * found.meso_energy_J_per_m2)
        assert_allclose(found.adhesion_energy_scans_se_J_per_m2, 0.1 * found.adhesion_energy_J_per_m2)
    assert list(scanned.cells["se, scans"]) == ["–", "16", "16"]
    assert list(scanned.cells).index("se, scans") == list(scanned.cells).index("se") + 1


def test_text_of_users_in_a_table_is_shown_as_it_is():
    columns = {"file": (str, "file"), "channel": (str, "channel")}
    row = {"file": HOSTILE_FILE, "channel": HOSTILE}
    table = tables.Table.from_rows([row, row], [f"Scans {HOSTILE}.", tables.Line(HOSTILE)], columns)
    own = Reading(tables.Table.from_rows([{"file": "a", "channel": "b"}], "", columns).page("T"))
    for html, code in ((table.page(HOSTILE), own.code), (rendered(table.markdown), [])):
        shown = Reading(html)
        assert [name for name in shown.code if name != "meta"] == [name for name in code if name != "meta"]
        assert shown.text.get("script", own.text["script"]) == own.text["script"]
        assert shown.text["td"] == [HOSTILE_FILE, HOSTILE] * 2
        assert f"Scans {HOSTILE}." in "".join(shown.text["p"] + shown.text.get("dd", []))
    assert shown.text["li"] == [HOSTILE]
    assert "eq" not in shown.text, "a formula"
    two_lines = tables.Table.from_rows([row | {"channel": "x\ny"}], "", columns)
    assert two_lines.markdown.count("\n") == len(["", "", "head", "rule", "row"])


def test_text_of_users_in_checks_and_warnings_is_shown_as_it_is():
    failed = checks.table([checks.Check("name", HOSTILE, False, HOSTILE)])
    limited = pages.as_markdown({Subject(HOSTILE): [noted(HOSTILE, HOSTILE)]}, {})
    said = {checks.markdown(failed): f"{HOSTILE}: {HOSTILE}", limited: f"{HOSTILE}: surface {HOSTILE}: {HOSTILE}"}
    for markdown, sentence in said.items():
        shown = Reading(rendered(markdown))
        assert shown.code == []
        assert shown.text["li"][0].removeprefix("FAILED ") == sentence
        assert "eq" not in shown.text
        (line,) = [line for line in markdown.splitlines() if line.startswith("- ")]
        assert plain(line.removeprefix("- ").removeprefix("**FAILED** ")) == sentence


def rendered(markdown):
    """HTML of Markdown with tables, formulas and HTML."""
    parser = pytest.importorskip("markdown_it").MarkdownIt().enable("table")
    return parser.use(pytest.importorskip("mdit_py_plugins.dollarmath").dollarmath_plugin).render(markdown)
