"""Notebooks in ``examples/notebooks`` run from the first cell to the last, and are kept without outputs."""

import ast
import json
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import stiction

NOTEBOOKS = sorted((Path(__file__).parents[1] / "examples" / "notebooks").glob("*.ipynb"))
#: Largest size of a notebook [bytes]: one with pictures is larger.
LARGEST = 10_000


def code(path):
    """Code cells of a notebook, as texts."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


def run(cells):
    """Run cells one after the other, and return the value of the last expression of each, as a notebook shows it."""
    names, values = {}, []
    for cell in cells:
        *statements, last = ast.parse(cell).body
        shown = isinstance(last, ast.Expr)
        exec(compile(ast.Module(statements if shown else [*statements, last], []), "cell", "exec"), names)
        values.append(eval(compile(ast.Expression(last.value), "cell", "eval"), names) if shown else None)
    return names, values


def test_there_are_three_notebooks():
    assert len(NOTEBOOKS) == 3


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_small_and_without_outputs(path):
    assert path.stat().st_size < LARGEST
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    for cell in cells:
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_run_and_end_at_an_answer(path, capsys):
    try:
        names, values = run(code(path))
    finally:
        stiction.show_progress()
    assert capsys.readouterr().out
    if path.stem == "surface_to_stuck":
        assert sum(isinstance(value, Figure) for value in values) == 3
        dry, wet = (float(names["device"].safe_lengths(h).safe_length.min()) for h in (0.5, 0.8))
        assert 50e-6 < wet < dry < 2e-3
    elif path.stem == "two_surfaces_and_humidity":
        smooth, rough = (names["studies"][name].energies(0.6).mean() for name in ("smooth", "rough"))
        assert rough < smooth
    else:
        before, after = (float(names["of_rms"][key]) for key in ("prior_deviation", "deviation"))
        assert after < 0.3 * before  # the test beams determine the rms, of which next to nothing was known
        assert 1 < names["rms"] < 20
