"""Files of users: a pipe may never begin and a device never end, so only regular files are read."""

import errno
import stat
from pathlib import Path

#: What else a path can lead to.
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


def require_regular(path: str | Path) -> None:
    """Refuse a path to anything but a regular file, before it is opened.

    Raises
    ------
    OSError
        With a reason in words as its ``strerror``, also where the system would raise another error.
    """
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "its name contains a null character", str(path))
    kind = stat.S_IFMT(Path(path).stat().st_mode)
    if kind != stat.S_IFREG:
        raise OSError(errno.EINVAL, f"it is {_KINDS.get(kind, 'no file')}, must be a regular file", str(path))
