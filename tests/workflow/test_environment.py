"""Modules of the user: found by jobs, but never in place of the package next to the Snakefile."""

import os
import subprocess
import sys
from types import SimpleNamespace

import pytest
from conftest import ROOT, command


@pytest.fixture
def modules(tmp_path, monkeypatch):
    """Folder on the user's PYTHONPATH with a module, and with a package that has the name of this one."""
    (tmp_path / "stiction").mkdir()
    (tmp_path / "stiction" / "__init__.py").write_text("raise ImportError('another package')\n")
    (tmp_path / "mine.py").write_text("LENGTH = 7\n")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(["", str(tmp_path), ""]))
    return tmp_path


def imported(statement):
    """What a new interpreter prints."""
    done = subprocess.run([sys.executable, "-c", statement], capture_output=True, text=True)
    return done.stdout.strip() or done.stderr


@pytest.mark.slow
@pytest.mark.usefixtures("modules")
def test_a_package_of_the_same_name_on_the_path_of_the_user_is_not_used(tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    assert "another package" in imported("import stiction")
    plan = command(folder, "-n", "results/heights/B1.nc")
    assert plan["env"]["PYTHONPATH"] == os.environ["PYTHONPATH"]
    done = subprocess.run(**plan, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert "another package" not in done.stdout + done.stderr


def test_snakemake_imports_the_package_only_where_it_is_used(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "src"))
    assert imported("import snakemake_logger_plugin_stiction, sys; print('stiction' in sys.modules)") == "False"


def test_jobs_find_the_modules_of_the_user_after_those_of_the_package(modules, monkeypatch):
    monkeypatch.setattr(sys, "path", sys.path[:])
    head, found, _ = (ROOT / "Snakefile").read_text(encoding="utf-8").partition("\nconfigfile:")
    assert found
    exec(compile(head, "Snakefile", "exec"), {"workflow": SimpleNamespace(current_basedir=str(ROOT))})
    assert os.environ["PYTHONPATH"] == os.pathsep.join([str(ROOT / "src"), str(modules)])
    assert (
        imported("import mine, stiction; print(mine.LENGTH, stiction.__file__)") == f"7 {ROOT}/src/stiction/__init__.py"
    )
