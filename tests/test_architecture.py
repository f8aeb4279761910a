"""The one-way street: every module imports only from its left, and the physics knows nothing of files."""

import ast
from itertools import chain
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "src" / "stiction"
BASE = "constants errors streams estimates"
PHYSICS = (
    "maxent spectrum translation surfaces iteration summits identify",
    "meniscus vanderwaals asperity contact",
    "forcelaw chaos",
    "beam energy montecarlo",
    "plasticity sensitivity convergence choices",
)
BORDER = (
    "provenance logs units keys settings data data_studies curves laws cases pairs cantilevers compiled study",
    "identifications",
    "tables tables_fit tables_studies figures figures_surfaces figures_forces figures_beams figures_studies checks",
)
ROOMS = " ".join((BASE, *PHYSICS, *BORDER)).split()
PHYSICS_ROOMS = " ".join((BASE, *PHYSICS)).split()
#: What reads, labels, schedules or draws.
FOREIGN = {"xarray", "netCDF4", "snakemake", "yaml", "jsonschema", "matplotlib", "json", "csv", "pathlib", "os"}

modules = pytest.mark.parametrize("path", sorted(PACKAGE.glob("[!_]*.py")), ids=lambda path: path.stem)


def imports(path):
    """Full names of everything that a module imports, at its head or inside a function."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.stem} imports relatively"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def rooms_used(path):
    return {name.split(".")[1] for name in imports(path) if name.startswith("stiction.")}


@modules
def test_module_has_a_place_on_the_street_and_imports_only_from_its_left(path):
    assert path.stem in ROOMS, f"{path.stem} has no place on the street"
    for room in rooms_used(path):
        assert room in ROOMS[: ROOMS.index(path.stem)], f"{path.stem} must not import {room}"


@modules
def test_physics_knows_no_files_labels_workflows_or_pictures(path):
    if path.stem in PHYSICS_ROOMS:
        assert not {name.split(".")[0] for name in imports(path)} & FOREIGN


@modules
def test_random_numbers_come_from_a_stream_that_is_passed_in(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    used = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    random = {name for name in used if name.startswith("np.random.")} | {"random"} & set(imports(path))
    assert not random or path.stem == "streams", f"{path.stem} makes random numbers of its own: {random}"


@modules
def test_physics_prints_nothing_and_opens_nothing(path):
    calls = (node.func for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call))
    names = {call.id for call in calls if isinstance(call, ast.Name)}
    assert path.stem not in PHYSICS_ROOMS or not names & {"open", "print"}


def test_package_itself_is_empty_so_that_a_module_brings_only_what_it_imports():
    assert not (PACKAGE / "__init__.py").read_text(encoding="utf-8").strip()


def test_street_is_told_from_a_detour(tmp_path):
    detour = tmp_path / "meniscus.py"
    detour.write_text("def f():\n    from stiction import contact\n    import stiction.beam\n", encoding="utf-8")
    assert rooms_used(detour) == {"contact", "beam"}
    assert not rooms_used(detour) <= set(ROOMS[: ROOMS.index("meniscus")])


def test_every_room_is_named_once():
    assert len(ROOMS) == len(set(chain(ROOMS)))
