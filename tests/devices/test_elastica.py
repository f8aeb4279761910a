"""Steep beams: the elastica, which bends far, sticks up to lengths that grow as the limit says."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from stiction.devices.limits import rules


def energy(length, clamped):
    """Bending energy over E I of an inextensible beam that is deflected by 1 and slides freely.

    θ'' = -F cos θ without a slope at its start; at its end without a slope if clamped, else without a moment.
    """
    x, small = np.linspace(0, 1, 101), 1 / length
    start = (
        [6 * small * x * (1 - x), 6 * small * (1 - 2 * x), small * (3 * x**2 - 2 * x**3)]
        if clamped
        else [3 * small * (x - x**2 / 2), 3 * small * (1 - x), small * (1.5 * x**2 - 0.5 * x**3)]
    )
    found = solve_bvp(
        lambda _, y, force: np.array([y[1], -force[0] * np.cos(y[0]), np.sin(y[0])]),
        lambda a, b, _: np.array([a[0], b[0] if clamped else b[1], a[2], b[2] - small]),
        x,
        np.array(start),
        p=[12 * small if clamped else 3 * small],
        tol=1e-10,
        max_nodes=10**5,
    )
    fine = np.linspace(0, 1, 2001)
    return np.trapezoid(found.sol(fine)[1] ** 2, fine) / 2 / length


@pytest.mark.parametrize(("clamped", "linear"), [(True, 18.0), (False, 4.5)], ids=["along the beam", "by its tip"])
def test_a_steep_beam_sticks_up_to_a_longer_length_than_by_linear_theory(clamped, linear):
    for slope in (0.101, 0.15, 0.299):
        length, step = 1.5 / slope, 1e-3
        released = (energy(length * (1 - step), clamped) - energy(length * (1 + step), clamped)) / (2 * step * length)
        longer = length * (released / linear) ** 0.25 - 1  # over the length with this energy by linear theory
        limit = rules.large_rotation(1.0, length)
        assert longer == pytest.approx(limit.amount, rel=0.1)
        assert longer != pytest.approx(2 * limit.amount, rel=0.1), "the control: another growth is seen"
    assert np.isnan(rules.large_rotation(1.0, 1.5 / 0.31).amount)
