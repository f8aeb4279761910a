from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from beams import uniform_laws
from ground import C1, R1, UM, VECTORS, settings
from numpy.testing import assert_array_equal

from stiction.beam.energy import arrest_length
from stiction.beam.foundation import ELEMENT, LONGER, STRIP, foundation_length
from stiction.beam.resolution import ALONG_SHORTEST, SHORTEST
from stiction.chaos.model import draw_laws, fit
from stiction.contact import forcelaw
from stiction.stages.devices import opening
from stiction.streams import stream


def test_beams_that_are_not_s_shaped_have_no_crack():
    model = fit(VECTORS, 1.2 * VECTORS[:, 1].max(), 3, 0.001)
    address = partial(stream, 2021, "devices", "b")
    short = replace(C1.beam, length=450 * UM, elements=60)
    assert np.all(np.isinf(opening.arrests(C1, (short, 300), partial(draw_laws, model), 3, address)))


def test_devices_of_a_pair_share_their_random_numbers():
    thick = replace(C1, thickness=3 * UM)
    one, other = (opening.addresses(settings(device))(5).random() for device in (C1, thick))
    assert one == other != opening.addresses(settings(replace(C1, pair="c")))(5).random()


@pytest.mark.parametrize("thickness", [1.6, 2.6, 6.0])
@pytest.mark.parametrize("gap", [2, 20])
def test_long_beams_follow_the_mesh_rule_and_are_longer_than_their_cracks(thickness, gap):
    laws = uniform_laws(20)
    device = replace(C1, thickness=thickness * UM, gap=gap * UM)
    beam, points = opening.long_beam(device, laws)
    foundation = foundation_length(beam, laws)
    assert beam.element_length <= ELEMENT * foundation
    assert beam.length / points == pytest.approx(1.5 * UM, rel=1e-12)
    assert beam.length / points <= STRIP * foundation
    assert points % beam.elements == 0
    crack = arrest_length(float(forcelaw.energy(laws[0])), beam)
    assert 1.3 <= beam.length / crack < 1.3 + 90 * UM / beam.length * 1.5
    longest, strips = min(ELEMENT * foundation, SHORTEST * crack / ALONG_SHORTEST), points // beam.elements
    assert strips <= opening.PER_ELEMENT
    assert strips == opening.PER_ELEMENT or strips * 1.5 * UM <= longest < (strips + 1) * 1.5 * UM


#: Cantilever on ground with single patches that are so strong that strips of 1.5 µm do not resolve them.
LOW = replace(C1, gap=2 * UM)
SOME_STRONG = np.concatenate([uniform_laws(19), [[1e9, 8e-9, 8e9, 1e10]]])


@pytest.mark.parametrize("device", [LOW, replace(R1, strip=3 * UM)])
def test_strips_that_are_far_too_long_are_not_simulated_and_all_devices_have_the_safe_side(device):
    assert device.strip > LONGER * device.opening.longest_strip(device, SOME_STRONG)
    ground = opening.ground_of(device, SOME_STRONG)

    def draw(number, _):
        return np.resize(SOME_STRONG, (number, 4))

    safe = opening.least_length(device, SOME_STRONG)
    assert_array_equal(opening.arrests(device, ground, draw, 3, lambda _: None), [safe] * 3)
    assert safe < 0.5 * opening.least_length(device, SOME_STRONG[:19])


def test_no_crack_stops_before_the_length_that_all_devices_have_where_nothing_is_simulated():
    fine, each = replace(LOW, strip=0.1 * UM), 15
    resolved = opening.ground_of(fine, SOME_STRONG)
    assert resolved[1] > 0

    def draw(number, rng):
        patches = SOME_STRONG[rng.integers(len(SOME_STRONG), size=number // each)]
        return np.repeat(patches, each, axis=0)

    stopped = opening.arrests(fine, resolved, draw, 4, partial(stream, 1, "ground"))
    assert np.all(stopped > opening.least_length(LOW, SOME_STRONG))
    # Control: without its strong patches, the ground would have a bound that is none.
    assert np.any(stopped < opening.least_length(LOW, SOME_STRONG[:19]))


@pytest.mark.parametrize(("device", "thickness"), [(C1, 1.2), (R1, 0.25)])
def test_what_the_first_samples_let_pass_near_the_limit_goes_on_with_the_strips_as_they_are(device, thickness):
    laws, near = uniform_laws(20), replace(device, thickness=thickness * UM)
    ground, strips = near.opening.resolved(near, laws)
    assert near.opening.longest_strip(near, laws) < near.strip
    assert ground.length / strips == pytest.approx(near.strip, rel=1e-12)


def test_a_bridge_has_two_arms_under_its_tension_and_its_middle_is_resolved():
    assert R1.beam.tension == pytest.approx(50e6 * 60e-12)
    assert R1.opening.arms == 2 * C1.opening.arms == 2
    zone, strips = R1.opening.resolved(R1, uniform_laws(20))
    assert zone.tension == R1.beam.tension
    assert zone.length / strips == pytest.approx(R1.strip, rel=1e-12)
    assert C1.opening.resolved(C1, uniform_laws(20)) == opening.long_beam(C1, uniform_laws(20))
    assert C1.beam.tension == 0
