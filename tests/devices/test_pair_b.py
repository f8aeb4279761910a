"""Safe lengths of the paper's pair b from few beams, against many, and the air in which its patches hold most."""

from unittest.mock import patch

import numpy as np
import pytest
import small
import xarray as xr
from plans import job_settings

import stiction
from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.chaos.model import resample_laws
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.constants import WATER_SURFACE_ENERGY
from stiction.contact.environment import Water
from stiction.devices import risk
from stiction.devices.stoppers import worst_humidity
from stiction.plan.graph import Results
from stiction.stages.contact import contact, curves
from stiction.stages.devices import safe_lengths
from stiction.stages.laws import forces
from stiction.streams import stream

#: Lengths [m] that one beam in a thousand and one in ten thousand fall short of, with the ends of their 95 % interval:
#: order statistics of 110 000 beams on force laws resampled from 5000 samples of contact, pair b, NG, RH 0.67.
BRUTE_FORCE = {1e-3: (627.8e-6, 625.9e-6, 630.5e-6), 1e-4: (616.5e-6, 614.5e-6, 618.7e-6)}
#: Standard error of such a length due to 5000 samples of contact [m].
SAMPLING = 0.8e-6

BEAMS = 2900
C1 = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
#: The lengths of 110 000 beams are those of summits alone that attract only where they touch.
TOUCHING = {"attraction": {"reach": "touching"}, "contact": {"model": "summits"}}


@pytest.fixture(scope="module")
def results():
    """Results of pair b and of a device on it, which share their contact."""
    design = {"design": {"beams": BEAMS, "shares": [1e-3, 1e-4]}}
    return Results.of(stiction.load({"devices": {"C1": C1}} | design | TOUCHING))


def test_real_patches_hold_most_well_below_saturation_although_their_energy_keeps_growing():
    patches = in_si(
        contact.Settings, merged(job_settings(small.PLAN, "devices/contact/b_1500x30000"), {"contact": {"samples": 60}})
    )
    drawn = contact.compute(small.surfaces(), "b", "NG", patches)
    axis, water = np.arange(80, 99) / 100, Water(300.0)
    pulls = np.transpose([curves.pull_offs(drawn, humidity, water) for humidity in axis])
    worst, error = worst_humidity(axis, pulls)
    assert 0.88 < worst - 4 * error < worst + 4 * error < 0.92  # of 5000 patches: 0.894
    energies = [curves.energies(drawn, humidity, water).mean() for humidity in axis]
    assert np.all(np.diff(energies) > 0)
    assert energies[-1] < 2 * WATER_SURFACE_ENERGY


@pytest.mark.nightly
def test_a_few_thousand_beams_of_pair_b_find_the_lengths_of_110_000(results):
    study = stiction.PairStudy("b", "NG", results)
    vectors, limit = forces.vectors(study.forces(0.67))
    experiment = Experiment(study.beam, 1000, lambda n, rng: resample_laws(vectors, limit, n, rng))
    cracks = columns(list(simulate(experiment, range(BEAMS), lambda k: stream(7, k), threads=2)))["crack_length"]
    for share, (length, low, high) in BRUTE_FORCE.items():
        found = risk.safe_length(cracks, share, stream(0))
        assert found.basis is risk.Basis.FITTED
        error = np.sqrt(found.error**2 + ((high - low) / (2 * 1.96)) ** 2 + SAMPLING**2)
        assert abs(found.estimate - length) < 3 * error
        assert abs(np.quantile(cracks, 0.02) - length) > 3 * error  # control
        assert found.length < high


@pytest.mark.nightly
def test_the_stages_of_a_device_find_the_lengths_of_110_000(results):
    job = results.graph.job("devices/safe_lengths/C1_rh067")
    cracks, no_attraction = results["devices/cracks/C1_rh067"], (np.array([0.01, 0.1]), np.zeros((BEAMS, 2)))
    with patch.object(curves, "tip_forces", lambda *_: no_attraction):
        found = safe_lengths.compute(cracks, job.stage.converted(job.settings), xr.Dataset()).sel(shape="S-shape")
    for share, (length, low, high) in BRUTE_FORCE.items():
        one = found.sel(share=share)
        held = risk.HOLD * 3.4e-6
        error = np.sqrt(float(one.beams_error) ** 2 + ((high - low) / (2 * 1.96)) ** 2 + SAMPLING**2)
        assert abs(float(one.estimate) - held - length) < 3 * error
        assert float(one.safe_length) - held < high
