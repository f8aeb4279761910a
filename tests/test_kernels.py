"""Machine code on disk belongs to the sources: a toy package with a kernel that calls the kernel of another module."""

import ast
import fcntl
import os
import random
import shutil
import subprocess
import sys
from itertools import cycle, product
from pathlib import Path

import pytest
from numba.core.caching import FunctionCache, IndexDataCacheFile

from stiction import kernels, temporary
from stiction.run import fingerprint
from stiction.surface.translation import _horner

PACKAGE = Path(kernels.__file__).parent
SOURCES = {
    "__init__": "",
    "constants": "FACTOR = 2.0\n",
    "other": "TERM = 1.0\n",
    "called": """
from typing import NamedTuple
from stiction.constants import FACTOR
from stiction.kernels import kernel

class _Mesh(NamedTuple):
    x: float

@kernel
def mesh(x):
    return _Mesh(FACTOR * x)
""",
    "calling": """
from stiction.called import (
    mesh,
)
from stiction.kernels import kernel

@kernel
def position(found):
    return found.x + 1.0

@kernel
def place(x):
    return position(mesh(x))
""",
}
#: Prints a value by the kernels and how many passes of the compiler ran.
PROGRAM = """
from numba.core.event import RecordingListener, install_listener
import stiction.other
from stiction.calling import place, position
from stiction.called import mesh
passes = RecordingListener()
with install_listener("numba:run_pass", passes):
    print(position(mesh(10.0)), place(10.0), len(passes.buffer) > 0)
"""
NUMBA = "import numba\nkernel = numba.njit(cache=True, nogil=True)\n"


@pytest.fixture
def toy(tmp_path):
    """Folder of a toy package called stiction, without machine code."""
    folder = tmp_path / "stiction"
    folder.mkdir()
    for name, text in SOURCES.items():
        (folder / f"{name}.py").write_text(text)
    for copied in (kernels, temporary):
        shutil.copy(copied.__file__, folder)
    return folder


def start(toy, **variables):
    """New process that calls the kernels; its bytecode is not kept, which Python compares by whole seconds."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA")}
    environment |= {"PYTHONPATH": str(toy.parent), "XDG_CACHE_HOME": str(toy.parent / "home"), **variables}
    command = [sys.executable, "-B", "-c", PROGRAM]
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def called(toy, **variables):
    """What a new process prints: the two values, which must be equal, and whether anything was compiled."""
    output, errors = start(toy, **variables).communicate()
    assert output, errors
    value, same, compiled = output.split()
    assert value == same
    return float(value), compiled == "True"


def edit(toy, module, old, new):
    """Replace a text in a module; the time of the file remains, as its size does if the texts are equally long."""
    path = toy / f"{module}.py"
    times, text = path.stat(), path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def stored(folder):
    """Names and times of the files with machine code."""
    return {path.name: path.stat().st_mtime_ns for path in folder.rglob("*.nb[ic]")}


@pytest.mark.parametrize(
    "place",
    [
        "next to the sources",
        *(pytest.param(place, marks=pytest.mark.slow) for place in ("folder of the user", "chosen folder")),
    ],
)
def test_changes_of_what_a_kernel_calls_and_no_others_change_the_results_of_the_next_process(toy, place):
    chosen = {"NUMBA_CACHE_DIR": str(toy.parent / "chosen")} if place == "chosen folder" else {}
    if place == "folder of the user":
        (toy / "__pycache__").touch()  # no folder, so that nothing can be written there, not even by root
    folder = {"next to the sources": toy, "chosen folder": toy.parent / "chosen"}.get(place, toy.parent / "home")
    assert called(toy, **chosen) == (21, True)
    before = stored(folder)
    assert len(before) == 6
    edit(toy, "other", "1.0", "7.0")  # which no kernel imports
    assert called(toy, **chosen) == (21, False)
    assert stored(folder) == before
    edit(toy, "called", "FACTOR * x", "FACTOR + x")
    assert called(toy, **chosen) == (13, True)
    after = stored(folder)
    assert len(after) == 6, "obsolete files remain"
    assert not after.keys() & before.keys()


@pytest.mark.slow
def test_numba_alone_returns_old_results_after_such_a_change(toy):
    (toy / "kernels.py").write_text(NUMBA)
    assert called(toy) == (21, True)
    edit(toy, "called", "FACTOR * x", "FACTOR + x")
    process = start(toy)
    assert process.communicate()[0].split()[1] == "21.0"


@pytest.mark.slow
def test_processes_that_start_at_once_after_a_change_have_the_new_results(toy):
    assert called(toy) == (21, True)
    edit(toy, "constants", "2.0", "3.0")
    processes = [start(toy) for _ in range(3)]
    assert [process.communicate()[0].split()[:2] for process in processes] == [["31.0", "31.0"]] * 3
    assert called(toy) == (31, False)
    edit(toy, "called", "_Mesh", "_Grid")
    assert called(toy) == (31, True), "the name of a type"


@pytest.fixture
def saved(monkeypatch):
    """Saves a kernel without writing it; says whether another process could have saved one meanwhile."""
    cache, free = kernels._Cache(_horner.py_func), []

    def save(_cache, _signature, _data):
        with (Path(cache.cache_path) / "lock").open("a") as other:
            try:
                flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                free.append(False)
            else:
                free.append(True)

    monkeypatch.setattr(FunctionCache, "save_overload", save)
    flock = fcntl.flock
    return lambda: cache.save_overload(None, None) or free


def test_kernels_are_saved_one_at_a_time(saved):
    assert saved() == [False]


def test_kernels_are_saved_on_file_systems_without_locks(saved, monkeypatch):
    monkeypatch.setattr(kernels.fcntl, "flock", lambda *_: os.open("no such file", os.O_RDONLY))
    assert saved() == [True]


def test_kernels_are_saved_although_their_folder_was_removed(monkeypatch, tmp_path):
    cache, saved = kernels._Cache(_horner.py_func), []
    monkeypatch.setattr(cache, "_cache_path", str(tmp_path / "removed" / "folder"))
    monkeypatch.setattr(FunctionCache, "save_overload", lambda *data: saved.append(data))
    cache.save_overload(None, None)
    assert saved == [(cache, None, None)]


def test_a_kernel_that_cannot_be_saved_runs(monkeypatch):
    monkeypatch.setattr(FunctionCache, "save_overload", lambda *_: os.open("no such file", os.O_RDONLY))
    kernels._Cache(_horner.py_func).save_overload(None, None)


@pytest.fixture
def nowhere(toy):
    """Environment in which neither the package nor the home can be written, not even by root; and temporary files."""
    (toy / "__pycache__").touch()
    (toy.parent / "tmp").mkdir()
    return {"XDG_CACHE_HOME": "/proc/nowhere", "HOME": "/proc/nowhere", "TMPDIR": str(toy.parent / "tmp")}


@pytest.mark.slow
def test_machine_code_is_kept_for_this_user_alone_where_neither_package_nor_home_can_be_written(toy, nowhere):
    assert called(toy, **nowhere) == (21, True)
    assert called(toy, **nowhere) == (21, False)
    (folder,) = Path(nowhere["TMPDIR"]).glob("stiction-*")
    assert folder.stat().st_mode & 0o777 == 0o700
    assert len(stored(folder)) == 6


TRAPS = {
    "writable by others": lambda path, _: [path.mkdir(), path.chmod(0o777)],
    "a link": lambda path, trap: path.symlink_to(trap),
    "a file": lambda path, _: path.touch(),
}


@pytest.mark.parametrize("trap", TRAPS)
def test_machine_code_is_never_kept_where_others_can_write(monkeypatch, tmp_path, trap):
    monkeypatch.setattr(temporary.tempfile, "tempdir", str(tmp_path))
    path, other = tmp_path / f"stiction-{os.getuid()}", tmp_path / "other"
    other.mkdir()
    TRAPS[trap](path, other)
    found = temporary.own_folder.__wrapped__()
    assert found not in (path, other)
    assert found.stat().st_mode & 0o777 == 0o700
    assert not list(other.iterdir())


def test_a_kernel_is_compiled_where_nothing_can_be_kept(monkeypatch):
    def refuse(*_):
        raise RuntimeError("cannot cache function: no locator available")

    monkeypatch.setattr(kernels, "_Cache", refuse)
    monkeypatch.setattr(kernels, "own_folder", lambda: os.open("no such file", os.O_RDONLY))
    assert kernels.kernel(_horner.py_func).py_func is _horner.py_func


def test_sources_of_a_kernel_are_the_imports_in_its_syntax_tree():
    for path in PACKAGE.rglob("*.py"):
        names = [name for node in ast.walk(ast.parse(path.read_bytes())) for name in fingerprint.imports_of(node)]
        assert kernels._read(path)[1] >= {file for name in names for file in fingerprint.files_of(name).values()}, path


def test_every_kernel_of_the_package_has_the_decorator():
    for path in PACKAGE.rglob("*.py"):
        if path != Path(kernels.__file__):
            text = path.read_text(encoding="utf-8")
            assert "njit" not in text, path
            assert "numba.jit" not in text, path


def flipped(content, draw):
    """Content with some bits flipped."""
    changed = bytearray(content)
    for _ in range(draw.randint(1, 5)):
        changed[draw.randrange(len(changed))] ^= 1 << draw.randrange(8)
    return bytes(changed)


#: Damage of a file by a full disk, a power failure or a disk, from its content.
DAMAGE = {
    "empty": lambda content, _: b"",
    "cut off": lambda content, draw: content[: draw.randrange(1, len(content))],
    "zeros": lambda content, _: bytes(len(content)),
    "zeros at the end": lambda content, draw: content[: draw.randrange(len(content))] + bytes(200),
    "longer": lambda content, draw: content + draw.randbytes(50),
    "flipped": flipped,
    "another": lambda _, draw: draw.randbytes(4000),
}


@pytest.fixture
def files(tmp_path):
    """Files of a kernel for two types, and what they hold."""
    files = kernels._Files(str(tmp_path), "kernel", (1, 2))
    codes = {"float": ["code", 1.0], "int": ["other code", 2]}
    for key, code in codes.items():
        files.save(key, code)
    return files, codes


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_file_counts_as_missing_and_is_written_again(files, tmp_path, damage):
    (files, codes), draw = files, random.Random(damage)
    sound = {path: path.read_bytes() for path in tmp_path.iterdir()}
    assert len(sound) == 3
    assert {key: files.load(key) for key in codes} == codes
    for path in sorted(sound) * 30:
        path.write_bytes(DAMAGE[damage](sound[path], draw))
        found = {key: files.load(key) for key in codes}
        assert all(found[key] in (None, code) for key, code in codes.items())
        assert found != codes, "the damage is seen"
        for key, code in codes.items():
            files.save(key, code)
        assert {key: files.load(key) for key in codes} == codes
        for other, content in sound.items():
            other.write_bytes(content)


def test_numba_alone_stops_at_a_damaged_file(tmp_path):
    numba = IndexDataCacheFile(str(tmp_path), "kernel", (1, 2))
    numba.save("float", ["code", 1.0])
    for path in tmp_path.iterdir():
        content = path.read_bytes()
        path.write_bytes(b"")
        with pytest.raises(EOFError):
            numba.load("float")
        path.write_bytes(content)


def test_files_of_two_states_never_belong_together(files, tmp_path):
    """Any file can be of an earlier or later state after a power failure, also if its checksum holds."""
    files, codes = files
    states = [{path.name: path.read_bytes() for path in tmp_path.iterdir()}]
    for path in tmp_path.iterdir():
        path.unlink()
    later = {"int": codes["int"], "float": ["newer code", 1.5]}  # in another order, which gives other numbers
    for key, code in later.items():
        files.save(key, code)
    states.append({path.name: path.read_bytes() for path in tmp_path.iterdir()})
    for chosen in product(states, repeat=3):
        for state, name in zip(chosen, sorted(states[0]), strict=True):
            (tmp_path / name).write_bytes(state[name])
        assert all(files.load(key) in (None, codes[key], later[key]) for key in codes)


def test_files_of_another_version_of_numba_are_not_read(files, tmp_path):
    files, codes = files
    other = kernels._Files(str(tmp_path), "kernel", (1, 2))
    other._version = "0.0"
    assert [other.load(key) for key in codes] == [None, None]
    assert {key: files.load(key) for key in codes} == codes


@pytest.mark.slow
def test_a_process_compiles_again_what_is_damaged_on_disk(toy):
    assert called(toy) == (21, True)
    assert called(toy) == (21, False)
    draw, places = random.Random(1), sorted(toy.rglob("*.nb[ic]"))
    sound = {path: path.read_bytes() for path in places}
    for path, damage in zip(places[::2], cycle(DAMAGE), strict=False):
        path.write_bytes(DAMAGE[damage](sound[path], draw))
        assert called(toy) == (21, True)
        assert called(toy) == (21, False)
    for path in places:  # exchange all files
        path.write_bytes(sound[places[places.index(path) - 1]])
    assert called(toy) == (21, True)
    assert called(toy) == (21, False)
