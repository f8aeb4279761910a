import pytest

from stiction.run import fingerprint


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
    fingerprint._modules.cache_clear()
    yield tmp_path
    fingerprint._modules.cache_clear()


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


def test_a_module_that_does_not_affect_results_does_not_count(package):
    script = package / "scripts" / "script.py"
    assert list(fingerprint.fingerprint(script, silent={"stiction.folder.far"})) == ["script.py", "stiction.near"]


def test_what_only_a_check_imports_does_not_count_in_results_and_decides_whether_a_configuration_is_valid():
    """One door leads to the relations: no list of modules has to be kept."""
    relations = {f"stiction.config.{name}" for name in ("keys", "meetings", "relations", "relations_devices")}
    stages = [path for path in fingerprint.PACKAGE.glob("stages/**/*.py") if path.name != "__init__.py"]
    assert relations.isdisjoint(name for path in stages for name in fingerprint.fingerprint(path))
    check = fingerprint.PACKAGE / "config" / "validation.py"
    assert relations < set(fingerprint.fingerprint(check, silent=()))


def test_neither_declarations_nor_settings_of_jobs_count_for_any_figure_or_table():
    counted = {name for path in fingerprint.PACKAGE.glob("report/**/*.py") for name in fingerprint.fingerprint(path)}
    assert "stiction.stages.devices.device_warnings" in counted
    settings = {"stiction.plan.stage", "stiction.plan.names", "stiction.stages.contact.changes.table"}
    assert counted.isdisjoint(settings)


def test_every_two_constants_count_as_different():
    values = ["0", "0.0", "0j", "False", "None", "''", "b''", "()", "[]", "{}", "...", "1", "True", "'None'", "-0.0"]
    hashes = {fingerprint._parsed(f"limit = {value}".encode())[0] for value in values}
    assert len(hashes) == len(values)
