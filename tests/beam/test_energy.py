from dataclasses import replace

import numpy as np
from beams import E_BAR, PAPER, bending_energy, uniform_laws
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from stiction.beam.energy import apparent_adhesion_energy, arrest_length
from stiction.beam.release import crack_length, release


def elastic_energy(crack, beam):
    """Elastic energy of an S-shape without tension, 6 EI h² / l³ [J]."""
    return 6 * beam.bending_stiffness * beam.gap**2 / crack**3


def test_eq_13_by_hand():
    # 1.5 · 164e9 · (20e-6)² · (2.6e-6)³ / (1e-3)⁴
    assert_allclose(apparent_adhesion_energy(1e-3, PAPER), 1.5 * 164e9 * 4e-10 * 1.7576e-17 / 1e-12, rtol=1e-12)
    assert_allclose(arrest_length(6.8e-3, PAPER), 710.2e-6, rtol=1e-4)


@given(st.floats(1e-4, 2e-3))
def test_eq_13_and_its_inverse_are_a_round_trip(crack):
    assert_allclose(arrest_length(apparent_adhesion_energy(crack, PAPER), PAPER), crack, rtol=1e-12)


@given(st.floats(1e-4, 2e-3), st.floats(1e-6, 1e-4), st.floats(1e-6, 1e-5), st.floats(1e-7, 1e-4))
def test_adhesion_energy_is_the_elastic_energy_released_per_area(crack, width, thickness, gap):
    beam = replace(PAPER, width=width, thickness=thickness, gap=gap)
    step = 1e-4 * crack
    released = elastic_energy(crack - step, beam) - elastic_energy(crack + step, beam)
    assert_allclose(released / (2 * step * width), apparent_adhesion_energy(crack, beam), rtol=1e-6)


def test_elastic_energy_is_that_of_the_clamped_cubic():
    crack = 600e-6
    s = np.minimum(PAPER.nodes / crack, 1)  # 80 elements, then flat
    cubic = PAPER.gap * np.stack([s**2 * (3 - 2 * s), 6 * s * (1 - s) / crack], axis=-1)
    assert_allclose(bending_energy(PAPER, cubic), elastic_energy(crack, PAPER), rtol=1e-10)


def test_released_beams_release_the_adhesion_energy_of_the_area_that_opens():
    beam = replace(PAPER, elements=800)
    ends = []
    for factor in (1.05, 0.95):
        laws = uniform_laws(4000, factor * E_BAR, factor * 2e6)
        deflection = release(beam, laws, 240e-6).deflection
        ends.append((bending_energy(beam, deflection), crack_length(beam, laws, deflection)))
    (more, short), (less, long) = ends
    # 1 %: the process zone, 3 µm of 700 µm, changes with the force law as well
    assert_allclose((more - less) / (beam.width * (long - short)), E_BAR, rtol=0.01)
