"""Results are identical byte for byte for any folder, number of cores (2, 4, 1) and number of chunks (2, 7, 1)."""

import json
import shutil
import subprocess
import sys

import xarray as xr
from conftest import BEAMS, ROOT, command, datasets, snakemake


def test_neither_cores_nor_chunks_change_a_byte(undisturbed, tiny, tmp_path, overlay):
    snakemake(tmp_path, BEAMS, configs=[tiny, overlay("contact: {chunks: 7}")], cores=4)
    assert datasets(tmp_path) == datasets(undisturbed)


def test_a_moved_checkout_gives_the_same_bytes_on_one_core(undisturbed, tiny, tmp_path, overlay):
    for name in ("Snakefile", "config.yaml"):
        shutil.copy2(ROOT / name, tmp_path)
    for name in ("workflow", "src", "profiles"):
        # Includes the cache of compiled kernels, which numba accepts because the sources are the same.
        shutil.copytree(ROOT / name, tmp_path / name)
    environment = command(tmp_path)["env"]
    words = [sys.executable, "-m", "snakemake", BEAMS, "--cores", "1", "--configfile", "config.yaml", tiny]
    done = subprocess.run([*words, overlay("contact: {chunks: 1}")], cwd=tmp_path, env=environment, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert datasets(tmp_path) == datasets(undisturbed)


def test_datasets_contain_settings_but_no_time_or_host(smoke):
    paths = sorted((smoke / "results").rglob("*.nc"))
    assert {"beams", "chaos", "character", "contact", "forces", "heights", "spectrum"} <= {p.parent.name for p in paths}
    for path in paths:
        with xr.open_dataset(path) as dataset:
            assert set(dataset.attrs) == {"Conventions", "stage", "name", "settings", "before"}
            json.loads(dataset.attrs["settings"])
