"""The index of a run of devices shows the state that decides about each, and only surfaces of devices."""

import pytest
from test_front_page import finished

from stiction.command import index
from stiction.models import SIDES
from stiction.run.provenance import record

CANTILEVER = {
    "kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.44],
}  # fmt: skip


@pytest.fixture
def config(tmp_path):
    """Configuration of a finished run of pairs and a device."""
    config = finished(tmp_path, ["C1"]) | {"devices": {"C1": CANTILEVER}}
    record(tmp_path / "provenance.json", tmp_path, config)
    return config


@pytest.mark.parametrize(("by_tip", "drawn"), [("True", "only the tip touches"), ("False", "open crack")])
def test_a_device_is_drawn_in_the_state_that_decides(tmp_path, config, by_tip, drawn):  # noqa: ARG001
    (tmp_path / "tables" / "devices.csv").write_text(f"device,by_tip\nC1,{by_tip}\n")
    page = index.index(tmp_path, [])
    assert [one in page for one in ("only the tip touches", "open crack")].count(True) == 1
    assert drawn in page


@pytest.mark.parametrize("tone", ["bad", "open"])
def test_a_card_has_the_tone_of_its_verdict(tmp_path, config, tone):  # noqa: ARG001
    card = f'<section class="card {tone}">'
    assert card not in index.index(tmp_path, []), "the control: without a verdict"
    (tmp_path / "tables" / "devices.csv").write_text(f"device,tone\nC1,{tone}\n")
    assert card in index.index(tmp_path, [])


def test_surfaces_of_pairs_that_were_not_computed_are_not_listed(tmp_path, config):
    own, others = ({config["pairs"][pair][side] for side in SIDES} for pair in ("b", "c"))
    assert others - own, "pair c has a surface that the device has not"
    page = index.index(tmp_path, [])
    assert all(f"<dt>{name}</dt>" in page for name in own | others)
    assert "pairs b, c" in page
    (tmp_path / "tables" / "table_3.csv").unlink()
    page = index.index(tmp_path, [])
    assert all(f"<dt>{name}</dt>" in page for name in own)
    assert not any(f"<dt>{name}</dt>" in page for name in others - own)
    assert "pairs b, c" not in page.partition("<h2>Provenance</h2>")[0]
