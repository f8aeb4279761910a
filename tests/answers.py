"""Small devices with the datasets of their stages, and the answers that stage answer gives on them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import xarray as xr
from ground import exactly

from stiction.answer.data import Answer
from stiction.contact.environment import Water
from stiction.devices.limits.limit import Limit
from stiction.report.answer import screen
from stiction.report.answer.judged import limits_of, with_limits
from stiction.report.devices import pages
from stiction.report.limits.words import texts
from stiction.report.page import Page, Summary
from stiction.stages.answer import answer as stage
from stiction.stages.devices import budget, safe_lengths, sticking, stoppers
from stiction.stages.devices.budget import Responses
from stiction.stages.devices.device_warnings import OfDevices
from stiction.stages.devices.opening import EITHER, S_SHAPE, DesignedBeam
from stiction.stages.devices.uncertain_inputs import Input, InputState, Uncertainty
from stiction.stages.life.answers import layout
from stiction.stages.life.beams import beam_answers
from stiction.stages.life.inputs import BeamErrors, BeamKeys, StopperKeys
from stiction.stages.life.stoppers import stopper_answers

CANTILEVER = {
    "kind": "cantilever",
    "pair": "b",
    "thickness_um": 2.6,
    "gap_um": 20,
    "width_um": 30,
    "humidities": [0.67],
}
BRIDGE = CANTILEVER | {"kind": "bridge", "residual_stress_MPa": 50}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0.44, 0.67]}


# Lengths


def designed(kind="cantilever"):
    """Beam of pair b."""
    return DesignedBeam(kind, "b", 2.6e-6, 20e-6, 30e-6, 164e9, 1.5e-6)


def safe(kind="cantilever", longest=600e-6, reach=np.inf):
    """Safe lengths of 400 devices that stick between two thirds of a length and this length."""
    device = designed(kind)
    settings = safe_lengths.Settings(1, Water(300.0), 0.67, device, (1e-2, 1e-3, 1e-4), 0.0)
    shapes = {device.opening.shapes[0]: np.linspace(2 / 3, 1, 400) * longest}
    if kind == "cantilever":
        shapes[EITHER] = 0.7 * shapes[S_SHAPE]
    without_samples = sticking.lengths_without_samples(device, settings.water, 0.67, 0.0, reach)
    bounds = {
        shape: sticking.safe_lengths(values, settings, without_samples[shape]) for shape, values in shapes.items()
    }
    dataset = safe_lengths.layout(shapes, bounds, without_samples, settings)
    floors = "shape", [bound.safe for bound in without_samples.values()]
    return dataset.assign(
        sticking_length=(("shape", "device"), np.array(list(shapes.values()))),
        floor=floors,
        rms=3e-9,
        share_flat=0.0,
        longest_strip=1e-3,
    )


def of_length(length, **more):
    """Safe lengths as of `safe`, of devices of a length [m]."""
    longest = more.get("longest", 600e-6)
    lengths = np.linspace(2 / 3, 1, 400) * longest
    return safe(**more).assign(safe_lengths.at_length(exactly(lengths, 0.7 * lengths), length))


def least(dataset, share=1e-3):
    """Simulated limit for a fraction, however the device is held [m]."""
    return float(dataset.safe_length.sel(share=share).min())


# Budgets

STATE = InputState(None, 0.5, Water(300.0))
NAMES = {"rms of B2": "heights of B2", "skewness of B2": "heights of B2", "thickness": "thickness"}
COVARIANCE = np.array([[4e-4, -1e-4, 0], [-1e-4, 4e-4, 0], [0, 0, 1e-4]])
C1 = designed()
#: Settings of the budgets of a beam, of its tips and of a stopper.
_COMMON = 1, Water(300.0), 0.5, Uncertainty(), ("B2", "Sub1"), 164e9
BEAM = budget.BeamBudget(*_COMMON, device=C1, beams=0)
TIPS = budget.TipBudget(*_COMMON, device=C1, share=1e-3)
PATCH = budget.PatchBudget(*_COMMON, contact=(3e-6, 3e-6))


def budget_dataset(factor=1.0, settings=BEAM):
    """Budget of three inputs, two of them correlated, and one choice."""
    inputs = [Input(name, group, (STATE, STATE), 0.1) for name, group in NAMES.items()]
    slopes = np.array([[1.0, 0.02], [1.0, 0.03], [0.8, 0.01]]) * [factor, 1]
    devices = Responses(np.array([[690e-6, 700e-6, 710e-6]]), np.mean)
    return budget.layout(inputs, slopes, COVARIANCE, devices, {"van_der_waals_dry": (-0.042, 0.003)}, settings)


# Forces


def stopper_dataset(peak=0.7):
    """400 patches that hold 0.05, 0.1, ..., 20 µN."""
    settings = stoppers.Settings(1, Water(300.0), (3e-6, 3e-6), (0.44, 0.67), (0.4, 0.9), restoring_force=18.99e-6)
    forces, axis = 5e-8 * np.arange(1, 401), np.linspace(0.4, 0.9, 11)
    peaks = peak + 0.04 * np.where(np.arange(400) % 2, 1, -1)
    along = (1 - (axis[:, None] - peaks) ** 2) * 5e-6
    return stoppers.layout(settings, np.stack([forces, 0.5 * forces]), axis, along)


BEAMS = {("C1", 0.44): budget_dataset(2.0), ("C1", 0.67): budget_dataset()}
BUDGETS = BEAMS | {("C1", 0.67, "tip"): budget_dataset(0.5, TIPS), ("S1", 0.67): budget_dataset(1, PATCH)}
STOPPERS = {"S1": stopper_dataset(), "S2": stopper_dataset(peak=1.0)}


# Answers


def silent(lengths: Mapping[float, xr.Dataset], name="C1", limits=()) -> OfDevices:
    """Warnings of a beam, the same about all its states."""
    shapes = map(str, next(iter(lengths.values()))["shape"].values)
    return OfDevices({(name, rh, shape): list(limits) for shape in shapes for rh in lengths}, {}, {})


def beam_data(lengths, budgets=None, *, keys=None, after=None, **more):
    """Datasets of a beam: safe lengths by humidity, budgets by the keys of pages, and more of stage answer."""
    kind = "bridge" if "middle" in next(iter(lengths.values()))["shape"].values else "cantilever"
    keys = keys or BeamKeys(device=designed(kind), density=2330.0, liquids={}, uncertainty=BeamErrors())
    life = layout(beam_answers(lengths, after or {}, keys, more.get("biased")), keys)
    return {"lengths": lengths, "budgets": list((budgets or {}).values()), "life": life, "biased": {}} | more


def beam_answer(section, lengths, budgets=None, limits: Sequence[Limit] = (), **more) -> Answer:
    """Answer about a beam of a section, from its safe lengths by humidity."""
    settings = stage.Settings(
        1,
        "C1",
        section["kind"],
        length=section.get("length_um", np.nan) * 1e-6,
        touchdowns=section.get("touchdowns", 1),
        liquids=tuple(section.get("liquids", ())),
        left_out=("dimples",) if "dimples" in section else (),
        beam=designed(section["kind"]),
        budgets=tuple(humidity for humidity, *_ in budgets or {}),
    )
    return with_limits(_computed(beam_data(lengths, budgets, **more), settings), limits)


def stopper_answer(stopper, budgets=None, limits: Sequence[Limit] = (), *, keys=None, **more) -> Answer:
    """Answer about a stopper, from its forces."""
    force = float(stopper.restoring_force)
    keys = keys or StopperKeys(restoring_force=force, contact=(3e-6, 3e-6))
    life = layout(stopper_answers(stopper, keys), keys)
    data = {"stopper": stopper, "budgets": list((budgets or {}).values()), "life": life} | more
    humidities = tuple(humidity for humidity, *_ in budgets or {})
    settings = stage.Settings(1, "S1", "stopper", touchdowns=keys.touchdowns, budgets=humidities)
    return with_limits(_computed(data, settings), limits)


def _computed(data, settings):
    """Answer by fewer draws than those of a run."""
    with patch.object(stage, "DRAWS", 4000):
        return stage.compute(data, settings)


def screen_of(answer: Answer, section, limits: Sequence[Limit] = ()) -> Summary:
    """First screen of a device."""
    return screen.screen(answer, section, texts(limits), "")


def beam_page(section, lengths, budgets=None, *, warnings=None, answer=None, name="C1", **data) -> Page:
    """Page of a beam, with the answer on its datasets unless another one is given."""
    warnings = warnings or silent(lengths, name)
    limits = limits_of(name, warnings)
    answer = answer or replace(beam_answer(section, lengths, budgets, limits, **_evidence(data)), device=name)
    datasets = {"safe_lengths": lengths, "budgets": budgets or {}, "warnings": warnings}
    return pages.device_page(name, section, datasets | data, answer)


def stopper_page(section, stopper, budgets=None, limits: Sequence[Limit] = (), *, answer=None, **data) -> Page:
    """Page of a stopper, as of `beam_page`."""
    answer = answer or stopper_answer(stopper, budgets, limits, **_evidence(data))
    datasets = {"stopper": stopper, "budgets": budgets or {}, "warnings": OfDevices({}, {}, {"S1": list(limits)})}
    return pages.device_page("S1", section, datasets | data, answer)


def _evidence(data):
    """Data of a page that bear on its answer."""
    return {key: data[key] for key in ("test_beams",) if data.get(key) is not None}
