import ast
import os
import shutil
import subprocess
import sys

import pytest

from stiction.run import fingerprint

#: Code whose syntax tree is printed differently by versions of Python, and its hash in Python 3.11, 3.12 and 3.13.
SAMPLE = '''"""Docstring."""
import os


@decorator
class Law(Base, flag=True):
    """Docstring."""

    e: float = 1.5e-3

    async def wait(self, *rest, key=None, **more):
        """Docstring."""
        return [x async for x in rest if x]


def f(a, /, b=2, *, c: int = 3) -> str:
    match a:
        case [1, *_] | {"k": str()}:
            return f"{a!r:>{b}.3f} and" " text" f"{c=}" + u"kind"
    return rf"{a:{b}}\\n" f"" f"{'nested'}"
'''
HASH = "a100a4f6"


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Package of three modules in two folders, and a script that imports two of them, one of them indirectly."""
    files = {
        "near.py": "from stiction.folder import far\nX = 1\n",
        "folder/far.py": "def f():\n    return 2\n",
        "other.py": "Y = 3\n",
        "scripts/script.py": '"""Say."""\nfrom stiction.near import X\n',
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(fingerprint, "PACKAGE", tmp_path)
    return tmp_path


def of_script(package):
    fingerprint._read.cache_clear()
    return fingerprint.fingerprint(package / "scripts" / "script.py")


def test_the_fingerprint_lists_the_script_and_all_modules_it_imports(package):
    assert list(of_script(package)) == ["script.py", "stiction.folder.far", "stiction.near"]


@pytest.mark.parametrize(
    "statement", ["from stiction.folder.far import f", "import stiction.folder.far", "from stiction.folder import far"]
)
def test_every_form_of_an_import_counts(package, statement):
    (package / "scripts" / "script.py").write_text(f"def main():\n    {statement}\n")
    assert list(of_script(package)) == ["script.py", "stiction.folder.far"]


@pytest.mark.parametrize(
    "around",
    [
        "try:\n    pass\nexcept OSError:\n    {}\n",
        "match 1:\n    case 1:\n        {}\n",
        "with open('x'):\n    if True:\n        {}\n",
    ],
)
def test_an_import_in_any_block_counts(package, around):
    (package / "scripts" / "script.py").write_text(around.format("import stiction.folder.far"))
    assert list(of_script(package)) == ["script.py", "stiction.folder.far"]


def test_a_script_and_a_module_of_one_file_name_both_count(package):
    script = package / "scripts" / "near.py"
    script.write_text("from stiction import near\n")
    assert list(fingerprint.fingerprint(script)) == ["near.py", "stiction.folder.far", "stiction.near"]


def test_a_change_of_an_indirect_import_changes_one_entry(package):
    before = of_script(package)
    (package / "folder" / "far.py").write_text("def f():\n    return 2.5\n")
    after = of_script(package)
    assert {name for name in before if before[name] != after[name]} == {"stiction.folder.far"}


def test_comments_docstrings_and_layout_do_not_count(package):
    before = of_script(package)
    (package / "folder" / "far.py").write_text('"""A module."""\n\n# why\ndef f():\n    """Two."""\n    return (2)\n')
    assert of_script(package) == before


def test_a_module_that_is_not_imported_does_not_count(package):
    before = of_script(package)
    (package / "other.py").write_text("Y = 4\n")
    assert of_script(package) == before


def test_a_module_that_does_not_affect_results_does_not_count(package, monkeypatch):
    monkeypatch.setattr(fingerprint, "SILENT", {"stiction.folder.far"})
    assert list(of_script(package)) == ["script.py", "stiction.near"]


def test_neither_declarations_nor_settings_of_jobs_count_for_any_figure_or_table():
    counted = {name for path in fingerprint.PACKAGE.glob("report/**/*.py") for name in fingerprint.fingerprint(path)}
    assert "stiction.stages.devices.device_warnings" in counted
    settings = {"stiction.plan.stage", "stiction.plan.names", "stiction.stages.contact.changes.table"}
    assert counted.isdisjoint(settings)


def test_the_hash_is_the_same_in_this_version_of_python(tmp_path):
    path = tmp_path / "sample.py"
    path.write_text(SAMPLE)
    assert fingerprint.fingerprint(path) == {"sample.py": HASH}


@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13", "3.14"])
def test_other_pythons_on_this_machine_give_the_same_fingerprints(version):
    if not (python := shutil.which(f"python{version}")) or subprocess.run([python, "-c", ""]).returncode:
        pytest.skip(f"Python {version} is not installed")
    scripts = [*fingerprint.PACKAGE.glob("report/*.py"), fingerprint.PACKAGE.parents[1] / "workflow/scripts/stage.py"]
    command = "import sys; from stiction.run.fingerprint import *; print([fingerprint(s) for s in sys.argv[1:]])"
    environment = os.environ | {"PYTHONPATH": str(fingerprint.PACKAGE.parent)}
    found, expected = (
        subprocess.run([p, "-c", command, *scripts], env=environment, capture_output=True, text=True, check=True).stdout
        for p in (python, sys.executable)
    )
    assert found == expected


def test_the_pieces_of_a_formatted_string_do_not_count():
    # Versions of Python split such strings in different places, and some keep empty literals.
    def formatted(*texts):
        value = ast.FormattedValue(ast.Name("x"), -1)
        return fingerprint.canonical(ast.JoinedStr([value if text is None else ast.Constant(text) for text in texts]))

    assert formatted("ab") == formatted("a", "b") == formatted("a", "", "b") != formatted("ba")
    assert formatted(None, None, "a") == formatted("", None, "", None, "a", "") != formatted(None, "a", None)


def test_every_two_constants_count_as_different():
    values = ["0", "0.0", "0j", "False", "None", "''", "b''", "()", "[]", "{}", "...", "1", "True", "'None'", "-0.0"]
    texts = {fingerprint.canonical(ast.parse(f"limit = {value}")) for value in values}
    assert len(texts) == len(values)
