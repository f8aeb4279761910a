"""Uncertain coherence of two surfaces in budgets: its step, its contacts, and the roughness that it stands for."""

import numpy as np
import pytest
from plans import LIKE_B2, surface_datasets
from standard_errors import ALLOWED

from stiction.config.files import load
from stiction.config.messages import ConfigError
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.contact.materials import COHERENCE
from stiction.estimates import mean_with_error
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.plan.stage import select
from stiction.stages.contact import contact, curves, pairs

LEVER = {"kind": "cantilever", "pair": "r", "thickness_um": 4, "gap_um": 2, "width_um": 20, "humidities": [0.45]}


def study(replica, uncertainty=None, factor=1.0):
    """Configuration of a lever on two such surfaces whose heights have a factor."""
    psd = LIKE_B2["published_psd"]
    scaled = psd | {name: factor**2 * psd[name] for name in ("floor_nm4", "plateau_nm4")}
    surfaces = {"G": LIKE_B2 | {"rms_nm": factor * 3.4, "published_psd": scaled}}
    pair = {"beam": "G", "substrate": "G", "gap_um": 2, "humidities": [0.45]} | (
        {"replica": replica} if replica else {}
    )
    device = LEVER | ({"uncertainty": uncertainty} if uncertainty else {})
    few = {"contact": {"samples": 80}, "design": {"beams": 200, "budget_beams": 40, "budget_samples": 20}}
    return few | {"surfaces": surfaces, "pairs": {"r": pair}, "devices": {"Lever": device}, "run": {"pairs": []}}


@pytest.mark.parametrize("coherence", [0.3, 0.9, 0.99])
def test_its_step_is_relative_in_what_is_not_coherent(coherence):
    step, rests = COHERENCE.step, 1 - np.array(COHERENCE.step.ends(coherence))
    assert np.log(rests[0] / rests[1]) == pytest.approx(step.difference)
    assert step.moved(coherence, step.difference / 2) > coherence > step.moved(coherence, -step.difference / 2)
    assert 1 - step.moved(coherence, 0.5) == pytest.approx((1 - coherence) * np.exp(-0.5))
    small = 1e-6 * (1 - coherence)
    assert step.moved(coherence, step.error(coherence, small)) == pytest.approx(coherence + small, abs=1e-3 * small)


def copies(plan):
    """Copies of the contacts with less and with more coherence of all budgets."""
    graph = Graph(plan)
    budgets = [graph.job(f"devices/budget/{name}").inputs for name in plan.devices.budgets()]
    names = [budget[key].get("coherence") for budget in budgets for key in ("properties_less", "properties_more")]
    return [graph.job(name).settings["replica"] for name in names if name]


def test_a_budget_has_contacts_with_less_and_with_more_of_it():
    found = copies(Plan(load(study({"coherence": 0.9, "above_nm": 100}, {"coherence": 0.03}))))
    assert [round(each["coherence"], 12) for each in found] == [0.88, 0.92] * 2, "along the beam, and at its tip"
    assert {each["above_nm"] for each in found} == {100}
    assert not copies(Plan(load(study({"coherence": 0.9}, {"thickness_um": 0.1})))), "control"


@pytest.mark.parametrize(("replica", "said"), [(None, "has no replica"), ({"coherence": 0.1}, "below a coherence")])
def test_it_needs_a_coherence_from_which_a_step_leaves_some(replica, said):
    with pytest.raises(ConfigError, match=said):
        load(study(replica, {"coherence": 0.03}))
    load(study(replica, {"thickness_um": 0.1}))


def energies(replica, factor=1.0):
    """Energies of strips under the lever [J/m²]."""
    plan = Plan(load(study(replica, factor=factor)))
    surface, seen = surface_datasets(plan, "G"), plan.seen_by("r", samples=60)
    settings = in_si(pairs.Settings, select(pairs.Settings, seen))
    drawn = contact.compute([surface, surface], "r", "NG", settings)
    return curves.energies(drawn, 0.45, in_si(Water, plan.air.water("r")))


@pytest.mark.slow
def test_less_of_it_holds_as_rougher_independent_surfaces():
    less, more = COHERENCE.step.ends(0.9)
    of_copies = [mean_with_error(energies({"coherence": end})) for end in (less, more)]
    alone = [mean_with_error(energies(None, np.sqrt(1 - end))) for end in (less, more)]
    assert max(errors_between(*pair) for pair in zip(of_copies, alone, strict=True)) < ALLOWED
    assert errors_between(of_copies[0], alone[1]) > ALLOWED, "control"


def errors_between(one, other):
    """Difference of two means in standard errors."""
    return abs(one[0] - other[0]) / np.hypot(one[1], other[1])
