"""Study of published scans."""

from pathlib import Path

import yaml

from stiction.command.launch import RefusedError
from stiction.errors import ScanError
from stiction.run.atomic import save_text
from stiction.scans.published import unpack


def written(source: str, folder: Path) -> Path:
    """Write the maps of a container and a study of its surfaces into a folder. Path of the study.

    Raises
    ------
    RefusedError
        If there is no such container, it is damaged or without maps, or a file exists already.
    """
    study = folder / "published.yaml"
    if study.exists():
        raise RefusedError(f"{study} exists already: nothing was written")
    folder.mkdir(parents=True, exist_ok=True)
    try:
        surfaces = unpack(source, folder)
    except ScanError as refusal:
        raise RefusedError(f"{refusal.file} {refusal.reason}") from None
    sections = {
        surface.name: {"scans": {"files": list(surface.files)} | _left_out(surface)}
        for surface in surfaces
        if surface.files
    }
    entries = yaml.safe_dump({"surfaces": sections}, allow_unicode=True, sort_keys=False)
    save_text(f"# Published scans of {source}\n{entries}", study)
    return study


def _left_out(surface):
    """Flags of the sheet about measurements that are not used, or were changed."""
    return {"left_out": list(surface.left_out)} if surface.left_out else {}
