"""A large uncertainty of a surface counts where it is: surfaces at its ends are the second route."""

import numpy as np
import pytest

from stiction.config.cases import Case
from stiction.config.files import load
from stiction.contact.environment import Water
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.stages.contact import curves
from stiction.stages.contact.changes.quantities import difference
from stiction.stages.devices.contact_names import contacts_of_budget

SAMPLES, HUMIDITY = 24, 0.67
LEVER = {
    "kind": "cantilever",
    "pair": "mine",
    "thickness_um": 2.6,
    "width_um": 6,
    "gap_um": 20,
    "humidities": [HUMIDITY],
}


def study(surface):
    """Plan of a lever on an etched surface, with few narrow strips."""
    return Plan(
        load(
            {
                "run": {"pairs": ["mine"], "studies": []},
                "surfaces": {"Etched": surface},
                "pairs": {"mine": {"beam": "Etched", "substrate": "Sub1", "gap_um": 20, "humidities": [HUMIDITY]}},
                "contact": {"samples": SAMPLES, "chunks": 1, "model": "summits"},
                "chaos": {"order": 2},
                "beam": {"width_um": 6},
                "design": {"budget_samples": SAMPLES},
                "devices": {"Lever": LEVER | {"uncertainty": {"humidity": 0.01}}},
            }
        )
    )


class Lever:
    """Lengths of Eq. (13) on its contacts."""

    def __init__(self, plan):
        self.results, self.contacts = Results(Graph(plan)), contacts_of_budget(plan, Case("Lever_rh067"))

    def log_length(self, contact):
        """Logarithm of a length up to a constant [-]."""
        return -np.log(curves.energies(self.results[contact], HUMIDITY, Water(300.0)).mean()) / 4

    def changes(self, quantity):
        """Changes of ln l with less and with more of a quantity, and the step of the latter."""
        ends = [self.contacts[shift]["Etched", quantity] for shift in ("less", "more")]
        at = self.log_length(self.contacts["contact"])
        return *(self.log_length(end) - at for end in ends), difference(self.results[ends[0]]) / 2


@pytest.mark.slow
def test_both_ends_are_those_of_surfaces_that_state_them_and_one_slope_misses_the_unsafe_one():
    known = {"like": "B2", "rms_nm": 3, "uncertainty": {"corner_rad_per_um": 9.8}}
    plan = study(known)
    entry, deviation = plan.config["surfaces"]["Etched"], plan.deviation("Etched", "corner")
    less, more, step = Lever(plan).changes("corner")
    assert step == pytest.approx(deviation)
    psd = entry["published_psd"]
    power = np.log(psd["floor_nm4"] / psd["plateau_nm4"]) / np.log(psd["cutoff_rad_per_um"] / psd["corner_rad_per_um"])
    corner = float(psd["corner_rad_per_um"] * np.exp(deviation))
    floor = float(psd["plateau_nm4"] * (psd["cutoff_rad_per_um"] / corner) ** power)
    stated = {name: entry[name] for name in ("rms_nm", "skewness", "kurtosis")} | {"psd": "published"}
    stated |= {"published_psd": psd | {"corner_rad_per_um": corner, "floor_nm4": floor}}
    direct, given = Lever(study(stated)), Lever(study(known))
    moved = direct.log_length(direct.contacts["contact"]) - given.log_length(given.contacts["contact"])
    assert more == pytest.approx(moved, abs=1e-3)
    # A stated uncertainty below the step of the slope leaves the slope at one point.
    small = {"like": "B2", "rms_nm": 3, "uncertainty": {"corner_rad_per_um": 0.01}}
    low, high, near = Lever(study(small)).changes("corner")
    local = (high - low) / 2 / near * deviation
    assert less < -local < 0  # control: the shortest length is beyond what the slope says
    assert (more - less) / 2 + max(-(more + less), 0.0) >= -less
