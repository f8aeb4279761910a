"""Published tables, with the measurements, as frames. The CSV files are in the folder ``resources``.

The first column identifies the surface or pair of a row. A user's own surface or pair may have a name of the paper.
Tables and figures compare all rows that they receive, so that callers first select the rows with `rows_of_paper`.
"""

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from stiction.plan.stage import File


def file(table: str) -> File:
    """File of a published table."""
    return File(Path(__file__).with_name("resources") / f"{table}.csv")


def read(path: str | PathLike) -> pd.DataFrame:
    """Published table of a file. Lines beginning with # are comments."""
    return pd.read_csv(path, comment="#", keep_default_na=False, na_values=[""])


def rows_of_paper(published: pd.DataFrame, names: Iterable[str]) -> pd.DataFrame:
    """Rows of the surfaces or pairs of these names: those equal to the paper's.

    Examples
    --------
    >>> rows_of_paper(pd.DataFrame({"pair": ["a", "b"], "ng": [716, 1031]}), ["b", "mine"]).ng.tolist()
    [1031]
    """
    return published[published.iloc[:, 0].isin(list(names))]


def published_rows(data: Mapping[str, Any], settings: Mapping[str, Any]) -> pd.DataFrame:
    """Published values of the surfaces or pairs equal to the paper's: settings ``rows_of_paper`` of a stage."""
    return rows_of_paper(read(data["published"]), settings["of_paper"])


def rows(published: pd.DataFrame, /, **key: str | float) -> pd.DataFrame:
    """Rows with the values of ``key`` in their columns. Numbers may differ by rounding."""
    matching = np.ones(len(published), bool)
    for column, value in key.items():
        held = published[column]
        matching &= (held == value if isinstance(value, str) else np.isclose(held.astype(float), value)).astype(bool)
    return published[matching]


def value(published: pd.DataFrame, column: str, /, **key: str | float) -> float:
    """Number of a column in the first row of `rows`, NaN without a row.

    Examples
    --------
    >>> table = pd.DataFrame({"pair": ["a", "a"], "relative_humidity": [0.45, 0.6], "ng": [716, 569]})
    >>> value(table, "ng", pair="a", relative_humidity=0.6), value(table, "ng", pair="b")
    (569.0, nan)
    """
    match = rows(published, **key)
    return float(match[column].iloc[0]) if len(match) else np.nan
