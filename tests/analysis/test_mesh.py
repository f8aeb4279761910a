from dataclasses import replace

import numpy as np
import pytest
from beams import PAPER, scattered_laws, uniform_laws

from stiction.analysis.mesh import arrest_on_uniform_ground, finer_mesh, resolution, rigid_energy, whole_meshes
from stiction.beam.foundation import ELEMENT, STRIP, foundation_length
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


@pytest.mark.parametrize("factor", [1e-2, 1, 100])
def test_the_finer_mesh_is_twice_as_fine_as_the_one_in_use_and_as_the_law_calls_for(factor):
    law = uniform_laws(1, factor * forcelaw.energy(LAW), factor * LAW[0])[0]
    beam, points = finer_mesh(PAPER, law, 1000)
    length = foundation_length(PAPER, law[None])
    assert points % 1000 == points % beam.elements == 0
    assert 2 * beam.element_length <= min(PAPER.element_length, ELEMENT * length)
    assert 2 * PAPER.length / points <= min(PAPER.length / 1000, STRIP * length) * (1 + 1e-12)
    assert points <= 2000 * (1 + PAPER.length / 1000 / (STRIP * length))


def test_error_of_the_mesh_is_that_against_a_very_fine_one():
    law = uniform_laws(1, 60 * forcelaw.energy(LAW), 60 * LAW[0])[0]
    fine = arrest_on_uniform_ground(replace(PAPER, elements=4000), law, 8000)
    found = resolution(PAPER, law, 1000)
    error = found.coarse.crack_length / fine.crack_length - 1
    assert abs(error) > 0.03  # elements of 6 foundation lengths
    assert found.error == pytest.approx(error, abs=0.004)  # a quarter of 1 %, and rounding
    assert found.excess == pytest.approx(fine.energy / forcelaw.energy(law), abs=0.016)


def test_a_stiff_beam_has_the_mean_energy_of_laws_that_push_and_pull_at_the_same_distances():
    # However far a law reaches beyond the others
    laws = np.stack([LAW, LAW * [1, 1, 1, 0.04], LAW * [0.5, 1, 1, 0.3]])
    assert rigid_energy(laws) == pytest.approx(forcelaw.energy(laws).mean(), rel=1e-4)


def test_a_stiff_beam_has_the_energy_of_a_single_law_and_less_than_the_mean_of_laws_at_several_distances():
    # The trapezoidal rule on 20000 nodes and the tail beyond 20 / a_right
    assert rigid_energy(LAW[None]) == pytest.approx(forcelaw.energy(LAW), rel=1e-5)
    weaker = np.stack([LAW, LAW * [0.2, 1, 1, 1]])
    assert rigid_energy(weaker) == pytest.approx(forcelaw.energy(weaker).mean(), rel=1e-5)
    apart = np.stack([LAW, LAW + [0, 3e-9, 0, 0]])
    assert rigid_energy(apart) < 0.7 * forcelaw.energy(LAW)
    scattered = scattered_laws(np.random.default_rng(4), 200, 0.5)
    assert rigid_energy(scattered) < forcelaw.energy(scattered).mean()
