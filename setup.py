"""Build the wheel: what Snakemake needs travels with the package, although it lies outside of ``src``."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

#: Files and folders of the repository that `stiction.command.launch` expects in the folder ``project`` of the package.
TRAVELS = ("Snakefile", "config.yaml", "profiles", "workflow", "examples/devices.yaml")


class WithWorkflow(build_py):
    """Copies the package, and the workflow into it; an editable installation uses the workflow where it is."""

    def run(self):
        """Copy."""
        super().run()
        if not self.editable_mode:
            for name in TRAVELS:
                self._copy(Path(name), Path(self.build_lib, "stiction", "project", name))

    @staticmethod
    def _copy(source, target):
        """Copy a file, or a folder without what Python has compiled."""
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, target)


setup(cmdclass={"build_py": WithWorkflow})
