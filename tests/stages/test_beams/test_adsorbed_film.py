"""Test beams determine the adsorbed film, which nobody measures."""

import numpy as np
import small
import xarray as xr
from test_inference_stage import ARRAY, BEAMS, DEVICE, SCATTER, safe_lengths

from stiction.beam.energy import arrest_length
from stiction.contact.environment import Water
from stiction.devices.inference import DiscrepancyOfModel
from stiction.stages.contact import curves
from stiction.stages.devices.opening import ARC, S_SHAPE
from stiction.stages.test_beams import inference
from stiction.stages.test_beams.inference import CrackLengths, Settings

HUMIDITIES = (0.44, 0.67, 0.92)
#: Prior standard deviations of the film [m] and of Young's modulus, and the true film [m].
DEVIATIONS, FILM = np.array([0.3e-9, 0.03]), 0.4e-9


def length(beam, humidity, film):
    """Crack length of Eq. (13) by the mean energy of strips with an adsorbed film [m]."""
    energies = curves.energies(small.contact_of_pair(), humidity, Water(300.0, adsorbed=film))
    return float(arrest_length(energies.mean(), beam.beam))


def budget(beam, humidity, response=S_SHAPE):
    """Dataset of stage budget of a beam of which film and modulus are uncertain."""
    centre = length(beam, humidity, 0.0)
    slope = np.log(length(beam, humidity, DEVIATIONS[0]) / centre) / DEVIATIONS[0]
    return xr.Dataset(
        {
            "slope": ("input", [slope, 1 / 4]),
            "covariance": (("input", "other"), np.diag(DEVIATIONS**2)),
            "centre": ((), centre, {"response": response, "share": 0.001, "units": "m"}),
            "scatter": ((), SCATTER),
        },
        coords={"input": (names := ["adsorbed water", "Young's modulus"]), "other": names},
    )


def inferred(humidities, film):
    """Shift of the film by test beams with a film, and its standard deviation after them [m]."""
    means = tuple(length(ARRAY, humidity, film) for humidity in humidities)
    lengths = CrackLengths(1500e-6, humidities, means, tuple(SCATTER * np.array(means)), (BEAMS,) * len(means))
    of_device = {("C1", humidity): budget(DEVICE, humidity) for humidity in HUMIDITIES}
    of_device |= {("C1", humidity, "tip"): budget(DEVICE, humidity, ARC) for humidity in HUMIDITIES}
    of_array = {("arrayA", humidity): budget(ARRAY, humidity) for humidity in humidities}
    exact = DiscrepancyOfModel(1e-3, 1e-3, 1e-3)
    settings = Settings(0, exact, {"arrayA": ARRAY}, {"arrayA": lengths}, {}, DEVICE)
    contacts = {("arrayA", is_humid): is_humid for is_humid in (False, True)}
    found = inference.compute(of_device, of_array, safe_lengths(), contacts, contacts, settings)
    one = found.sel(input="adsorbed water")
    return float(one["shift"]), float(one.deviation)


def test_lengths_at_several_humidities_determine_the_film():
    shift, error = inferred(HUMIDITIES, FILM)
    assert abs(shift - FILM) < 2 * error + 0.1 * FILM, "the update is linear"
    assert error < 0.3 * DEVIATIONS[0]
    assert abs(inferred(HUMIDITIES, 0.0)[0]) < 1e-12, "control"
    assert inferred(HUMIDITIES[2:], FILM)[1] > 2 * error, "the wettest air shows it least"
