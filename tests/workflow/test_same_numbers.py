"""Results are the same bytes in any folder, for 2, 4 and 1 cores, 2, 7 and 1 chunks, and jobs that are no forks."""

import json
import shutil
import subprocess
import sys

import pytest
import xarray as xr
from conftest import BEAMS, ROOT, command, datasets, snakemake


@pytest.mark.slow
def test_neither_cores_nor_chunks_change_a_byte(undisturbed, tiny, tmp_path, overlay):
    done = snakemake(tmp_path, BEAMS, configs=[tiny, overlay("contact: {chunks: 7}")], cores=4)
    assert "Each job starts an interpreter of its own" not in done.stdout
    assert datasets(tmp_path) == datasets(undisturbed)


#: Snakemake whose way to start scripts is not known to `stiction.run.snakemake_patches`.
ANOTHER = """
import sys, snakemake.cli, snakemake.script
known = snakemake.script.PythonScript.execute_script
snakemake.script.PythonScript.execute_script = lambda job, fname, edit=False, more=None: known(job, fname, edit)
snakemake.cli.main()
"""


@pytest.mark.nightly
def test_a_moved_checkout_gives_the_same_bytes_on_one_core_without_forks(undisturbed, tiny, tmp_path, overlay):
    for name in ("Snakefile", "config.yaml"):
        shutil.copy2(ROOT / name, tmp_path)
    for name in ("workflow", "src", "profiles"):
        # Includes the cache of compiled kernels, which numba accepts because the sources are the same.
        shutil.copytree(ROOT / name, tmp_path / name)
    environment = command(tmp_path)["env"]
    words = [sys.executable, "-c", ANOTHER, BEAMS, "--cores", "1", "--configfile", "config.yaml", tiny]
    done = subprocess.run(
        [*words, overlay("contact: {chunks: 1}")], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "Each job starts an interpreter of its own" in done.stdout + done.stderr
    assert datasets(tmp_path) == datasets(undisturbed)


def test_datasets_contain_settings_but_no_time_or_host(smoke):
    paths = sorted((smoke / "results").rglob("*.nc"))
    assert {"beams", "chaos", "character", "contact", "forces", "heights", "spectrum"} <= {p.parent.name for p in paths}
    for path in paths:
        with xr.open_dataset(path) as dataset:
            own = {"stage", "name", "layout", "settings", "before"}
            assert set(dataset.attrs) == own | {"Conventions", "title", "source", "references"}
            json.loads(dataset.attrs["settings"])
