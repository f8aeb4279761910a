"""Fingerprint of a script and of all imported modules of the package. Snakemake does not track these modules.

The fingerprint is a parameter of every rule, so that a change of a module reruns the rules whose scripts import it,
directly or through other modules. This module uses only the standard library.
"""

import ast
import hashlib
import sys
from collections.abc import Callable, Collection
from functools import cache
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parents[1]
#: Modules that do not affect any result: they report progress and errors, or reject a configuration.
SILENT = {"stiction.progress", "stiction.run.logs", "stiction.config.messages"}
#: Declarations and settings of jobs, which are parameters of the rules themselves.
SILENT |= {"stiction.plan.stage", "stiction.plan.names"}
SILENT |= {
    f"stiction.stages.{name}" for name in ("contact.changes.patches", "contact.changes.table", "devices.contact_names")
}
#: Checks of a configuration. What only they import is left out with them.
SILENT |= {"stiction.config.validation"}
#: Kinds of nodes that may begin with a docstring.
_DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def not_kept(_determined_by: object, compute: Callable[[], Any]) -> Any:
    """Return the result of a function without keeping it."""
    return compute()


def fingerprint(
    script: str | Path,
    remember: Callable[[object, Callable[[], Any]], Any] = not_kept,
    silent: Collection[str] = frozenset(SILENT),
) -> dict[str, str]:
    """Hash a script and every imported module of the package, directly or through other modules.

    The hashes do not depend on comments, docstrings and formatting, and ``silent`` modules are left out, so that such
    changes rerun nothing. Versions of Python print syntax trees differently, so another one reruns everything.

    Parameters
    ----------
    script : path
    remember : callable
        Keeps what is found in a file of the same content, see `stiction.run.disk_cache.DiskCache`.
    silent : collection of str
        Modules that do not affect the result. Modules that only they import are left out as well.

    Returns
    -------
    dict
        Names of the script and the modules, sorted, mapped to the first 8 hex digits of their hashes.
    """
    path = Path(script)
    reached, unread = {}, [(_name(path), path)]
    while unread:
        name, path = unread.pop()
        if name not in reached:
            reached[name], imports = _read(path, path.stat().st_mtime_ns, remember)
            unread += [(name, module) for name, module in imports if name not in silent]
    return dict(sorted(reached.items()))


def _name(path):
    """Dotted name of a module of the package. File name of a script."""
    if not path.is_relative_to(PACKAGE) or path.parent.name == "scripts":
        return path.name
    return ".".join(("stiction", *path.relative_to(PACKAGE).with_suffix("").parts))


@cache
def _read(path, _modified, remember):
    """Hash of one file, and names and files of its imported modules of the package."""
    text = path.read_bytes()
    determined_by = [_this_module(), sys.implementation.cache_tag, hashlib.sha256(text).hexdigest()]
    hashed, names = remember(determined_by, lambda: _parsed(text))
    modules = {module: file for name in names for module, file in files_of(name).items()}
    return hashed, list(modules.items())


@cache
def _this_module():
    """Hash of the text of this module. All others depend on it."""
    return hashlib.sha256(Path(__file__).read_bytes()).hexdigest()


@cache
def _parsed(text):
    """Hash of a module, and the full names of all its imports from the package."""
    tree = ast.parse(text)
    nodes = [tree, *_statements(tree)]
    for node in nodes:
        if isinstance(node, _DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            del node.body[0]
    names = [name for node in nodes for name in imports_of(node)]
    return [hashlib.sha256(ast.dump(tree).encode()).hexdigest()[:8], names]


def _statements(node):
    """Yield all statements of a syntax tree and its other parts with possible statements, without expressions."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.expr):
            yield child
            yield from _statements(child)


def imports_of(node: ast.AST) -> list[str]:
    """Full names imported from the package by a statement, empty for any other node."""
    if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "stiction":
        return [f"{node.module}.{alias.name}" for alias in node.names]
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names if alias.name.startswith("stiction.")]
    return []


def files_of(name: str) -> dict[str, Path]:
    """Files of the package behind a full name, by module: a module, or the module with the definition of an object."""
    return {module: _modules()[module] for module in (name, name.rpartition(".")[0]) if module in _modules()}


@cache
def _modules():
    """Files of all modules of the package, by name."""
    return {_name(path): path for path in PACKAGE.rglob("*.py") if path.name != "__init__.py"}
