"""What is said of a stopper is about the airs that it states, or about a range that the study states."""

import re

import numpy as np
import pytest
import xarray as xr
from answers import STOPPER, stopper_page

from stiction.config.files import load
from stiction.contact.environment import Water
from stiction.plan.plan import Plan
from stiction.stages.devices import device_warnings, stoppers
from stiction.stages.life.inputs import StopperKeys
from stiction.stages.life.stoppers import stopper_answers

AIRS = [(0.67,), (0.0,), (0.0, 0.67), (0.44, 0.9), (0.0, 0.44, 0.9), (0.4, 0.41)]
#: Relative humidities, and ranges of them, in sentences and tables.
_RANGE = r"(0\.\d+)(?: to | and )(0\.\d+)"
_SAID = re.compile(rf"(?:RH|humidit(?:y|ies) of) (0\.\d+)|(?:humidit(?:y|ies)|air,) from {_RANGE}|<td>{_RANGE}</td>")


def dataset(airs, design):
    """Forces of 400 patches that hold most at RH 0.85, in some airs under section design."""
    ends = stoppers.search_ends(design, {"humidities": list(airs)})
    settings = stoppers.Settings(1, Water(300.0), (3e-6, 3e-6), airs, tuple(ends), restoring_force=40e-6)
    axis, scatter = stoppers.axis_of(settings), np.linspace(0.9, 1.1, 400)
    forces = [np.outer(1 - (np.array(at) - 0.85) ** 2, scatter) * 20e-6 for at in (airs, axis)]
    return stoppers.layout(settings, forces[0], axis, forces[1])


def said_of(airs, design):
    """Page of a stopper and its answers on life, as text."""
    found = dataset(airs, design)
    page = stopper_page(STOPPER | {"humidities": list(airs)}, found)
    answers = stopper_answers(found, StopperKeys(restoring_force=40e-6, contact=(3e-6, 3e-6)))
    return " ".join([*page.answer, *page.lines, page.html, *(answer.what for answer in answers)])


@pytest.mark.parametrize(
    ("airs", "design"), [*((airs, {}) for airs in AIRS[:4]), (AIRS[0], {"worst_humidities": [0.4, 0.98]})]
)
def test_no_humidity_beyond_the_stated_ones_is_said(airs, design):
    said = {float(number) for ends in _SAID.findall(said_of(airs, design)) for number in ends if number} - {0.0}
    humid = [*filter(None, airs), *design.get("worst_humidities", ())] if any(airs) else []
    assert all(min(humid) <= number <= max(humid) for number in said)
    assert bool(said) == bool(humid)
    # The control: a stated range is searched to its end.
    assert (max(said, default=0) > max(airs)) == bool(design and any(airs))


@pytest.mark.parametrize("airs", AIRS)
def test_the_worst_air_is_one_of_several(airs):
    answers = stopper_answers(dataset(airs, {}), StopperKeys(restoring_force=40e-6, contact=(3e-6, 3e-6)))
    (force,) = [answer.what for answer in answers if answer.name == "force"]
    assert ("its largest" in force) == (len(airs) > 1)
    assert ("RH" in force) == any(airs)


#: What warnings read of the forces of a stopper on rough surfaces.
ROUGH = xr.Dataset({"share_flat": 0.0, "rms": 4e-9})


@pytest.mark.parametrize("side", [0.5, 1, 3])
@pytest.mark.parametrize("air", [0.5, 0.9, 0.985])
def test_the_meniscus_is_wide_in_a_stated_air_alone(side, air):
    """At RH 0.98 the film is 51 nm high, and the warning forbids to rely on forces on 1 µm that nobody has there."""
    device = {"kind": "stopper", "pair": "b", "contact_um": [side, side], "restoring_force_uN": 20, "humidities": [air]}
    of = device_warnings.in_si(
        device_warnings.StopperOnPair,
        device_warnings._settings(Plan(load({"devices": {"D": device}, "run": {"pairs": []}})), Of("D"))["stopper"],
    )
    film = -2 * 0.072 * 1.8e-5 / (8.314 * 300 * np.log(air))
    (limits,) = of.limits(ROUGH).values()
    wide = [limit for limit in limits if limit.kind == "wide_meniscus"]
    assert bool(wide) == (2 * film / (side * 1e-6) > 0.1)


class Of:
    """Wildcards of a device."""

    def __init__(self, device):
        self.device = device
