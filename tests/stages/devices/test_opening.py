from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from beams import uniform_laws
from ground import C1, R1, UM, VECTORS, settings

from stiction.beam.energy import arrest_length
from stiction.beam.foundation import ELEMENT, STRIP, foundation_length
from stiction.beam.resolution import ALONG_SHORTEST, SHORTEST
from stiction.chaos.model import draw_laws, fit
from stiction.config.files import load
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


def test_a_beam_that_its_strips_do_not_resolve_is_refused_with_the_key_that_helps():
    with pytest.raises(ValueError, match="strips of 1.5 µm do not resolve") as refused:
        opening.long_beam(replace(C1, thickness=0.5 * UM), uniform_laws(20))
    assert "strip_um, here 1.5 µm" in refused.value.__notes__[0]


def test_what_the_configuration_lets_pass_near_the_limit_is_refused_on_the_force_laws():
    # The relation takes the foundation length from an estimated law, up to a quarter too long.
    thickness = 1.2
    load({"devices": {"C1": {"kind": "cantilever", "pair": "b", "thickness_um": thickness, "gap_um": 20, "width_um": 30,
                             "humidities": [0.67]}}})  # fmt: skip
    with pytest.raises(ValueError, match=r"strips of 1.5 µm .* strips of at most 1.43 µm \(foundation length 2.05 µm"):
        opening.long_beam(replace(C1, thickness=thickness * UM), uniform_laws(20))


def test_a_bridge_has_two_arms_under_its_tension_and_its_middle_is_resolved():
    assert R1.beam.tension == pytest.approx(50e6 * 60e-12)
    assert R1.opening.arms == 2 * C1.opening.arms == 2
    zone, strips = R1.opening.resolved(R1, uniform_laws(20))
    assert zone.tension == R1.beam.tension
    assert zone.length / strips == pytest.approx(R1.strip, rel=1e-12)
    assert C1.opening.resolved(C1, uniform_laws(20)) == opening.long_beam(C1, uniform_laws(20))
    assert C1.beam.tension == 0
