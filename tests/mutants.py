"""Mutation testing: make small errors in the code, one at a time, and name those that no test detects.

    python tests/mutants.py [module or folder ...] [--number 600] [--seed 0] [--list]

Errors are generated from the syntax tree of a module and sampled by a hash of the error and its function, so that an
edit of one function leaves the sample of all others as it is. Each error is made in a copy of the project, where tests
run until the first fails: those named after the module, those that import it, those that import a module which imports
it or, for stages, their graph, those of its folder before all others. Tests that found an error before come first.

Not generated are errors that no test should notice: in texts, messages and what raises or logs them, in annotations,
decorators, imports and ``__all__``, in resources, precision, looks and guards against what never happens
(``RESOURCES``, ``INVISIBLE``), and in calls and numbers that only arrange a drawing.
"""

import argparse
import ast
import copy
import hashlib
import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from functools import cache
from pathlib import Path
from queue import Queue
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "stiction"
#: Share of the mutants that tests must catch.
REQUIRED = 0.97
#: A mutant counts as caught if its tests take this many times as long as without it, and at least that long [s].
PATIENCE = 4, 60
#: Processes of tests start from one that has imported the libraries.
PROCESSES = multiprocessing.get_context("forkserver")
LIBRARIES = ["numba", "scipy.stats", "scipy.optimize", "scipy.signal", "xarray", "netCDF4", "matplotlib.pyplot"]
FAST, SLOW = (f"{which} and not cluster and not browser" for which in ("not slow and not nightly", "(slow or nightly)"))

#: Operators and the one that each is replaced by.
OPERATORS = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult}
OPERATORS |= {ast.FloorDiv: ast.Mult, ast.Mod: ast.FloorDiv, ast.BitOr: ast.BitAnd, ast.BitAnd: ast.BitOr}
#: Operations that have a first and a second operand of one kind, of which either can be dropped.
SUMS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.BitOr, ast.BitAnd)
COMPARISONS = {ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}
COMPARISONS |= {ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In}
#: Comparisons of counts with and without equality; for real numbers these two seldom differ.
BOUNDARIES = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
COUNTS = {"len", "size", "shape", "ndim"}
PAIRS = "min max, minimum maximum, mean median, argmin argmax, any all, floor ceil, sin cos, sinh cosh, zeros ones"
PAIRS += ", std var, nanmin nanmax, nanmean nanmedian, fmin fmax, log exp, log1p expm1, append extend"
NAMES = dict(pair.split() for pair in PAIRS.split(", "))
NAMES |= {new: old for old, new in NAMES.items()}
#: Functions of one argument that can be dropped.
DROPPED = {"sqrt", "abs", "sorted", "reversed", "square", "cumsum", "exp", "log", "unique", "conj", "set"}
#: Functions of which the order of arguments does not matter.
SYMMETRIC = {"min", "max", "minimum", "maximum", "fmin", "fmax", "hypot", "allclose", "isclose", "array_equal"}

#: Modules that affect time and memory only.
RESOURCES = {"config.memory", "run.warmup"}
#: Functions that report, methods that arrange drawings, and keywords of resources, precision, looks and guards.
REPORTS = {"print", "warn", "warning", "info", "debug", "error", "exception", "progress"}
INVISIBLE = "rtol atol xtol ftol gtol xatol fatol tol maxiter max_nfev maxsize cache nogil chunksize encoding minutes"
INVISIBLE += " color linewidth linestyle alpha fontsize figsize zorder label loc ncols rotation pad lw s c"
INVISIBLE += " markersize capsize xytext ha va strict join"
INVISIBLE = set(INVISIBLE.split())
DRAWINGS = {"ax", "axes", "axis", "figure", "inset", "panel"}
ARRANGING = "annotate colorbar legend locator_params margins set suptitle supxlabel text tick_params"
ARRANGING = set(ARRANGING.split())


class Mutant(NamedTuple):
    """One error: text of a module from ``start`` to ``end`` [bytes] and its replacement."""

    module: str
    line: int
    start: int
    end: int
    old: str
    new: str
    address: str  #: function, error, and its number among equal ones

    def __str__(self):
        old, new = (" ".join(text.split()) for text in (self.old, self.new))
        return f"{path_of(self.module).relative_to(ROOT)}:{self.line}: {old}  ->  {new}"


def changed(node, **fields):
    """Copy of a node with other fields."""
    node = copy.copy(node)
    vars(node).update(fields)
    return node


def name_of(node):
    """Last name of a function or an expression: ``mean`` of ``np.mean`` and of ``values.mean``."""
    node = node.func if isinstance(node, ast.Call) else node
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def of_binary(node):
    """Other operator, and either operand alone."""
    if type(node.op) in OPERATORS:
        yield changed(node, op=OPERATORS[type(node.op)]())
    if isinstance(node.op, SUMS):
        yield from (node.left, node.right)
    if isinstance(node.op, ast.MatMult):
        yield changed(node, left=node.right, right=node.left)


def of_augmented(node):
    """Other operator, and none."""
    if type(node.op) in OPERATORS:
        yield changed(node, op=OPERATORS[type(node.op)]())
    yield ast.Pass()


def of_unary(node):
    """Neither sign nor ``not``."""
    yield node.operand


def of_constant(node):
    """Truth reversed, integers one more and one less, other numbers doubled."""
    if isinstance(node.value, bool):
        yield ast.Constant(not node.value)
    elif isinstance(node.value, int):
        yield from (ast.Constant(number) for number in (node.value + 1, node.value - 1) if number >= 0)
    elif isinstance(node.value, float):
        yield ast.Constant(2 * node.value or 1.0)


def of_comparison(node):
    """Opposite comparison; of counts, with the other boundary as well."""
    first, *others = node.ops
    yield changed(node, ops=[COMPARISONS[type(first)](), *others])
    counts = {name_of(operand) for side in (node.left, *node.comparators) for operand in ast.walk(side)} & COUNTS
    if counts and type(first) in BOUNDARIES:
        yield changed(node, ops=[BOUNDARIES[type(first)](), *others])


def of_boolean(node):
    """Other operator, and without one condition."""
    yield changed(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    for k, _ in enumerate(node.values):
        rest = node.values[:k] + node.values[k + 1 :]
        yield rest[0] if len(rest) == 1 else changed(node, values=rest)


def of_name(node):
    """Other function, such as ``max`` for ``min``."""
    if name_of(node) in NAMES and isinstance(node.ctx, ast.Load):
        yield changed(node, **{"attr" if isinstance(node, ast.Attribute) else "id": NAMES[name_of(node)]})


def of_call(node):
    """First two arguments exchanged, a keyword omitted, and the argument alone."""
    ordered = name_of(node) not in SYMMETRIC and not any(isinstance(value, ast.Starred) for value in node.args[:2])
    if len(node.args) > 1 and ordered and not arranges(node, node.args[0]):
        yield changed(node, args=[*node.args[1::-1], *node.args[2:]])
    for k, keyword in enumerate(node.keywords):
        if keyword.arg not in INVISIBLE | {None} and name_of(node).islower() and not arranges(node, keyword):
            yield changed(node, keywords=node.keywords[:k] + node.keywords[k + 1 :])
    if name_of(node) in DROPPED and len(node.args) == 1:
        yield node.args[0]


def of_choice(node):
    """Either value, whatever the condition."""
    yield from (node.body, node.orelse)


def of_return(node):
    """First two values exchanged."""
    if isinstance(node.value, ast.Tuple) and len(node.value.elts) > 1:
        first, second, *others = node.value.elts
        yield changed(node, value=changed(node.value, elts=[second, first, *others]))


def of_statement(node):
    """No call."""
    if isinstance(node.value, ast.Call):
        yield ast.Pass()


MUTATIONS = {ast.BinOp: of_binary, ast.AugAssign: of_augmented, ast.UnaryOp: of_unary, ast.Constant: of_constant}
MUTATIONS |= {ast.Compare: of_comparison, ast.BoolOp: of_boolean, ast.Name: of_name, ast.Attribute: of_name}
MUTATIONS |= {ast.Call: of_call, ast.IfExp: of_choice, ast.Return: of_return, ast.Expr: of_statement}


def invisible(node):
    """Whether no test should notice an error anywhere in a node."""
    if isinstance(node, ast.Expr):
        return invisible(node.value)
    if isinstance(node, ast.Call):
        method = isinstance(node.func, ast.Attribute) and name_of(node)
        return name_of(node) in REPORTS or method in ARRANGING or str(method).startswith("set_")
    if isinstance(node, ast.Assign):
        return name_of(node.targets[0]) == "__all__"
    return isinstance(node, ast.JoinedStr | ast.Raise) or (isinstance(node, ast.keyword) and node.arg in INVISIBLE)


def arranges(node, child):
    """Whether a child is a number given to the call of a drawing or a part of it, or a look in a dictionary."""
    if isinstance(node, ast.Dict) and child in node.values:
        return getattr(node.keys[node.values.index(child)], "value", None) in INVISIBLE
    number = child.value if isinstance(child, ast.keyword) else child
    if not (isinstance(node, ast.Call) and isinstance(number, ast.Constant | ast.Tuple | ast.UnaryOp)):
        return False
    while isinstance(node, ast.Call | ast.Attribute | ast.Subscript):
        node = node.func if isinstance(node, ast.Call) else node.value
    return name_of(node) in DRAWINGS


def places(node, function=""):
    """Nodes that may be mutated, and the names of their functions."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        function = f"{function}.{node.name}"
    for field, value in ast.iter_fields(node):
        if field not in ("annotation", "returns", "decorator_list", "bases"):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not invisible(child) and not arranges(node, child):
                    yield child, function
                    yield from places(child, function)


def mutants_of(module, text=None):
    """All mutants of a module, such as ``surface.maxent``, or of a text [bytes] in its place."""
    text = path_of(module).read_bytes() if text is None else text
    lines, equal = [0, *(k + 1 for k, byte in enumerate(text) if byte == ord("\n"))], {}
    for node, function in places(ast.parse(text)):
        for error in MUTATIONS.get(type(node), lambda _: ())(node):
            new = f"({ast.unparse(error)})" if isinstance(error, ast.expr) else ast.unparse(error)
            start, end = lines[node.lineno - 1] + node.col_offset, lines[node.end_lineno - 1] + node.end_col_offset
            address = f"{function} {ast.unparse(node)} -> {new}"
            equal[address] = equal.get(address, 0) + 1
            if ast.dump(error) != ast.dump(node):
                old = text[start:end].decode()
                yield Mutant(module, node.lineno, start, end, old, new, f"{address} {equal[address]}")


def sample(modules, number, seed=0):
    """A number of mutants of modules, in proportion to the mutants that each has."""
    every = {module: list(mutants_of(module)) for module in modules}
    share = min(1, number / max(1, sum(map(len, every.values()))))

    def place(mutant):
        return hashlib.sha256(f"{seed} {mutant.module} {mutant.address}".encode()).digest()

    return [m for mutants in every.values() for m in sorted(mutants, key=place)[: round(share * len(mutants) + 0.01)]]


def path_of(module):
    """File of a module such as ``surface.maxent``."""
    return PACKAGE / f"{module.replace('.', '/')}.py"


def modules():
    """All modules of the package whose errors are visible in results."""
    files = (path for path in sorted(PACKAGE.rglob("*.py")) if path.name != "__init__.py")
    names = [".".join(path.relative_to(PACKAGE).with_suffix("").parts) for path in files]
    return [name for name in names if name not in RESOURCES]


@cache
def imported(path):
    """Modules that a file imports and what it imports from them, with those of the helpers of tests that it imports."""
    modules_found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("stiction"):
            modules_found |= {f"{node.module}.{alias.name}".removeprefix("stiction.") for alias in node.names}
            modules_found.add(node.module.removeprefix("stiction."))
        elif isinstance(node, ast.ImportFrom) and (helper := ROOT / "tests" / f"{node.module}.py").is_file():
            modules_found |= imported(helper) if helper != path else set()
    return frozenset(modules_found)


def rounds(module):
    """Tests of a module and their marks, one after the other: each for the mutants that those before have missed."""
    *folder, name = module.split(".")
    tests = ROOT / "tests"
    above = [tests.joinpath(*folder[:depth]) for depth in range(len(folder), -1, -1)]
    folder_of_tests = next(path for path in above if path.is_dir())
    named = sorted({*folder_of_tests.glob(f"test_{name}*.py"), *folder_of_tests.glob(f"test_*_{name}.py")})
    using = [path for path in sorted(tests.rglob("test_*.py")) if module in imported(path) and path not in named]
    using.sort(key=lambda path: path.parent != folder_of_tests)
    readers = {name for name in modules() if module in imported(path_of(name))}
    # Stages, and what modules declare as stages, are also tested through their graph.
    if folder[:1] == ["stages"] or "\nSTAGES = " in path_of(module).read_text(encoding="utf-8"):
        readers |= {"plan.graph"}
    reading = [path for path in sorted(tests.rglob("test_*.py")) if readers & imported(path)]
    reading = [path for path in reading if path not in [*named, *using]]
    near, far = ([path for path in reading if (path.parent == folder_of_tests) is here] for here in (True, False))
    tests_and_marks = [(named, FAST), (using, FAST), (near, FAST), (far, FAST), (named or using, SLOW)]
    return [([str(path.relative_to(ROOT)) for path in paths], marks) for paths, marks in tests_and_marks if paths]


class Watch:
    """Plugin of pytest: tests that found errors before come first; what fails, and the time of each test [s]."""

    def __init__(self, found):
        self.found, self.failed, self.seconds = found, "", {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_pycollect_makeitem(self, collector):
        return [] if collector.path.is_relative_to(Path("src").resolve()) else None  # of the package, only doctests

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items):
        items.sort(key=lambda item: -self.found.get(item.nodeid, 0))

    def pytest_collectreport(self, report):
        self.failed = self.failed or report.failed and report.nodeid

    def pytest_runtest_logreport(self, report):
        self.seconds[report.nodeid] = self.seconds.get(report.nodeid, 0) + report.duration
        self.failed = self.failed or report.failed and report.nodeid


def run_tests(connection, folder, cache, arguments, found, changed):
    """Run pytest in a process that has imported all libraries, but not the package, and send what it has seen."""
    from numba.core.config import reload_config

    os.setsid()
    os.chdir(folder)
    os.environ |= {"NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": str(folder / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
    sys.path.insert(0, str(folder / "src"))
    reload_config()
    sys.dont_write_bytecode = changed  # a mutant may have the size and the second of the one before
    with Path(os.devnull).open("w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        os.dup2(nowhere.fileno(), 2)
    watch = Watch(found)
    code = pytest.main(["-x", "--tb=no", "-p", "no:cacheprovider", *arguments], plugins=[watch])
    passed = code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
    connection.send(("" if passed else watch.failed or f"pytest ended with {code}", watch.seconds))


class Copy:
    """Copy of the project with one mutant at a time, each with a compilation cache of its own."""

    def __init__(self, folder):
        self.folder, self.warm, self.cache = folder / "project", folder / "warm", folder / "cache"
        self.found, self.seconds = {}, {}
        left_out = shutil.ignore_patterns("__pycache__", ".*", "results", "benchmarks", "_build")
        shutil.copytree(ROOT, self.folder, ignore=left_out)
        self.warm.mkdir()

    def failure(self, paths, marks, cache, limit=None):
        """Run tests, at most for a time [s]: the first that fails, empty if all pass, and the time of each."""
        ours, theirs = PROCESSES.Pipe(duplex=False)
        arguments = theirs, self.folder, cache, ["-m", marks, *paths], self.found, cache != self.warm
        process = PROCESSES.Process(target=run_tests, args=arguments)
        process.start()
        theirs.close()
        try:
            return ours.recv() if ours.poll(limit) else ("its tests do not end", {})
        except EOFError:
            return "its tests break off", {}
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.join()

    def time_without(self, module, paths, marks):
        """Time of tests without a mutant [s], with which all must pass; the first time they fill the cache."""
        if new := [path for path in paths if (path, marks) not in self.seconds]:
            failed, seconds = self.failure(new, marks, self.warm)
            if failed:
                raise RuntimeError(f"the tests of {module} fail without a mutant: {failed}")
            for path in new:
                self.seconds[path, marks] = sum(seconds[test] for test in seconds if test.startswith(f"{path}::"))
        return sum(self.seconds[path, marks] for path in paths)

    def failure_with(self, mutant, paths, marks, limit):
        """First test that fails with a mutant."""
        path = self.folder / path_of(mutant.module).relative_to(ROOT)
        text, times = path.read_bytes(), path.stat()
        shutil.rmtree(self.cache, ignore_errors=True)
        shutil.copytree(self.warm, self.cache, copy_function=os.link)  # Numba replaces its files as a whole
        try:
            path.write_bytes(mutated(text, mutant))
            failed, _ = self.failure(paths, marks, self.cache, limit)
            self.found[failed] = self.found.get(failed, 0) + 1
            return failed
        finally:
            path.write_bytes(text)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def mutated(text, mutant):
    """Text of a module [bytes] with a mutant in it."""
    return text[: mutant.start] + mutant.new.encode() + text[mutant.end :]


def caught(module, mutants, copies):
    """Mutants of a module and the test that fails with each, empty if none does; without a mutant, all must pass."""
    project, failures, missed = copies.get(), dict.fromkeys(mutants, ""), mutants
    try:
        for paths, marks in rounds(module):
            paths = [*paths, str(path_of(module).relative_to(ROOT))]
            if seconds := project.time_without(module, paths, marks):
                limit = max(PATIENCE[0] * seconds, PATIENCE[1])
                failures |= {mutant: project.failure_with(mutant, paths, marks, limit) for mutant in missed}
                missed = [mutant for mutant in missed if not failures[mutant]]
            if not missed:
                break
        return failures
    finally:
        copies.put(project)


def run(mutants):
    """Mutants that no test catches, and modules whose tests fail without one; each is printed once it is known."""
    names, survivors, failing = sorted({mutant.module for mutant in mutants}), [], []
    os.environ["OMP_NUM_THREADS"] = "1"
    PROCESSES.set_forkserver_preload(LIBRARIES)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        copies = Queue()
        for worker in range(os.cpu_count()):
            copies.put(Copy(Path(folder) / str(worker)))
        tasks = [pool.submit(caught, name, [m for m in mutants if m.module == name], copies) for name in names]
        for task in as_completed(tasks):
            if error := task.exception():
                print(error, flush=True)  # noqa: T201
                failing.append(names[tasks.index(task)])
                continue
            for mutant, test in task.result().items():
                print(f"caught    {mutant}  {test}" if test else f"SURVIVED  {mutant}", flush=True)  # noqa: T201
                survivors += [] if test else [mutant]
    return survivors, failing


def main():
    parser = argparse.ArgumentParser(description="Make small errors in the code and name those that no test detects.")
    parser.add_argument(
        "modules", nargs="*", help="modules or folders of src/stiction such as surface.maxent; default: all"
    )
    parser.add_argument("--number", type=int, default=600, help="number of errors, default %(default)s")
    parser.add_argument("--seed", type=int, default=0, help="another seed gives other errors")
    parser.add_argument("--list", action="store_true", help="only print the errors")
    options = parser.parse_args()
    wanted = options.modules
    names = [name for name in modules() if not wanted or any(f"{name}.".startswith(f"{prefix}.") for prefix in wanted)]
    mutants = sample(names, options.number, options.seed) or parser.error(f"no code in {' '.join(wanted)}")
    if options.list:
        sys.exit("\n".join(map(str, mutants)))
    survivors, failing = run(mutants)
    tried = sum(mutant.module not in failing for mutant in mutants)
    share = 1 - len(survivors) / max(tried, 1)
    print(*map(str, survivors), f"{share:.1%} of {tried} mutants caught", sep="\n")  # noqa: T201
    sys.exit(share < REQUIRED or bool(failing))


if __name__ == "__main__":
    main()
