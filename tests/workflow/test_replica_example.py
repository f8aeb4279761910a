"""The example of an underside that copies its ground, with few samples and two of its coherences."""

import pytest
import yaml
from configurations import ROOT

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.stages.contact.curves import energies

pytestmark = pytest.mark.slow
SMALL = {
    "contact": {"samples": 60, "chunks": 1, "distance_step_nm": 0.2, "model": "summits"},
    "chaos": {"order": 2},
    "design": {"beams": 200, "shares": [0.05], "budget_beams": 20, "budget_samples": 20},
    "compare": {"pairs.copied.replica.coherence": [0, 0.9]},
}


def test_a_lever_is_shorter_by_the_fourth_root_of_the_energies_of_its_copies():
    """Lengths of beams on the mean energy go with its power of -1/4. Those on strips differ more: few hold the most."""
    example = yaml.safe_load((ROOT / "examples" / "replica.yaml").read_text(encoding="utf-8"))
    plan = Plan(load(merged(example, SMALL)))
    results, lengths, works = Results(Graph(plan)), [], []
    for name in ("Coherence0", "Coherence0p9"):
        cracks = results[f"devices/cracks/Lever{name}_rh045"]
        lengths.append([float(cracks.uniform_length), float(cracks.crack_length.median())])
        water = in_si(Water, plan.air_of_devices.water(f"copied{name}"))
        works.append(energies(results[f"devices/contact/copied{name}_1500x20000"], 0.45, water).mean())
    assert works[1] > 100 * works[0]
    (uniform, alone), (uniform_of_copy, of_copy) = lengths
    assert uniform / uniform_of_copy == pytest.approx((works[1] / works[0]) ** 0.25, rel=0.02)
    assert alone / of_copy > uniform / uniform_of_copy
