"""Nothing asks for the name of a kind of device, its release or its unit: modules ask the object of the kind."""

import ast

import pytest
from test_architecture import FILES, module_name, nodes

from stiction.config.kinds import KINDS
from stiction.stages.devices.opening import BEAMS

#: The modules of the kinds themselves, where a device of one release is selected by its object.
OF_KINDS = {"config.kinds", "plan.devices"}
#: Names, and units of the numbers sought for devices. Units of files of scans and of axes are others.
NAMES, UNITS, OTHER_UNITS = {*KINDS, *BEAMS}, {"m", "N"}, {"formats", "scans"}
#: Objects of a release or of its end state and numbers, as they are called where they are imported.
OBJECTS = {"BEAM", "STOPPER", "FORCE", "LENGTH", "sought.FORCE", "sought.LENGTH"}


def questions(path):
    """Comparisons with the name, object or unit of a kind, and uses of what is true of one kind alone."""
    for node in nodes(path):
        if isinstance(node, ast.Attribute) and node.attr in ("is_beam", "is_stopper"):
            yield ast.unparse(node)
        if isinstance(node, ast.Compare):
            for side in (node.left, *node.comparators):
                parts = side.elts if isinstance(side, ast.Tuple | ast.List | ast.Set) else [side]
                if any(is_of_kinds(part, module_name(path)) for part in parts if not is_lookup(part, node)):
                    yield ast.unparse(node)


def is_lookup(part, node):
    """Whether something is looked for by its key, such as a dataset among those of a page."""
    is_key = part is node.left and isinstance(node.ops[0], ast.In | ast.NotIn)
    return is_key and isinstance(part, ast.Constant)


def is_of_kinds(part, module):
    """Whether a part of a comparison is a name, object or unit of a kind."""
    if isinstance(part, ast.Constant):
        return part.value in (NAMES if module.split(".")[0] in OTHER_UNITS else NAMES | UNITS)
    return ast.unparse(part) in OBJECTS


def test_modules_ask_the_object_of_a_kind_and_not_its_name():
    for path in FILES:
        if module_name(path) not in OF_KINDS:
            assert not list(questions(path)), path


@pytest.mark.parametrize(
    "line",
    [
        "kind.is_beam",
        'section["kind"] == "stopper"',
        'kinds - {"stopper"} == {"stopper"}',
        'kind in ("bridge", "cantilever")',
        'answer.unit == "N"',
        "shape != FORCE",
        "FORCE in responses",
        "kind.release is BEAM",
    ],
)
def test_a_question_is_found(tmp_path, monkeypatch, line):
    path = tmp_path / "table.py"
    path.write_text(f"def f(kind, section):\n    return {line}\n")
    monkeypatch.setattr("test_questions_of_kinds.module_name", lambda _: "stages.devices.table")
    assert list(questions(path))


@pytest.mark.parametrize("line", ['"stopper" in data', "kind.release.has_laws", 'TABLE["stopper"]', 'unit == "µm"'])
def test_the_object_and_a_key_of_a_table_may_be_asked(tmp_path, monkeypatch, line):
    path = tmp_path / "table.py"
    path.write_text(f"def f(kind, data, unit):\n    return {line}\n")
    monkeypatch.setattr("test_questions_of_kinds.module_name", lambda _: "stages.devices.table")
    assert not list(questions(path))
