"""Sizes are compared as numbers, never as their texts."""

import ast

import pytest
from test_architecture import FILES, nodes

#: Functions and methods that put a number into words.
IN_WORDS = {"in_words", "safe_size", "bounding", "number", "with_error", "in_percent", "grouped", "one_in"}


def compared_texts(path):
    """Comparisons of a number in words, at once or under a name that the module gives it, by their text."""
    tree = nodes(path)
    named = {
        target.id
        for node in tree
        if isinstance(node, ast.Assign) and is_in_words(node.value)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in tree:
        if isinstance(node, ast.Compare):
            sides = node.left, *node.comparators
            if sum(is_in_words(side) or (isinstance(side, ast.Name) and side.id in named) for side in sides) > 1:
                yield ast.unparse(node)


def is_in_words(node):
    """Whether an expression puts a number into words."""
    if not isinstance(node, ast.Call):
        return False
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    return name in IN_WORDS


def test_no_module_compares_the_texts_of_numbers():
    assert {str(path): texts for path in FILES if (texts := list(compared_texts(path)))} == {}


@pytest.mark.parametrize(
    "lines",
    [
        "answer.in_words(size) == answer.in_words(build)",
        "safe_size(size, sought) != safe_size(build, sought)",
        "text = safe_size(build, sought)\nsizes = [size for size in sizes if safe_size(size, sought) != text]",
        "bounding(low, 3, True) in (a, b) or number(low, 'g') == number(high, 'g')",
    ],
)
def test_compared_texts_are_found(tmp_path, lines):
    path = tmp_path / "module.py"
    path.write_text(lines)
    assert list(compared_texts(path))


@pytest.mark.parametrize("line", ["sought.is_stricter(size, build)", "safe_size(size, sought) in page", "size < build"])
def test_numbers_and_texts_of_pages_may_be_compared(tmp_path, line):
    path = tmp_path / "module.py"
    path.write_text(line)
    assert not list(compared_texts(path))
