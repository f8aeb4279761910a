"""Formulas of docstrings, which the docs show as MathML."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

math = pytest.importorskip("docutils.utils.math.latex2mathml")
SOURCE = Path(__file__).parents[1] / "src"
DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef
#: Formula within a line, and one on lines of its own.
ROLE, BLOCK = re.compile(r":math:`([^`]*)`"), re.compile(r"\.\. math::(.*\n(?:(?: {4,}.*)?\n)*)")


def formulas(text: str) -> Iterator[str]:
    """Formulas of a docstring."""
    for pattern in (ROLE, BLOCK):
        yield from map(str.strip, pattern.findall(f"{text}\n"))


def docstrings(file: Path) -> Iterator[str]:
    """Docstrings of a module."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, DOCUMENTED):
            yield ast.get_docstring(node) or ""


def test_the_docs_can_show_all_formulas():
    shown = 0
    for file in SOURCE.rglob("*.py"):
        for formula in (formula for text in docstrings(file) for formula in formulas(text)):
            try:
                math.tex2mathml(formula)
            except Exception as error:  # of docutils or of its parser
                pytest.fail(f"{file}: {formula}: {error}")
            shown += 1
    assert shown > 200


@pytest.mark.parametrize("formula", [r"a \Big/ b", r"\unknown"])
def test_formulas_that_they_cannot_show_are_found(formula):
    for text in (f"Of :math:`{formula}`.", f"By\n\n.. math:: {formula}\n\n    + c"):
        (found,) = formulas(text)
        with pytest.raises(Exception, match="Unknown LaTeX command"):
            math.tex2mathml(found)
