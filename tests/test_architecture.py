"""The order of the modules: each imports only from those before it, and the physics knows nothing of files."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "src" / "stiction"
#: Folders and their modules, in the order in which they may import: from what stands above or to the left.
ORDER = """
constants errors streams estimates progress
surface: maxent spectrum translation field iteration summits identify
contact: meniscus vanderwaals asperity pair forcelaw
chaos: model
beam: cantilever energy montecarlo
studies: plasticity sensitivity convergence variants
run: fingerprint provenance logs
config: units cases settings
stages: data data_studies curves laws cases pairs cantilevers
run: warmup
study
stages: identifications
report: tables tables_fit tables_studies style figures_surfaces figures_forces figures_beams figures_studies checks
"""
MODULES = [
    f"{folder.strip()}.{name}".strip(".")
    for folder, _, names in (line.rpartition(":") for line in ORDER.strip().splitlines())
    for name in names.split()
]
PHYSICS = MODULES[: MODULES.index("run.fingerprint")]
#: Libraries that read, label, schedule or draw.
BORDER = {"xarray", "netCDF4", "snakemake", "yaml", "jsonschema", "matplotlib", "json", "csv", "pathlib", "os"}
#: Largest number of modules in a folder: a table of contents that is read at a glance.
LARGEST_FOLDER = 13


def module_name(path):
    """Name of a file of the package, such as ``surface.maxent``."""
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts)


FILES = sorted(path for path in PACKAGE.rglob("*.py") if path.name != "__init__.py")
each_module = pytest.mark.parametrize("path", FILES, ids=module_name)


def imports(path):
    """Full names of everything that a module imports, at its head or inside a function."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} imports relatively"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def modules_used(path):
    """Modules of the package that a file imports; what is none in ``MODULES`` stays as it is written."""
    names = [name.removeprefix("stiction.") for name in imports(path) if name.split(".")[0] == "stiction"]
    return {name if name in MODULES else name.rpartition(".")[0] or name for name in names}


@each_module
def test_a_module_imports_only_from_those_before_it(path):
    name = module_name(path)
    assert name in MODULES, f"{name} has no place in the order"
    for used in modules_used(path):
        assert used in MODULES[: MODULES.index(name)], f"{name} must not import {used}"


@each_module
def test_physics_knows_no_files_labels_workflows_or_pictures(path):
    if module_name(path) in PHYSICS:
        assert not {name.split(".")[0] for name in imports(path)} & BORDER


@each_module
def test_random_numbers_come_from_a_stream_that_is_passed_in(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    used = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    random = {name for name in used if name.startswith("np.random.")} | {"random"} & set(imports(path))
    assert not random or module_name(path) == "streams", f"{path} makes random numbers of its own: {random}"


@each_module
def test_physics_prints_nothing_and_opens_nothing(path):
    calls = (node.func for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call))
    names = {call.id for call in calls if isinstance(call, ast.Name)}
    assert module_name(path) not in PHYSICS or not names & {"open", "print"}


def test_importing_a_folder_runs_no_code():
    # Else a module would bring more than the fingerprint of its importer counts.
    for path in PACKAGE.glob("*/__init__.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert all(isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) for node in tree.body), path


def test_an_import_that_is_out_of_order_is_found(tmp_path):
    path = tmp_path / "meniscus.py"
    path.write_text("def f():\n    from stiction.contact import pair\n    import stiction.beam.cantilever\n")
    assert modules_used(path) == {"contact.pair", "beam.cantilever"}
    assert not modules_used(path) <= set(MODULES[: MODULES.index("contact.meniscus")])


def test_every_module_is_listed_once_and_no_folder_is_crowded():
    assert len(MODULES) == len(set(MODULES))
    assert {module_name(path) for path in FILES} == set(MODULES)
    folders = [name.rpartition(".")[0] for name in MODULES]
    assert max(map(folders.count, folders)) <= LARGEST_FOLDER
