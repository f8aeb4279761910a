"""Public names ``stiction.name``: complete, fast to import, and visible to editors."""

import importlib
import pydoc
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from vectors import sampled_vectors

import stiction
from stiction.progress import progress
from stiction.stages.laws import forces

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("name", stiction.__all__)
def test_every_public_name_is_what_its_module_defines(name):
    module, attribute = stiction._PLACES[name]
    value = getattr(stiction, name)
    assert value is getattr(importlib.import_module(module), attribute)
    assert value.__module__ == module, "defined elsewhere"
    assert value.__doc__
    assert name in dir(stiction)


def test_an_unknown_name_raises_the_usual_attribute_error():
    with pytest.raises(AttributeError, match="module 'stiction' has no attribute 'relase'"):
        stiction.relase  # noqa: B018


def test_force_laws_of_a_dataset_are_evaluated_and_drawn_by_public_names():
    samples = sampled_vectors(400, 0.24)
    dataset = forces.layout(samples, 1.2 * samples[:, 1].max(), np.arange(3.0), np.zeros((1, 3)))
    vectors, limit = stiction.force_vectors(dataset)
    laws = stiction.force_laws(vectors, limit)
    assert_allclose(stiction.law_energy(laws), vectors[:, 0])
    assert_allclose(stiction.law_pressure(laws, vectors[:, 2]), -vectors[:, 1])
    drawn = stiction.draw_laws(stiction.fit_chaos(vectors, limit, 3, 0.001), 2000, stiction.stream(1, "notebook"))
    assert_allclose(stiction.law_energy(drawn).mean(), vectors[:, 0].mean(), rtol=0.05)


def test_help_shows_every_public_name():
    text = pydoc.plain(pydoc.render_doc(stiction))
    assert not [name for name in stiction.__all__ if name not in text]


def test_progress_can_be_turned_off_and_on_again(capfd):
    try:
        for shown in (False, True):
            stiction.show_progress(shown)
            assert list(progress(range(3), "steps")) == [0, 1, 2]
            assert ("steps" in capfd.readouterr().err) == shown
    finally:
        stiction.show_progress()


def test_importing_the_package_imports_none_of_its_modules():
    code = "import sys, stiction; dir(stiction); print(*sorted(m for m in sys.modules if m.startswith('stiction.')))"
    code += "; assert not {'typing', 'numpy', 'yaml'} & set(sys.modules)"
    path = f"import sys; sys.path.insert(0, {str(ROOT / 'src')!r}); "
    done = subprocess.run([sys.executable, "-c", path + code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_the_version_is_that_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert stiction.__version__ == project["version"]
