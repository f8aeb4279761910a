"""Rows of CSV files that a configuration names: single test beams, and devices."""

import csv
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from stiction.config.messages import did_you_mean, one_line


class WrongFileError(ValueError):
    """Fault of a file, as the end of a sentence."""


class CsvRow(NamedTuple):
    """One row."""

    number: int  #: line of the file
    cells: dict[str, str]  #: by column


def rows(content: str, columns: Sequence[str], needed: Sequence[str], subject: str) -> Iterator[CsvRow]:
    """Yield the rows of a file below the names of its columns. Lines beginning with # are comments.

    Parameters
    ----------
    content : str
        Text of the file.
    columns, needed : sequence of str
        Names of all columns, and of those that it must have.
    subject : str
        What a row is about.

    Raises
    ------
    WrongFileError
        If the file is no such table.
    """
    lines = ((k, line) for k, line in enumerate(content.removeprefix("\ufeff").splitlines(), 1) if line.strip(" ,"))
    listed = [(k, _cells(k, line)) for k, line in lines if line[0] != "#"]
    if not listed:
        raise WrongFileError(f"which is empty, must begin with the names of its columns: {','.join(columns)}")
    (first, names), *others = listed
    _check_columns(first, names, columns, needed)
    if not others:
        raise WrongFileError(f"which holds no {subject}, must have a row for every {subject}")
    for number, cells in others:
        if len(cells) != len(names):
            message = f"commas separate {len(cells)} values, must be {len(names)}"
            raise WrongFileError(f"row {number}: {message}, with points in decimal numbers")
        yield CsvRow(number, dict(zip(names, cells, strict=True)))


def _cells(number, line):
    """Values of a row."""
    try:
        return [cell.strip() for cell in next(csv.reader([line], strict=True))]
    except csv.Error as reason:
        raise WrongFileError(f"row {number} of {len(line)} characters cannot be read: {reason}") from None


def _check_columns(number, names, columns, needed):
    """Refuse columns if unknown, missing or given twice."""
    for name in names:
        if name not in columns:
            with_unit = [column for column in columns if name and column.startswith(f"{name}_")]
            hint = f"; did you mean {with_unit[0]}?" if with_unit else did_you_mean(name, columns)
            hint = "; separate columns by commas" if ";" in name or "\t" in name else hint
            message = f"column {one_line(name)} is unknown, must be among {', '.join(columns)}{hint}"
            raise WrongFileError(f"row {number}: {message}")
    if not {*needed} <= {*names} or len({*names}) < len(names):
        message = f"the columns are {', '.join(names)}, must have {' and '.join(needed)}, each once"
        raise WrongFileError(f"row {number}: {message}")
