"""Surfaces of a configuration described by scans, in the view of the jobs reading them."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stiction.config.materials import Materials
from stiction.config.scans import digest, evaluation, is_measured, source


@dataclass(frozen=True)
class Scans:
    """Scans of the surfaces of a configuration."""

    config: dict  #: complete and valid

    @property
    def surfaces(self) -> list[str]:
        """Surfaces described by scans."""
        return [name for name, entry in self.config["surfaces"].items() if is_measured(entry)]

    @property
    def described_by_numbers(self) -> list[str]:
        """Surfaces described by numbers."""
        return [name for name in self.config["surfaces"] if name not in self.surfaces]

    def sides(self, pair: str) -> list[str]:
        """Surfaces of a pair described by scans, each once."""
        return [name for name in dict.fromkeys(Materials(self.config).sides(pair)) if name in self.surfaces]

    def files(self, surface: str) -> dict[str, str]:
        """Files of the scans of a surface, by number. None if it is described by numbers."""
        files = self.config["surfaces"][surface].get("scans", {}).get("files", ())
        return {str(number): file for number, file in enumerate(files)}

    def path(self, surface: str, number: str) -> str:
        """File of a scan, relative to the working directory, so a moved folder changes nothing."""
        return os.path.relpath(self.files(surface)[number])

    def scan(self, surface: str, number: str) -> dict[str, Any]:
        """File of a scan by its content, and settings for reading it. The file's folder does not affect the result."""
        path = self.files(surface)[number]
        return {"file": Path(path).name, "sha256": digest(path), "source": source(self.config["surfaces"][surface])}

    def estimate(self, surface: str) -> dict[str, Any]:
        """Settings for the evaluation of the scans of a surface, with the names of the files."""
        return {
            "seed": self.config["seed"],
            "evaluation": evaluation(self.config["surfaces"][surface], self.config["scans"]),
            "model_scans": self.config["scans"]["model_scans"],
            "files": [Path(path).name for path in self.files(surface).values()],
            "left_out": self.config["surfaces"][surface]["scans"].get("left_out", []),
        }
