"""Nearest feasible moments are those of the physics, and no process of a user computes them again."""

import pytest

from stiction.config.surfaces import moments
from stiction.config.surfaces.moments import nearest_shape
from stiction.surface import feasible

SHAPES = [(-0.76, 3.9), (-0.5, 3.6)]


@pytest.fixture
def another_process(tmp_path, monkeypatch):
    """Forget what this process knows; its user's folder remains."""
    monkeypatch.setattr(moments, "own_folder", lambda: tmp_path)

    def forget():
        nearest_shape.cache_clear()
        moments._code.cache_clear()

    forget()
    yield forget
    monkeypatch.undo()
    forget()


def computed(monkeypatch):
    """List that grows with each computation."""
    seen, compute = [], feasible.nearest_feasible
    monkeypatch.setattr(feasible, "nearest_feasible", lambda *given: seen.append(given) or compute(*given))
    return seen


@pytest.mark.parametrize(("skewness", "kurtosis"), [(-0.76, 3.9), (-0.1, 3.2)])
def test_kept_moments_are_those_of_the_physics_to_the_last_digit(another_process, skewness, kurtosis):
    expected = feasible.nearest_feasible(skewness, kurtosis)[:2]
    assert nearest_shape(skewness, kurtosis) == expected
    another_process()
    assert nearest_shape(skewness, kurtosis) == expected


def test_other_processes_compute_only_what_is_new(another_process, monkeypatch):
    seen = computed(monkeypatch)
    for _ in range(2):
        for shape in SHAPES:
            nearest_shape(*shape)
        another_process()
    assert seen == SHAPES
    nearest_shape(-0.8, 3.9)
    assert seen[2:] == [(-0.8, 3.9)], "control"


def test_other_code_computes_again(another_process, monkeypatch):
    seen = computed(monkeypatch)
    for code in "ab":
        monkeypatch.setattr(moments, "fingerprint", lambda *_, code=code, **__: code)
        nearest_shape(-0.76, 3.9)
        another_process()
    assert len(seen) == 2


@pytest.mark.usefixtures("another_process")
def test_moments_without_a_density_are_refused_each_time(monkeypatch):
    seen = computed(monkeypatch)
    for _ in range(2):
        with pytest.raises(ValueError, match="no maximum-entropy density"):
            nearest_shape(0.0, 6.0)
    assert len(seen) == 2
