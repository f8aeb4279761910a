"""Pull-off forces of a probe beside computed ones: what they say about inputs, with what error, in words and tables."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from stiction.beam.energy import arrest_length
from stiction.devices.inference import FACTOR, SLOPE, DiscrepancyOfModel
from stiction.report.test_beams import figures as figures_test_beams
from stiction.report.test_beams import tables as tables_test_beams
from stiction.stages.devices.opening import FORCE, S_SHAPE, DesignedBeam
from stiction.stages.test_beams import inference
from stiction.stages.test_beams.inference import PullOffs, Settings, pull_off
from stiction.stages.test_beams.rerun import with_reruns

UM = 1e-6
BEAM = DesignedBeam("cantilever", "b", 2.6 * UM, 20 * UM, 30 * UM, 164e9, 1.5 * UM)
#: Radius of the probe [m], adhesion energies [J m⁻²], and d ln energy / d ln rms.
RADIUS, ENERGY, POWER = 10 * UM, {0.45: 1.5e-3, 0.67: 7e-3}, {0.45: -5.0, 0.67: -4.0}
#: Standard deviations of ln rms and of the humidity, which is known too well to matter much.
DEVIATIONS = {"rms of B2": 0.05, "humidity": 0.01}
#: Relative scatter of places, standard uncertainty by the calibration, and standard error of full elastic contact.
PLACES, CALIBRATION, RATIO = 0.3, 0.1, 0.02
#: Sampled places, and the relative standard error of the simulation.
SAMPLED = 2000
SIMULATION = np.hypot(RATIO, PLACES / np.sqrt(SAMPLED))
WIDTH = 1.6449


def force(humidity, rms=0.0, radius=RADIUS):
    """Force 2π R e of Derjaguin for an error of ln rms [N]."""
    return 2 * np.pi * radius * ENERGY[humidity] * np.exp(POWER[humidity] * rms)


def budget(centre, slopes, response, unit):
    """Dataset of stage budget."""
    names = list(DEVIATIONS)
    return xr.Dataset(
        {
            "slope": ("input", slopes),
            "covariance": (("input", "other"), np.diag(list(DEVIATIONS.values())) ** 2),
            "centre": ((), centre, {"response": response, "share": 0.0, "units": unit}),
            "scatter": ((), 0.05),
        },
        coords={"input": names, "other": names},
    )


def of_probe(radius=RADIUS, scatter=PLACES, humidities=(0.45,)):
    """Budgets and dataset of stage stoppers of a probe."""
    places = np.random.default_rng(3).normal(size=SAMPLED)
    places = 1 + scatter * (places - places.mean()) / places.std(ddof=1)
    means = np.array([force(rh, radius=radius) for rh in humidities])
    stopper = xr.Dataset(
        {
            "full_contact_error": ("humidity", [RATIO] * len(means)),
            "pull_off": (("humidity", "sample"), means[:, None] * places),
        },
        coords={"humidity": list(humidities)},
    )
    budgets = {
        ("Day", rh): budget(mean, [POWER[rh], 2.0], FORCE, "N") for rh, mean in zip(humidities, means, strict=True)
    }
    return budgets, stopper


def measured(forces, error=CALIBRATION):
    """Pull-off forces by humidity."""
    means = [np.mean(some) for some in forces.values()]
    stds = [np.std(some, ddof=1) if len(some) > 1 else 0.0 for some in forces.values()]
    number = tuple(map(len, forces.values()))
    return PullOffs(tuple(forces), tuple(means), tuple(stds), number, tuple(error * mean for mean in means))


def computed(data, **probe):
    """Dataset of stage test_beams of a beam with pull-off forces alone."""
    budgets, stopper = of_probe(**probe)
    length = float(arrest_length(ENERGY[0.67], BEAM.beam))
    of_beam = {("C1", 0.67): budget(length, [-POWER[0.67] / 4, -0.5], S_SHAPE, "m")}
    settings = Settings(0, DiscrepancyOfModel(0.1, 0.3, 0.05), {}, {}, {}, BEAM, {"Day": data})
    axis = np.linspace(200, 900, 351) * UM
    safe = xr.DataArray([[600 * UM]], coords={"shape": [S_SHAPE], "share": [0.001]})
    stuck = xr.DataArray([np.linspace(0, 1, 351)], coords={"shape": [S_SHAPE], "length": axis})
    predicted = {0.67: xr.Dataset({"safe_length": safe, "estimate": safe, "stuck": stuck})}
    return with_reruns(inference.compute(of_beam, budgets, predicted, {}, {}, settings, forces={"Day": stopper}))


@pytest.fixture
def inputs_alone(monkeypatch):
    """Nothing is computed of safe lengths and of further beams."""
    monkeypatch.setattr(inference, "with_lengths", lambda found, _: found)
    monkeypatch.setattr(inference, "further_dataset", lambda *_: xr.Dataset())


def drawn(seed, number=12, common=0.0):
    """Measured forces of a drawn truth, and its error of ln rms. A part of the variance may be common to all forces."""
    rng = np.random.default_rng(seed)
    rms, own = DEVIATIONS["rms of B2"] * rng.normal(), np.sqrt(1 - common)
    air, factor = 2.0 * DEVIATIONS["humidity"] * rng.normal(), CALIBRATION * rng.normal() + SIMULATION * rng.normal()
    spot = PLACES * np.sqrt(common) * rng.normal()
    mean = force(0.45, rms) * np.exp(air + factor)
    return measured({0.45: mean * (1 + spot + PLACES * own * rng.normal(size=number))}), rms


def covered(truths, **probe):
    """Fraction of truths inside the stated 90 % intervals of the rms."""
    inside = []
    for data, rms in truths:
        at = computed(data, **probe).sel(input="rms of B2")
        inside.append(abs(rms - float(at["shift"])) < WIDTH * float(at.deviation))
    return np.mean(inside)


#: Four standard errors of the fraction among 200 truths.
FOUR = 4 * np.sqrt(0.9 * 0.1 / 200)


@pytest.mark.usefixtures("inputs_alone")
@pytest.mark.parametrize("common", [0.0, 0.5])
def test_true_inputs_are_inside_the_stated_intervals_also_of_a_probe_with_a_surface_of_its_own(common):
    truths = [drawn(seed, common=common) for seed in range(200)]
    assert abs(covered(truths) - 0.9) < FOUR
    assert covered(truths, radius=RADIUS / 2) < 0.9 - FOUR


@pytest.mark.usefixtures("inputs_alone")
def test_many_forces_of_a_probe_with_a_surface_of_its_own_are_not_as_good_as_those_of_many_probes():
    truths = [drawn(seed, number=400, common=0.7) for seed in range(200)]
    assert abs(covered(truths) - 0.9) < FOUR
    assert covered(truths, scatter=1e-6) < 0.9 - FOUR  # control: as if all their variance were that of a place


def error_of(data, at=0.45, **probe):
    """Standard error of the logarithm of a force at one of the humidities."""
    budgets, stopper = of_probe(**probe)
    return pull_off(inference.Result("Day", at, budgets["Day", at], None), data, stopper).error


def forces_of(number, scatter=PLACES):
    """Forces with exactly a relative scatter, in pairs."""
    own = scatter * np.sqrt((number - 1) / number)
    return force(0.45) * np.tile([1 - own, 1 + own], number // 2)


def test_many_forces_leave_the_error_of_the_simulation_and_of_the_calibration():
    assert_allclose(error_of(measured({0.45: forces_of(10**6)}, error=0.0)), SIMULATION, rtol=1e-3)
    assert_allclose(error_of(measured({0.45: forces_of(10**6)})), np.hypot(SIMULATION, CALIBRATION), rtol=1e-3)
    assert_allclose(error_of(measured({0.45: forces_of(4)}, 0.0)) ** 2, PLACES**2 / 4 + SIMULATION**2, rtol=1e-9)


def test_one_force_scatters_as_the_places_do_and_many_with_less_scatter_have_the_rest_in_common():
    single = measured({0.45: [force(0.45)]}, error=0.0)
    assert_allclose(error_of(single), np.hypot(PLACES, SIMULATION), rtol=1e-9)
    narrow = measured({0.45: forces_of(10**6, scatter=0.1)}, error=0.0)
    assert_allclose(error_of(narrow) ** 2, PLACES**2 - 0.1**2 + SIMULATION**2, rtol=1e-5)
    wide = measured({0.45: forces_of(100, scatter=0.6)}, error=0.0)
    assert_allclose(error_of(wide) ** 2, 0.6**2 / 100 + SIMULATION**2, rtol=1e-9)


def test_errors_of_forces_at_several_humidities_are_no_smaller_than_those_of_one_common_calibration():
    humidities = (0.45, 0.67)
    data = measured({rh: force(rh) / force(0.45) * forces_of(100) for rh in humidities})
    errors = np.diag([error_of(data, rh, humidities=humidities) ** 2 for rh in humidities])
    common = (PLACES**2 / 100 + SIMULATION**2) * np.eye(2) + CALIBRATION**2 * np.ones((2, 2))
    assert np.linalg.eigvalsh(errors - common).min() > -1e-12
    alone = np.diag([error_of(measured({0.45: forces_of(100)})) ** 2] * 2)
    assert np.linalg.eigvalsh(alone - common).min() < -1e-3  # control: each as if it were the only one


def test_forces_as_computed_move_nothing_narrow_the_inputs_and_leave_the_model_of_cracks():
    found = computed(measured({0.45: forces_of(100)}))
    assert_allclose(found["shift"], 0, atol=1e-12)
    assert_allclose(found.updated_safe, found.safe, rtol=1e-9)
    rms = found.sel(input="rms of B2")
    slope, error = POWER[0.45], float(found.force_error[0])
    prior = np.hypot(slope * 0.05, 2.0 * 0.01)
    assert_allclose(found.force_before, [prior], rtol=1e-9)
    assert_allclose(found.force_after, [1 / np.hypot(1 / prior, 1 / error)], rtol=1e-9)
    assert float(rms.deviation) < 0.6 * 0.05
    assert_allclose(found.deviation.sel(input=[FACTOR, SLOPE]), [0.1, 0.3], rtol=1e-12)
    # The slope of the model is about the cracks of the device, where no beams say anything.
    of_inputs = float(found.result_of_inputs[0])
    assert_allclose(found.result_before, [np.sqrt(of_inputs**2 + 0.1**2 + 0.05**2)], rtol=1e-9)


def test_larger_forces_than_computed_mean_smoother_surfaces_and_shorter_cracks():
    data = measured({0.45: 1.5 * forces_of(100)})
    found = computed(data)
    assert float(found["shift"].sel(input="rms of B2")) < -0.02
    assert float(found.result_shift[0]) < 0
    assert float(found.updated_safe[0, 0, 0]) < float(found.safe[0, 0, 0])
    halved = computed(replace(data, mean=tuple(mean / 4 for mean in data.mean)))
    assert float(halved["shift"].sel(input="rms of B2")) > 0.02
    assert float(halved.p_value) < float(found.p_value)


def test_pages_state_the_forces_beside_the_computed_ones():
    found = computed(measured({0.45: 1.2 * forces_of(100)}))
    cells = tables_test_beams.test_beams({"C1": found}).cells
    (row,) = [row for row in cells.itertuples() if "pull-off force" in str(row)]
    assert "Day: mean pull-off force [nN]" in row
    assert any("113" in str(cell) for cell in row)  # 1.2 times 94.2 nN
    assert any(str(cell).startswith("94") for cell in row)
    assert "lengths, counts and forces" in tables_test_beams.agreement(found)
    assert "pull-off forces say nothing about it" in tables_test_beams.notes(found)
    assert {one.kind for one in tables_test_beams.warnings(found)} == {"beyond_humidities_of_test_beams"}
    assert figures_test_beams.test_beams(found).axes


def test_a_stopper_takes_forces_of_a_probe_without_any_beam_and_no_further_ones_are_named():
    budgets, stopper = of_probe()
    coords = {"humidity": [0.67], "share": [0.01], "part": ["safe", "estimate", "error"]}
    safe = xr.DataArray(np.full((3, 1, 1), 37e-6), coords=coords, dims=("part", "humidity", "share"))
    places = (("humidity", "sample"), [30e-6 * np.linspace(0.8, 1.2, 50)])
    predicted = xr.Dataset({"safe_force": safe, "pull_off": places, "restoring_force": 33e-6})
    own = {("S1", 0.67): budget(30e-6, [POWER[0.67], 2.0], FORCE, "N")}
    data = measured({0.45: 1.5 * forces_of(100)})
    settings = Settings(0, DiscrepancyOfModel(0.1, 0.3, 0.05), {}, {}, {}, None, {"Day": data})
    found = with_reruns(inference.compute(own, budgets, predicted, {}, {}, settings, forces={"Day": stopper}))
    assert float(found.result_shift[0]) > 0
    assert float(found.updated_safe.isel(share=0).squeeze()) > 37e-6
    assert_allclose(found.result_before, found.result_of_inputs, rtol=1e-12)
    assert tables_test_beams.beams_to_add(found) == ""
    assert "S1: \n" not in tables_test_beams.test_beams({"S1": found}).caption + "\n"
