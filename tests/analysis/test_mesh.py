from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, uniform_laws

from stiction.analysis.mesh import arrest_on_uniform_ground, whole_meshes
from stiction.contact import forcelaw

LAW = uniform_laws(1)[0]


def test_gamma_tends_to_the_energy_of_uniform_ground_as_mesh_and_points_get_finer():
    excess = []
    for elements, points in ((50, 200), (200, 1000), (400, 4000)):
        arrest = arrest_on_uniform_ground(replace(PAPER, elements=elements), LAW, points)
        excess.append(arrest.energy / forcelaw.energy(LAW) - 1)
    assert excess[0] > excess[1] > excess[2] > 0
    # The crack length ends at the first contact, a little before the end of the crack of an ideal S-shape.
    assert excess[2] < 0.02 < 0.5 < excess[0]


@pytest.mark.parametrize("share", [0.001, 0.02])  # free, and an arc
def test_a_beam_that_does_not_stick_has_no_crack_length(share):
    weak = LAW * np.array([share, 1, 1, 1])
    arrest = arrest_on_uniform_ground(PAPER, weak, 1000)
    assert np.isnan([arrest.crack_length, arrest.energy]).all()


def test_meshes_divide_the_beam_evenly():
    meshes = whole_meshes(30.0, [15.0, 7.5, 4.0], [7.5, 3.0])
    assert meshes == [(15.0, 7.5), (7.5, 7.5), (15.0, 3.0)]
    with pytest.raises(ValueError, match="no elements of"):
        whole_meshes(30.0, [4.0], [1.0])
