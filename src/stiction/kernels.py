"""Decorator of compiled functions. It keeps their machine code on disk as long as it belongs to the sources.

Machine code contains the kernels that a kernel calls and the constants that it uses. Numba compiles a kernel again if
its own file has changed, but not if one of these has changed in another file. Here the names of its files have a digest
of all sources on which it depends, so that no process can load obsolete code, whatever folder Numba uses and however
many processes start at once. A stamp inside the files, such as Numba's, would not be enough: they cannot be read if
they name a type that the sources no longer define.
"""

import fcntl
import pickle
import re
from collections.abc import Callable
from contextlib import suppress
from functools import cache, partial
from hashlib import sha256
from itertools import count
from pathlib import Path
from typing import Any

from numba import config, njit
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile

from stiction.temporary import own_folder

_PACKAGE = Path(__file__).parent
#: Size of a checksum [bytes].
_CHECKSUM = 32
#: Module, and names in it. A syntax tree takes 30 times as long, at every start.
_IMPORT = re.compile(r"^\s*(?:from|import)\s+stiction\.?([\w.]*)(?:\s+import\s+(\([^)]*\)|.*))?", re.MULTILINE)


def kernel(function: Callable | None = None, **options: Any) -> Callable:
    """Compile a function of this package with Numba, without the lock of the interpreter. Keep the result on disk.

    Parameters
    ----------
    function : callable
    **options
        Further options of ``numba.njit``, as in ``@kernel(inline="always")``.
    """
    if function is None:
        return partial(kernel, **options)
    compiled = njit(nogil=True, **options)(function)
    with suppress(OSError):  # where no folder at all can be written, every process compiles
        compiled._cache = _cache(function)  # as with njit(cache=True), which has no choice of the class
    return compiled


def _cache(function):
    """Files of a kernel, among temporary files if neither the package nor the home can be written."""
    try:
        return _Cache(function)
    except RuntimeError:
        before, config.CACHE_DIR = config.CACHE_DIR, str(own_folder())
        try:
            return _Cache(function)
        finally:
            config.CACHE_DIR = before


class _Names(CompileResultCacheImpl):
    """Names of the files of a kernel, with the digest of its sources."""

    def __init__(self, function):
        super().__init__(function)
        self._filename_base += f".{_digest(Path(function.__code__.co_filename))}"


class _Files(IndexDataCacheFile):
    """Files of a kernel: an index of its types, and machine code for each. A damaged file counts as missing.

    A full disk or a power failure can damage them. Numba would run damaged machine code. The index contains the
    checksums of the other files, so that files of two states never belong together, and begins with its own.
    """

    def load(self, key):
        """Machine code for some types, ``None`` without it."""
        name, checksum = self._load_index().get(key, ("", b""))
        content = _content(self._data_path(name))
        return pickle.loads(content) if name and sha256(content).digest() == checksum else None

    def save(self, key, data):
        """Save machine code for some types, then the index that names it."""
        overloads, content = self._load_index(), self._dump(data)
        used = {name for name, _ in overloads.values()}
        name, _ = overloads.get(key) or (next(name for name in map(self._data_name, count(1)) if name not in used), b"")
        with self._open_for_write(self._data_path(name)) as file:
            file.write(content)
        self._save_index({**overloads, key: (name, sha256(content).digest())})

    def _load_index(self):
        stored = _content(self._index_path)
        if self._checksum(content := stored[_CHECKSUM:]) != stored[:_CHECKSUM]:
            return {}
        stamp, overloads = pickle.loads(content)
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads):
        content = self._dump((self._source_stamp, overloads))
        with self._open_for_write(self._index_path) as file:
            file.write(self._checksum(content) + content)

    def _checksum(self, content):
        """Checksum of an index of this version of Numba."""
        return sha256(self._version.encode() + content).digest()


def _content(path):
    """Content of a file, empty if it cannot be read."""
    with suppress(OSError):
        return Path(path).read_bytes()
    return b""


class _Cache(FunctionCache):
    """Files of a kernel. Those of other sources are removed when it is saved."""

    _impl_class = _Names

    def __init__(self, function):
        super().__init__(function)
        names, stamp = self._impl.filename_base, self._impl.locator.get_source_stamp()
        self._cache_file = _Files(self._cache_path, names, stamp)

    def save_overload(self, sig, data):
        """Save a compiled kernel, unless the disk refuses."""
        with suppress(OSError):  # a full disk costs time alone
            self._save(sig, data)

    def _save(self, sig, data):
        # Processes that saved a kernel for different types at once could exchange their machine code.
        folder = Path(self.cache_path)
        folder.mkdir(parents=True, exist_ok=True)  # it may have been removed since this module was imported
        with (folder / "lock").open("a") as alone:
            with suppress(OSError):  # on file systems without locks
                fcntl.flock(alone, fcntl.LOCK_EX)
            super().save_overload(sig, data)
        current = self._impl.filename_base  # module.function-line.py311.digest
        function, python = re.fullmatch(r"(.*)-\d+(\.py\w+)\.\w+", current).groups()
        for path in folder.glob(f"{function}-*{python}.*nb[ic]"):
            if not path.name.startswith(f"{current}."):
                path.unlink(missing_ok=True)


def _digest(path):
    """Digest of a source file and of all its imported files of the package, directly or through others."""
    reached, unread = {}, {path}
    while unread:
        reached |= {path: _read(path) for path in unread}
        unread = {other for path in unread for other in reached[path][1]} - reached.keys()
    return sha256("".join(sorted(digest for digest, _ in reached.values())).encode()).hexdigest()[:16]


@cache  # a file that changes later does not change the code that this process has imported
def _read(path):
    """Digest of the name and the text of a source file, and its imported files of the package."""
    text = path.read_text(encoding="utf-8")
    digest = sha256(f"{path.relative_to(_PACKAGE)}\n{text}".encode()).hexdigest()
    places = [
        f"{module}.{name}" for module, names in _IMPORT.findall(text) for name in ["", *re.findall(r"\w+", names)]
    ]
    files = {_PACKAGE.joinpath(*name_in_package.strip(".").split(".")).with_suffix(".py") for name_in_package in places}
    return digest, {file for file in files if file.is_file()}
