"""The order of the modules: each imports only from those before it, and the physics is independent of files."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from stiction.run.fingerprint import SILENT, fingerprint

PACKAGE = Path(__file__).parents[1] / "src" / "stiction"
#: Modules outside of folders, and folders, in the order in which they may import: from those before them.
ORDER = [
    *(
        "constants",
        "errors",
        "streams",
        "estimates",
        "rounding",
        "models",
        "progress",
        "regular_files",
        "temporary",
        "kernels",
    ),
    *("surface", "formats", "scans", "contact", "chaos", "beam", "analysis", "devices", "life", "answer"),
    *("run", "config", "plan"),
    *(
        "stages.surfaces",
        "stages.contact",
        "stages.laws",
        "stages.beams",
        "stages.devices",
        "stages.life",
        "stages.axes",
        "stages.test_beams",
        "stages.answer",
    ),
    *(
        "pilot",
        "accuracy",
        "estimate",
        "stages.at_once",
        "report",
        "described_surface",
        "study",
        "device",
        "process",
        "command",
    ),
]


def room(name):
    """Folder of a module, with its parent in ``stages``; or the module itself if it is in none."""
    folders = name.split(".")
    return ".".join(folders[: 2 if folders[0] == "stages" else 1])


#: Libraries for files, labelled data, workflows and figures.
BORDER = {"xarray", "netCDF4", "snakemake", "yaml", "jsonschema", "matplotlib", "json", "csv", "pathlib", "os"}
BORDER |= {MICROSCOPES := "SurfaceTopography"}
#: Largest number of modules in a folder: so that its contents can be read at a glance.
LARGEST_FOLDER = 16


def module_name(path):
    """Name of a file of the package, such as ``surface.maxent``."""
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts)


FILES = sorted(path for path in PACKAGE.rglob("*.py") if path.name != "__init__.py")
MODULES = sorted(map(module_name, FILES))
PHYSICS = [name for name in MODULES if ORDER.index(room(name)) < ORDER.index("run")]
#: Modules with the library for files of microscopes.
READERS = {"scans.reading", "scans.published"}
#: Physics that knows files, and the compiler that keeps its results in files.
FILED = {"regular_files", "temporary", "kernels", "formats.netcdf"}
PHYSICS = [name for name in PHYSICS if name not in READERS | FILED]
SCRIPTS = sorted((PACKAGE.parents[1] / "workflow" / "scripts").glob("*.py"))


@cache
def nodes(path):
    """Nodes of the syntax tree of a file, that of the module first."""
    return list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


def imports(path):
    """Full names of everything that a module imports, at its head or inside a function."""
    for node in nodes(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} imports relatively"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def modules_used(path):
    """Modules of the package that a file imports; names not in ``MODULES`` are returned unchanged."""
    names = [name.removeprefix("stiction.") for name in imports(path) if name.split(".")[0] == "stiction"]
    return {name if name in MODULES else name.rpartition(".")[0] or name for name in names}


def test_folders_import_in_one_direction():
    for path in FILES:
        name = module_name(path)
        assert room(name) in ORDER, f"{name} has no place in the order"
        for used in modules_used(path):
            assert ORDER.index(room(used)) <= ORDER.index(room(name)), f"{name} must not import {used}"


def test_no_module_imports_itself_through_others():
    imports_of = {module_name(path): modules_used(path) & set(MODULES) for path in FILES}
    while free := {name for name, used in imports_of.items() if not used & imports_of.keys()}:
        imports_of = {name: used for name, used in imports_of.items() if name not in free}
    assert not imports_of, f"modules that import each other: {', '.join(sorted(imports_of))}"


def test_physics_does_not_import_libraries_for_files_labels_workflows_or_figures():
    for path in FILES:
        if module_name(path) in PHYSICS:
            assert not {name.split(".")[0] for name in imports(path)} & BORDER, path


def test_files_of_microscopes_are_read_in_two_modules_which_import_their_library_when_they_read():
    for path in FILES:
        used = {name.split(".")[0] for name in imports(path)}
        assert (MICROSCOPES in used) == (module_name(path) in READERS), path
        head = (node for node in nodes(path)[0].body if isinstance(node, ast.ImportFrom))
        assert not any(node.module.startswith(MICROSCOPES) for node in head), path


def test_random_numbers_come_from_a_stream_that_is_passed_in():
    for path in FILES:
        used = {ast.unparse(node) for node in nodes(path) if isinstance(node, ast.Attribute)}
        random = {name for name in used if name.startswith("np.random.")} | {"random"} & set(imports(path))
        random -= {"np.random.Generator"}  # used only in annotations; creating a generator requires a bit generator
        assert not random or module_name(path) == "streams", f"{path} makes random numbers of its own: {random}"


def test_physics_prints_nothing_and_opens_nothing():
    for path in FILES:
        calls = (node.func for node in nodes(path) if isinstance(node, ast.Call))
        names = {call.id for call in calls if isinstance(call, ast.Name)}
        assert module_name(path) not in PHYSICS or not names & {"open", "print"}, path


#: Powers of ten of factors between units and SI, and between units such as MB and GB.
POWERS = {3, 6, 9, 12, 21, 36}
#: Modules with the units of the configuration, and with those of tables and figures.
OF_UNITS = {"config.units", "report.format"}


def is_factor(node):
    """Whether an expression is a literal power of ten that occurs in units."""
    if not isinstance(node, ast.Constant) or isinstance(node.value, bool) or not isinstance(node.value, int | float):
        return False
    return any(node.value in (float(f"1e{power}"), float(f"1e-{power}")) for power in POWERS)


def factors_of_units(path):
    """Products and quotients with literal powers of ten, and names for such powers."""
    for node in nodes(path):
        product = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div)
        parts = (node.left, node.right) if product else (node.value,) if isinstance(node, ast.Assign) else ()
        if any(map(is_factor, parts)):
            yield ast.unparse(node)


def test_units_are_converted_by_the_modules_of_units():
    for path in FILES:
        # The physics is in SI units and must not import them; its error messages state lengths in µm.
        if module_name(path) not in {*PHYSICS, *OF_UNITS}:
            assert not list(factors_of_units(path)), path


@pytest.mark.parametrize("line", ["x = 1e6 * y", "f(y / 1e-9)", "x = 2 * (y * 1e-3)", "x = f'{1e6 * y:g}'", "X = 1e-6"])
def test_a_factor_between_units_is_found(tmp_path, line):
    path = tmp_path / "table.py"
    path.write_text(f"def f(y):\n    {line}\n")
    assert len(list(factors_of_units(path))) == 1


@pytest.mark.parametrize("line", ["x = 100 * y", "x = y > 1e-9", "x = np.linspace(0, 1e-6, 401)", "X = 10_000"])
def test_other_numbers_are_no_factors_between_units(tmp_path, line):
    path = tmp_path / "table.py"
    path.write_text(f"def f(y):\n    {line}\n")
    assert not list(factors_of_units(path))


#: Names that build datasets and arrays with labels; ``netCDF4.Dataset`` opens a file.
LABELLED = {f"{library}{kind}" for library in ("xr.", "xarray.", "") for kind in ("Dataset", "DataArray")}


def is_stage(name):
    """Whether a module may build the dataset of a stage."""
    return name.startswith("stages.")


def datasets_built(path):
    """Calls that build a dataset, or an array with labels, from plain arrays."""
    for node in nodes(path):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in LABELLED:
            yield ast.unparse(node)


def test_datasets_are_built_by_the_modules_of_stages():
    for path in (*FILES, *SCRIPTS):
        if not (path.is_relative_to(PACKAGE) and is_stage(module_name(path))):
            assert not list(datasets_built(path)), path


@pytest.mark.parametrize("call", ["xr.Dataset({})", "xarray.Dataset()", "xr.DataArray(y).mean()", "Dataset({'y': y})"])
def test_a_dataset_that_is_built_is_found(tmp_path, call):
    path = tmp_path / "table.py"
    path.write_text(f"def f(y: xr.Dataset) -> xr.DataArray:\n    return {call}\n")
    assert len(list(datasets_built(path))) == 1


def public_functions(path):
    """Functions and methods that users call; kernels have the types of their arguments, relations take `Keys`."""
    for node in nodes(path)[0].body:
        inside = node.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_") else [node]
        for function in inside:
            if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
                decorators = " ".join(map(ast.unparse, function.decorator_list))
                if "kernel" not in decorators and "relation" not in decorators:
                    yield function


def test_public_functions_have_annotations_and_a_docstring():
    for path in FILES:
        for function in public_functions(path):
            arguments = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
            bare = [a.arg for a in arguments if a.annotation is None and a.arg not in ("self", "cls")]
            assert not bare, f"{path}: {function.name}: {bare}"
            assert function.returns is not None, f"{path}: {function.name} states no type of its result"
            assert ast.get_docstring(function), f"{path}: {function.name} has no docstring"


def test_sources_have_no_control_characters():
    """Such as the form feed that a formula gets in place of the backslash of ``\\frac``."""
    for path in FILES:
        found = {character for character in path.read_text(encoding="utf-8") if character < " "} - {"\n"}
        assert not found, f"{path}: {found}"


def test_importing_a_folder_runs_no_code():
    # Otherwise importing a module would run code that is not part of the fingerprint of its importer.
    for path in PACKAGE.glob("*/__init__.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert all(isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) for node in tree.body), path


def test_a_script_imports_from_modules_and_never_from_the_bare_package():
    for path in SCRIPTS:
        # The fingerprint of a script follows imports of modules and would miss imports through the public names.
        assert modules_used(path) <= set(MODULES), path


@pytest.mark.parametrize("statement", ["import stiction", "from stiction import PairStudy", "import stiction as s"])
def test_an_import_of_the_bare_package_is_found(tmp_path, statement):
    path = tmp_path / "script.py"
    path.write_text(f"def f():\n    {statement}\n")
    assert not modules_used(path) <= set(MODULES)


def test_no_number_depends_on_a_module_that_the_fingerprint_leaves_out():
    for path in (*FILES, *SCRIPTS):
        # Such modules may report progress and errors, or reject a configuration, but must not affect results.
        refusing = {name.removeprefix("stiction.") for name in SILENT if ".config." in name}
        if (
            not any(folder in path.parents for folder in (PACKAGE / "config", PACKAGE / "command"))
            and path != PACKAGE / "pilot.py"
        ):
            assert not modules_used(path) & refusing, f"{path} must use config.files"


@pytest.mark.parametrize("folder", ["stages", "report"])
def test_planning_is_code_of_no_result(folder):
    declared = {name.removeprefix("stiction.") for name in SILENT}  # settings, which are parameters of the rules
    for path in (path for path in (PACKAGE / folder).rglob("*.py") if module_name(path) not in declared):
        # What the plan decides for a job is in its settings and inputs; a change of its code must rerun nothing else.
        assert not [name for name in fingerprint(path) if name.startswith("stiction.plan.")], path


def test_an_import_that_is_out_of_order_is_found(tmp_path):
    path = tmp_path / "meniscus.py"
    path.write_text("def f():\n    from stiction.contact import pair\n    import stiction.beam.cantilever\n")
    assert modules_used(path) == {"contact.pair", "beam.cantilever"}
    assert not modules_used(path) <= set(MODULES[: MODULES.index("contact.meniscus")])


def test_every_folder_has_its_place_once_and_none_is_crowded():
    assert {room(name) for name in MODULES} == set(ORDER)
    assert len(ORDER) == len(set(ORDER))
    folders = [name.rpartition(".")[0] for name in MODULES]
    assert max(map(folders.count, folders)) <= LARGEST_FOLDER


#: Names of humidities, and functions of which a value is one or all of them.
OF_HUMIDITY, OF_SEVERAL = re.compile(r"humidit|\brh\b|\bairs\b"), ("any", "min", "max", "np.min", "np.max")


def is_zero(node):
    """Whether an expression is the number 0."""
    return isinstance(node, ast.Constant) and type(node.value) in (int, float) and node.value == 0


def is_humidity(node, values):
    """Whether an expression is a humidity by its name, or one of some values, and no answer of a function."""
    if isinstance(node, ast.Call) and ast.unparse(node.func) in OF_SEVERAL:
        return is_humidity(node.args[0], values)
    text, is_answer = ast.unparse(node), any(isinstance(inner, ast.Call) for inner in ast.walk(node))
    return not is_answer and (text in values or bool(OF_HUMIDITY.search(text)))


def questions_of_dry_air(path):
    """Expressions that ask whether a humidity is 0: by comparisons, or by its truth."""
    loops = [node for node in nodes(path) if isinstance(node, ast.comprehension | ast.For)]
    values = {ast.unparse(loop.target) for loop in loops if OF_HUMIDITY.search(ast.unparse(loop.iter))}
    for node in nodes(path):
        compared = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
        tests = [node.test] if isinstance(node, ast.If | ast.IfExp) else getattr(node, "ifs", [])
        tests = [part for test in tests for part in getattr(test, "values", [test])]
        tests = [test.operand if isinstance(test, ast.UnaryOp) else test for test in tests]
        tests = [test for test in tests if isinstance(test, ast.Name | ast.Attribute | ast.Call)]
        asked = [*(compared if any(map(is_zero, compared)) else []), *tests]
        yield from (ast.unparse(each) for each in asked if is_humidity(each, values))


def test_one_module_asks_whether_air_is_dry():
    for path in FILES:
        assert module_name(path) == "contact.air" or not list(questions_of_dry_air(path)), path


@pytest.mark.parametrize(
    "line",
    [
        "x = contact[humidity > 0]",
        "x = 'dry' if rh == 0.0 else 'humid'",
        "x = [h for h in humidities if h]",
        "x = [h for h in section['humidities'] if 0 < h]",
        "x = 1 if not case.humidity else 2",
        "x = 0 in device['humidities']",
        "x = 1 if worst and any(humidities) else 2",
        "x = data.relative_humidity.values > 0",
    ],
)
def test_a_question_of_dry_air_is_found(tmp_path, line):
    path = tmp_path / "table.py"
    path.write_text(f"def f(humidity):\n    {line}\n")
    assert len(list(questions_of_dry_air(path))) == 1


@pytest.mark.parametrize(
    "line", ["x = Air(humidity).is_dry", "x = humidity > 0.3", "x = gap > 0", "x = 1 if is_humid(humidity) else 2"]
)
def test_other_questions_are_none_of_dry_air(tmp_path, line):
    path = tmp_path / "table.py"
    path.write_text(f"def f(humidity):\n    {line}\n")
    assert not list(questions_of_dry_air(path))


def classes_of_one_name(paths):
    """Names of classes that stand in several modules. Stages have their own ``Settings``."""
    classes = [node.name for path in paths for node in nodes(path) if isinstance(node, ast.ClassDef)]
    return {name for name in classes if classes.count(name) > 1 and name != "Settings" and not name.startswith("_")}


def test_a_class_has_a_name_of_its_own(tmp_path):
    assert classes_of_one_name(FILES) == set()
    for name, content in {"a": "class Beam: ...", "b": "class Beam: ...\nclass Settings: ..."}.items():
        (tmp_path / f"{name}.py").write_text(content)
    assert classes_of_one_name([tmp_path / "a.py", tmp_path / "b.py"]) == {"Beam"}
