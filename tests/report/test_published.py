"""The published tables agree with the configuration, and only rows of the paper are used for comparison."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from numpy.testing import assert_allclose

from stiction.report import published

ROOT = Path(__file__).parents[2]
RESOURCES = Path(published.__file__).with_name("resources")
CONFIG = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
TABLES = {name: published.read(RESOURCES / f"{name}.csv") for name in ("table_1", "table_2", "table_3", "sensitivity")}


@pytest.mark.parametrize("surface", CONFIG["surfaces"])
def test_measured_statistics_of_table_1_are_those_of_the_configuration(surface):
    (measured,) = (
        published.rows(TABLES["table_1"], surface=surface, column="AFM").drop(columns="column").to_dict("records")
    )
    configured = {name: CONFIG["surfaces"][surface][name] for name in measured if name != "surface"}
    assert measured == {"surface": surface} | configured


@pytest.mark.parametrize("surface", CONFIG["surfaces"])
def test_spectra_of_table_2_are_those_of_the_configuration(surface):
    (known,) = published.rows(TABLES["table_2"], surface=surface).to_dict("records")
    assert {name: known[name] for name in CONFIG["surfaces"][surface]["published_psd"]} == (
        CONFIG["surfaces"][surface]["published_psd"]
    )
    assert known["plateau_nm4"] / known["plateau_nm4_as_printed"] == (10 if surface in ("B2", "Sub1") else 1)


@pytest.mark.parametrize("pair", CONFIG["pairs"])
def test_humidities_of_table_3_are_those_of_the_configuration(pair):
    assert (
        published.rows(TABLES["table_3"], pair=pair).relative_humidity.tolist() == CONFIG["pairs"][pair]["humidities"]
    )


def test_published_tables_contain_only_surfaces_and_pairs_of_the_configuration():
    for name, table in TABLES.items():
        known = CONFIG["surfaces"] if name in ("table_1", "table_2") else CONFIG["pairs"]
        assert set(table.iloc[:, 0]) <= set(known)


def test_a_user_s_surface_or_pair_has_no_rows_whatever_its_name():
    assert published.rows_of_paper(TABLES["table_3"], []).empty
    assert set(published.rows_of_paper(TABLES["table_3"], ["c", "pair", "mine"]).pair) == {"c"}
    assert set(published.rows_of_paper(TABLES["table_1"], ["B1"]).surface) == {"B1"}


def test_a_row_is_found_by_texts_and_by_numbers_up_to_rounding():
    humidity = 0.1 + 0.2 + 0.3  # 0.6 and one rounding error
    assert_allclose(published.value(TABLES["table_3"], "ng", pair="b", relative_humidity=0.67), 710)
    assert_allclose(published.value(TABLES["table_3"], "geo", pair="a", relative_humidity=humidity), 567)
    assert np.isnan(published.value(TABLES["table_3"], "ng", pair="b", relative_humidity=0.6))
    assert np.isnan(published.value(TABLES["table_3"].iloc[:0], "ng", pair="b", relative_humidity=0.67))


def test_a_name_that_looks_like_a_missing_value_is_a_name(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("# comment\npair,ng\nNA,\nnan,2\n")
    table = published.read(path)
    assert table.pair.tolist() == ["NA", "nan"]
    assert pd.isna(table.ng[0])
