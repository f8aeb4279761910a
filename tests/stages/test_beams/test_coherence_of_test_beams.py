"""Test beams tell the coherence of two surfaces that follow each other, as any other input."""

import numpy as np
import pytest

from stiction.config.files import load
from stiction.contact.materials import COHERENCE
from stiction.devices.inference import CrackData, KnownInputs, given_lengths
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan
from stiction.streams import stream

#: A coherence with its uncertainty, the error of a measured ln l, and the number of drawn truths. The update is linear:
#: twice as uncertain a coherence would bend ln l by 0.02 at one standard uncertainty.
STATED, UNCERTAINTY, SCATTER, DRAWS = 0.9, 0.015, 0.03, 400
PSD = {"corner_rad_per_um": 12, "cutoff_rad_per_um": 125, "floor_nm4": 0.3, "plateau_nm4": 14380}
SURFACE = {"rms_nm": 3.4, "skewness": 0, "kurtosis": 3, "psd": "published", "published_psd": PSD}
SIZES = {"pair": "r", "thickness_um": 4, "gap_um": 2, "width_um": 20}


def budget(coherence):
    """Budget of test beams on surfaces of a coherence."""
    pair = {"beam": "G", "substrate": "G", "gap_um": 2, "humidities": [0.45], "replica": {"coherence": coherence}}
    beams = {"length_um": 900, "crack_lengths": [{"humidity": 0.45, "mean_um": 240, "std_um": 5, "beams": 9}]}
    lever = {"kind": "cantilever", "humidities": [0.45], "uncertainty": {"coherence": UNCERTAINTY}}
    file = {"surfaces": {"G": SURFACE}, "pairs": {"r": pair}, "run": {"pairs": []}}
    file |= {"contact": {"samples": 60, "model": "summits"}, "design": {"budget_beams": 60, "budget_samples": 60}}
    file |= {"test_beams": {"T": SIZES | beams}, "devices": {"Lever": SIZES | lever | {"test_beams": ["T"]}}}
    return Results(Graph(Plan(load(file))))["devices/test_beams/budget/T_rh045"]


@pytest.mark.slow
def test_the_knowledge_after_lengths_contains_the_coherence_at_its_rate():
    """True lengths are computed at six coherences. They are not linear."""
    stated = budget(STATED)
    assert stated.input.values.tolist() == [COHERENCE.words]
    deviation = COHERENCE.step.error(STATED, UNCERTAINTY)
    assert stated.covariance.item() == pytest.approx(deviation**2)
    errors = deviation * np.linspace(-2.5, 2.5, 6)
    lengths = np.log([float(budget(COHERENCE.step.moved(STATED, by)).centre) for by in errors])
    rng = stream(7, "coherence of test beams")
    truth = deviation * rng.standard_normal(DRAWS)
    measured = np.interp(truth, errors, lengths) + SCATTER * rng.standard_normal(DRAWS)
    prior = KnownInputs((COHERENCE.words,), np.zeros(1), stated.covariance.values)

    def inside(lengths):
        """Share of truths within two standard uncertainties, and an uncertainty."""
        differences = lengths - np.log(float(stated.centre))
        data = (CrackData(stated.slope.values[None], np.array([by]), np.array([SCATTER])) for by in differences)
        found = [given_lengths(prior, one) for one in data]
        away = [abs(one.mean[0] - by) / one.deviations[0] for one, by in zip(found, truth, strict=True)]
        return np.mean(np.less(away, 2)), found[0].deviations[0]

    rate, left = inside(measured)
    assert left < 0.5 * deviation
    assert rate == pytest.approx(0.9545, abs=4 * np.sqrt(0.9545 * 0.0455 / DRAWS))
    assert inside(measured + 0.1)[0] < 0.7, "control: beams that are longer for another reason"
