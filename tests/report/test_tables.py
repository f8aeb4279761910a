"""Tables II and III and that of the resampled laws from datasets of which every number is known."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from stiction.report import tables, tables_studies
from stiction.stages import data

PUBLISHED = Path(__file__).parents[2] / "workflow" / "resources"
PRINTED = tables.published(PUBLISHED / "table_3.csv")
LENGTHS = np.array([600e-6, 640e-6, 1500e-6])
ENERGIES = np.array([8e-3, 10e-3, 9e-3, 13e-3])


def beams(*states):
    return xr.Dataset(
        {
            "state": ("sample", np.array(states)),
            "crack_length": ("sample", LENGTHS),
            "adhesion_energy": ("sample", 1.0 / LENGTHS),
        }
    )


def forces(spread=1.0, weak=False):
    """Samples of which the first has no law where ``weak``: 0.5 f_max / a_left is more than its energy."""
    mean = ENERGIES.mean()
    pull_off = np.full(len(ENERGIES), 1e6) * np.where(np.arange(len(ENERGIES)) == 0, 100.0 if weak else 1.0, 1.0)
    v = [mean + spread * (ENERGIES - mean), pull_off, np.full(len(ENERGIES), 8e-9), np.full(len(ENERGIES), 6.5e-9)]
    return data.forces(np.column_stack(v), 1e8, np.arange(3.0), np.zeros((1, 3)))


def row(model="NG", spread=1.0, states=(0, 0, 1), pair="a"):
    key = (pair, 0.45, model)
    return tables.table_3({key: beams(*states)}, {key: forces(spread)}, PRINTED).iloc[0]


def test_averages_are_those_of_s_shaped_beams_and_shares_of_all():
    found = row()
    assert_allclose(found.crack_length_um, 620)
    assert_allclose(found.crack_length_std_um, 40 / np.sqrt(2))
    assert_allclose((found.share_s_shape, found.share_arc, found.share_free), (2 / 3, 1 / 3, 0))
    assert_allclose(found.meso_energy_J_per_m2, ENERGIES.mean())
    assert_allclose(found.meso_energy_cv, ENERGIES.std(ddof=1) / ENERGIES.mean())


def test_energies_that_no_beam_meets_are_told_apart():
    key = ("a", 0.45, "G")
    table = tables.table_3({key: beams(0, 0, 1)}, {key: forces(weak=True)}, PRINTED)
    assert_allclose(table.share_without_law, 1 / 4)
    assert_allclose(table.meso_energy_J_per_m2, ENERGIES.mean())
    assert_allclose(table.meso_energy_lawful_J_per_m2, ENERGIES[1:].mean())
    assert row().share_without_law == 0


def test_a_share_of_few_beams_is_not_rounded_away():
    key = ("b", 0.55, "G")
    few = xr.Dataset(
        {
            "state": ("sample", [0] + 199 * [1]),
            "crack_length": ("sample", np.full(200, 1e-3)),
            "adhesion_energy": ("sample", np.full(200, 1e-3)),
        }
    )
    assert "| 0.5/99.5/0 " in tables.markdown_3(tables.table_3({key: few}, {key: forces()}, PRINTED))


def test_standard_errors_are_those_of_beams_and_of_the_pairs_that_they_share():
    pairs = row().meso_energy_se_J_per_m2 / row().meso_energy_J_per_m2
    assert_allclose(row(spread=0).crack_length_se_um, 20)
    assert_allclose(row().crack_length_se_um, np.hypot(20, 620 * pairs / 4))
    own = row(spread=0).adhesion_energy_se_J_per_m2
    assert_allclose(row().adhesion_energy_se_J_per_m2, np.hypot(own, row().adhesion_energy_J_per_m2 * pairs))


@pytest.mark.parametrize(("model", "printed", "bias"), [("NG", 716, 0.4), ("GEO", 715, None), ("G", None, None)])
def test_every_model_stands_beside_its_own_print_and_all_beside_the_experiment(model, printed, bias):
    found = row(model)
    assert_allclose(found.deviation_percent, 100 * (620 / printed - 1) if printed else np.nan)
    assert_allclose(found.experiment_deviation_percent, 100 * (620 / 718 - 1))
    assert_allclose(found.published_bias_error_percent, bias or np.nan)


def test_a_pair_of_the_user_has_no_print():
    found = row(pair="mine")
    assert np.isnan([found.published_um, found.experiment_um, found.deviation_percent]).all()
    assert_allclose(found.crack_length_um, 620)


def test_beams_that_do_not_stick_have_no_crack_length():
    found = row(states=(1, 1, 2))
    assert np.isnan([found.crack_length_um, found.crack_length_se_um, found.adhesion_energy_J_per_m2]).all()
    text = tables.markdown_3(tables.table_3({("a", 0.45, "G"): beams(1, 1, 2)}, {("a", 0.45, "G"): forces()}, PRINTED))
    assert "±" not in text.splitlines()[-1].split("|")[4]
    assert "0/66.7/33.3" in text


def test_printed_bias_error_is_the_deviation_of_the_printed_model_from_experiment():
    bias = 100 * np.abs(PRINTED.ng / PRINTED.experiment - 1)
    assert_allclose(PRINTED.bias_error_percent, bias, atol=0.7)


def spectra(corner):
    """Stages identification and spectrum, with the parameters of B1 but for the corner, and a spectrum as published."""
    shape = {"plateau": 525e-36, "floor": 0.8e-36, "corner": corner, "cutoff": 138e6}
    known = {"mean_radius": 0.42e-6, "summit_density": 67e12, "mean_radius_error": 4e-9, "summit_density_error": 1e12}
    targets = {"target_mean_radius": 0.4e-6, "target_summit_density": 68e12, "target_rms": 1.7e-9}
    found = xr.Dataset({name: ((), value) for name, value in (shape | known | targets).items()})
    used = xr.Dataset({name: ((), value) for name, value in (shape | {"corner": 32e6, "defect": 0.01}).items()})
    return {"B1": found}, {"B1": used}


def test_identified_parameters_stand_beside_the_published_with_what_they_leave():
    printed = tables.published(PUBLISHED / "table_2.csv")
    published, identified = (row for _, row in tables.table_2(*spectra(33e6), printed).iterrows())
    assert_allclose(published.rms_residual_percent, 100 * (1.743 / 1.7 - 1), atol=0.1)  # 1.743 nm by the formula of m₂
    assert_allclose((published.gaussian_defect_percent, identified.gaussian_defect_percent), (1, np.nan))
    assert_allclose(identified.corner_rad_per_um, 33)
    assert_allclose((identified.radius_residual_percent, identified.radius_residual_se_percent), (5, 1))
    assert_allclose(identified.density_residual_percent, 100 * (67 / 68 - 1))


def test_defect_is_that_of_the_spectrum_in_use():
    table = tables.table_2(*spectra(32e6), tables.published(PUBLISHED / "table_2.csv"))
    assert_allclose(table.gaussian_defect_percent, [1, 1])
    assert "nan" not in tables.markdown_2(tables.table_2(*spectra(33e6), tables.published(PUBLISHED / "table_2.csv")))


def test_resampling_compares_the_means_of_stuck_beams_with_errors_of_the_beams():
    longer = beams(0, 0, 0).assign(crack_length=("sample", np.array([630e-6, 650e-6, 670e-6])))
    (found,) = tables_studies.resampling({("b", 0.8): beams(0, 0, 1)}, {("b", 0.8): longer}).itertuples()
    assert_allclose((found.chaos_um, found.chaos_se_um, found.samples_um), (620, 20, 650))
    assert_allclose(found.difference_percent, 100 * (620 / 650 - 1))
    assert_allclose(found.difference_se_percent, 100 * np.hypot(20, 20 / np.sqrt(3)) / 650)


def test_a_table_is_saved_for_machines_for_reading_and_for_the_report(tmp_path):
    key = ("a", 0.45, "NG")
    table = tables.table_3({key: beams(0, 0, 1)}, {key: forces()}, PRINTED)
    paths = SimpleNamespace(**{kind: tmp_path / kind for kind in ("csv", "markdown", "html")})
    tables.save(table, tables.markdown_3(table), paths)
    assert_allclose(pd.read_csv(paths.csv).crack_length_um, 620)
    assert paths.markdown.read_text(encoding="utf-8").startswith("Table III")
    page = paths.html.read_text(encoding="utf-8")
    assert page.count("<tr") == 2
    assert "<td>620 ± 28</td>" in page


def reading(*states):
    """Study reading of one humidity."""
    return xr.Dataset(
        {
            "adhesion_energy": (("humidity", "sample"), ENERGIES[None]),
            "crack_length": (("humidity", "beam"), LENGTHS[None]),
            "state": (("humidity", "beam"), np.array([states])),
        },
        {"humidity": [0.45]},
    )


@pytest.mark.parametrize("pair", ["a", "mine"])
def test_a_reading_under_which_no_beam_sticks_has_no_crack_length_but_an_energy(pair):
    studies = {(pair, "base"): reading(0, 0, 1), (pair, "van_der_waals_none"): reading(1, 1, 2)}
    table = tables_studies.readings(studies, PRINTED)
    assert_allclose(table.crack_length_um, [620, np.nan])
    assert_allclose(table.meso_energy_shift_percent, 0)
    weak = tables_studies.markdown_readings(table).splitlines()[-1]
    assert "nan" not in weak
    assert weak.count("–") >= 3
