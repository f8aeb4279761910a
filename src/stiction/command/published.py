"""Study of published scans."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from filecmp import cmp
from pathlib import Path

import yaml

from stiction.command import container
from stiction.command.launch import RefusedError
from stiction.errors import ScanError
from stiction.scans.published import unpack

#: Name of the study, and beginning of the name of the folder of its drafts.
_STUDY, _DRAFTS = "published.yaml", ".published-"
#: Largest number of sentences about what is left out; the schema takes one more.
_MOST_SENTENCES = 999


def written(source: str, folder: Path) -> Path:
    """Write the maps of a container and a study of its surfaces into a folder. Path of the study.

    All files are written into a folder of drafts first. Whatever ends this, there is a study only if all its files are
    there, and the same container can be written again.

    Raises
    ------
    RefusedError
        If there is no such container, it is damaged or without maps, or a file exists already.
    """
    if os.path.lexists(folder / _STUDY):
        raise RefusedError(f"{folder / _STUDY} exists already: nothing was written")
    content = container.content(source)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with _drafts(folder) as drafts:
            surfaces = unpack(content, source, drafts)
            (drafts / _STUDY).write_text(_study(source, surfaces), encoding="utf-8")
            _move(drafts, folder)
    except ScanError as refusal:
        raise RefusedError(_one_line(f"{refusal.file} {refusal.reason}")) from None
    except OSError as error:
        raise RefusedError(f"{folder} cannot be written: {error.strerror}") from error
    return folder / _STUDY


@contextmanager
def _drafts(folder) -> Iterator[Path]:
    """Folder for drafts, which is removed at the end. Those of killed processes are removed before."""
    for stale in folder.glob(f"{_DRAFTS}*"):
        shutil.rmtree(stale, ignore_errors=True)
    drafts = Path(tempfile.mkdtemp(prefix=_DRAFTS, dir=folder))
    try:
        yield drafts
    finally:
        shutil.rmtree(drafts, ignore_errors=True)


def _move(drafts, folder):
    """Move all drafts into a folder, the study last. A file of the same content remains."""
    maps = sorted(path.name for path in drafts.iterdir() if path.name != _STUDY)
    for name in maps:
        target = folder / name
        same = target.is_file() and not target.is_symlink() and cmp(drafts / name, target, shallow=False)
        if os.path.lexists(target) and not same:
            raise RefusedError(f"{target} exists already: nothing was written")
    for name in (*maps, _STUDY):
        (drafts / name).replace(folder / name)


def _study(source, surfaces):
    """Text of a study of surfaces with maps. Its comments say why other surfaces have none."""
    sections = {
        surface.name: {"scans": {"files": list(surface.files)} | _left_out(surface)}
        for surface in surfaces
        if surface.files
    }
    entries = yaml.safe_dump({"surfaces": sections}, allow_unicode=True, sort_keys=False)
    head = [f"Published scans of {source}"]
    head += [f"{surface.name}: {why}" for surface in surfaces if not surface.files for why in surface.left_out]
    return "".join(f"# {_one_line(line)}\n" for line in head) + entries


def _one_line(text):
    """Text as one line of signs that can be printed."""
    return "".join(sign if sign.isprintable() else " " for sign in text)


def _left_out(surface):
    """Flags of the sheet about measurements that are not used, or were changed."""
    return {"left_out": list(surface.left_out[:_MOST_SENTENCES])} if surface.left_out else {}
