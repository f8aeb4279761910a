"""Generated mutants: what is changed and what is not, the sample, the tests of every module, and a small project."""

import ast

import mutants
import pytest

#: Functions of which every mutant must give another result, or none.
CHANGED = {
    ast.BinOp: "return (7 - x) / 3, x**2, x // 2, x % 3, x | 2, x & 3",
    ast.AugAssign: "y = 7\n    y -= x\n    return y",
    ast.UnaryOp: "return -x, not x",
    ast.Constant: "return x * 2.5, x + 3, True",
    ast.Compare: "return x < 3, x == 4, x in (2, 8), len(range(x)) > 1, 5 <= len(range(x))",
    ast.BoolOp: "return x > 2 and x < 7 and x != 4, x < 2 or x > 7",
    ast.Name: "return min(x, 6), max(3, x)",
    ast.Attribute: "return math.floor(x / 4), math.sin(x)",
    ast.Call: "return divmod(9, x + 1), sorted([3, x, 1], reverse=True), math.sqrt(x)",
    ast.IfExp: "return 9 * x if x > 5 else 8",
    ast.Return: "return x, 9 * x, 7",
    ast.Expr: "y = [x]\n    y.clear()\n    return y",
}
#: Lines in which no test should notice an error.
INVISIBLE = [
    '"""Text of 3 words."""',
    'def f(x: "1 + 2" = None) -> "3": pass',
    "@kernel(cache=True)\ndef f(x): return x",
    '__all__ = ["a", "b"][:1]',
    "raise ValueError(1 + 2)",
    'text = f"{1 + x:.3g}"',
    'band = {"color": name, "linewidth": 0}',
    "from math import sin",
    "warn(1 + 2, 3)",
    "bars.set_xlim(0.9 * low, high)",
    "y = solve(x, rtol=1e-3)",
    "text = ax.text(0.5, -0.5, name)",
    'lines = ax.plot(0.2, 0.3, "k--", linewidth=2, size=(3, 4))',
]


def results(text):
    """What the function of a text returns for 0 to 9, as text; an error counts as a result."""
    names, found = {}, []
    exec(text, names)
    for x in range(10):
        try:
            found.append(repr(names["f"](x)))
        except (ArithmeticError, TypeError, ValueError) as error:
            found.append(repr(error))
    return found


@pytest.mark.parametrize("kind", mutants.MUTATIONS)
def test_every_mutant_changes_what_the_code_computes(kind):
    text = f"import math\n\ndef f(x):\n    {CHANGED[kind]}\n".encode()
    found = list(mutants.mutants_of("f", text))
    assert any(type(node) is kind for mutant in found for node in ast.walk(ast.parse(mutant.old)))
    for mutant in found:
        assert results(mutants.mutated(text, mutant)) != results(text), mutant


@pytest.mark.parametrize("line", INVISIBLE)
def test_errors_that_no_test_should_notice_are_not_made(line):
    assert not list(mutants.mutants_of("f", line.encode()))
    assert list(mutants.mutants_of("f", f"{line}\ny = x + 1".encode()))


def test_the_data_of_a_drawing_are_changed():
    assert {mutant.old for mutant in mutants.mutants_of("f", b"ax.plot(x, 100 * y, lw=2)")} >= {"100 * y", "100"}


@pytest.mark.slow
def test_every_module_has_tests():
    rounds = {module: mutants.rounds(module) for module in mutants.modules()}
    assert not [module for module, found in rounds.items() if not found]
    assert all(
        mutants.ROOT.joinpath(path).is_file() for found in rounds.values() for paths, _ in found for path in paths
    )


def test_mutants_are_valid_code():
    for module in ("surface.maxent", "beam.release", "config.keys"):
        text = mutants.path_of(module).read_bytes()
        tree = ast.dump(ast.parse(text))
        for mutant in mutants.sample([module], 30):
            assert ast.dump(ast.parse(mutants.mutated(text, mutant))) != tree, mutant


def test_the_sample_is_reproducible_and_in_proportion():
    modules = ["surface.maxent", "beam.release", "devices.risk"]
    found = mutants.sample(modules, 60)
    assert found == mutants.sample(modules, 60)
    assert found != mutants.sample(modules, 60, seed=1)
    assert set(found) > set(mutants.sample(modules, 30))
    sizes = [len(list(mutants.mutants_of(module))) for module in modules]
    for module, size in zip(modules, sizes, strict=True):
        assert abs(sum(mutant.module == module for mutant in found) - 60 * size / sum(sizes)) < 1


def project(tmp_path, monkeypatch, **texts):
    """Package of modules with these texts, without tests."""
    monkeypatch.setattr(mutants, "ROOT", tmp_path)
    monkeypatch.setattr(mutants, "PACKAGE", tmp_path / "src" / "stiction")
    mutants.PACKAGE.mkdir(parents=True, exist_ok=True)
    for name, text in {"__init__": "", **texts}.items():
        (mutants.PACKAGE / f"{name}.py").write_text(text)


def test_an_edit_of_a_function_leaves_the_sample_of_all_others(tmp_path, monkeypatch):
    lines = "".join(f"def f{k}(x):\n    return {k + 2} * x + {k + 3}\n\n" for k in range(20))
    project(tmp_path, monkeypatch, first=lines, second=lines)
    before = {(m.module, m.address) for m in mutants.sample(["first", "second"], 80)}
    project(
        tmp_path, monkeypatch, first=lines.replace("def f3(x):\n", "def f3(x):\n    # now the square\n    x = x * x\n")
    )
    after = {(m.module, m.address) for m in mutants.sample(["first", "second"], 80)}
    changed = {address for module, address in before ^ after if module == "second" or not address.startswith(".f3 ")}
    assert len(changed) <= 4  # at the end of the samples, of which each has a share of the number


@pytest.mark.slow
def test_a_project_whose_tests_miss_one_of_its_errors(tmp_path, monkeypatch):
    project(tmp_path, monkeypatch, f="def f(x):\n    return abs(x) + 1\n")
    (tmp_path / "tests").mkdir()
    test = "from stiction.f import f\n\ndef test_f():\n    assert f(2) == 3\n"
    (tmp_path / "tests" / "test_f.py").write_text(test)
    (tmp_path / "pyproject.toml").write_text('[tool.pytest.ini_options]\npythonpath = ["src"]\n')
    copies = mutants.Queue()
    copies.put(mutants.Copy(tmp_path.parent / f"{tmp_path.name}-copy"))
    errors = [mutant for mutant in mutants.mutants_of("f") if mutant.new in ("(x)", "(2)")]
    found = {mutant.new: test for mutant, test in mutants.caught("f", errors, copies).items()}
    assert found == {"(x)": "", "(2)": "tests/test_f.py::test_f"}
