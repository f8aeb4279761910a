"""The studies of the gallery run, and what they find is true."""

import runpy
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

GALLERY = Path(__file__).parents[1] / "docs" / "gallery"


@pytest.fixture
def run(monkeypatch):
    """Run a study and return its variables."""
    mpl.use("agg")
    monkeypatch.setattr("matplotlib.pyplot.show", lambda: None)
    with mpl.rc_context():
        yield lambda name: runpy.run_path(str(GALLERY / f"plot_{name}.py"))
    mpl.pyplot.close("all")


def test_every_study_is_tested():
    assert {path.stem for path in GALLERY.glob("*.py")} == {
        f"plot_{name}" for name in ("surface_and_contact", "scans", "device")
    }


@pytest.mark.slow
def test_surface_and_contact(run):
    found = run("surface_and_contact")
    assert found["heights"].std() == pytest.approx(3.4e-9, rel=0.05)
    means = [found["study"].energies(humidity).mean() for humidity in (0.44, 0.67, 0.92)]
    assert means == sorted(means)
    assert found["study"].energies(0.67).mean() == pytest.approx(6.3e-3, rel=0.06), "as in Table III"


@pytest.mark.slow
def test_scans(run):
    found = run("scans")
    deviation = (found["estimate"].moments - np.array(found["truth"])) / found["estimate"].errors
    assert np.all(np.abs(deviation) < 3.5)
    assert found["inspection"].reach.end == pytest.approx(found["spectrum"].cutoff, abs=2 * np.pi / 2e-6)


@pytest.mark.slow
def test_device(run, capsys):
    found = run("device")
    printed = capsys.readouterr().out
    assert printed.count("simulated limit") == 4
    for humidity in (0.44, 0.67):
        lengths = found["device"].safe_lengths(humidity).safe_length.values
        assert np.all(lengths[1:] < lengths[:1]), "a tip holds shorter beams"
