"""The chain in one process against the chain of the workflow's scripts, and what it adds to it."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stiction.beam.energy import arrest_length
from stiction.config.cases import merged
from stiction.config.settings import read
from stiction.stages import cases, data, pairs
from stiction.stages.identifications import identified_spectra
from stiction.study import PairStudy

ROOT = Path(__file__).parents[1]
SMALL = {
    "contact": {"samples": 40},
    "beam": {"samples": 3, "width_um": 6},
    "chaos": {"order": 3},
    "sampling": {"strip_length_um": 1.5},
}
CONFIG = merged(read(ROOT / "config.yaml"), SMALL)
HUMIDITY = 0.8


def script(name):
    """Import ``main`` of a script of the workflow."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "workflow" / "scripts" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.main


@pytest.fixture(scope="module")
def study():
    return PairStudy.of(CONFIG, "b")


def test_the_stages_are_those_of_the_workflow(study, tmp_path):
    names = [CONFIG["pairs"]["b"][side] for side in ("beam", "substrate")]
    paths = {stage: [tmp_path / f"{stage}_{name}.nc" for name in names] for stage in ("heights", "spectrum")}
    for name, heights, spectrum in zip(names, paths["heights"], paths["spectrum"], strict=True):
        entry = CONFIG["surfaces"][name]
        script("heights")(heights, {key: entry[key] for key in ("rms_nm", "skewness", "kurtosis")})
        script("spectrum")(heights, None, spectrum, {"spacing_nm": 10, "psd": entry["published_psd"]})
    contact, forces, chaos = (tmp_path / f"{stage}.nc" for stage in ("contact", "forces", "chaos"))
    script("contact_chunk")(paths["heights"], paths["spectrum"], contact, CONFIG, "b", "NG", 0, 1)
    script("forces")(contact, forces, CONFIG | {"humidity": HUMIDITY})
    script("chaos")(forces, chaos, CONFIG, "b_rh080", "NG")
    beams = tmp_path / "beams.nc"
    script("beams")(chaos, beams, CONFIG | {"samples": 3, "scatter": 0}, "b_rh080", 1)
    assert_array_equal(study.forces(HUMIDITY)[0], data.vectors(data.load(forces, "forces")))
    assert_array_equal(study.beams(HUMIDITY)["crack_length"], data.load(beams, "beams").crack_length)


@pytest.mark.parametrize(("humidity", "printed"), [(0.55, 878), (0.67, 710), (0.80, 538), (0.88, 434), (0.92, 391)])
def test_crack_length_of_the_mean_energy_is_the_printed_one(study, humidity, printed):
    # What the paper leaves open (attraction in water or none, ν, grid) is worth 10 % together; twice the modulus, the
    # attraction or the pressure of the water is worth more.
    energy = study.energies(humidity).mean()
    assert_allclose(arrest_length(energy, study.beam), printed * 1e-6, rtol=0.1)


def test_a_finer_grid_shows_the_same_surfaces():
    surfaces = cases.surfaces_of(CONFIG, "b")
    settings = CONFIG, merged(CONFIG, {"sampling": {"spacing_nm": 5}})
    coarse, fine = (pairs.surface_pair(surfaces, "NG", s).draw(*map(np.random.default_rng, (1, 2))) for s in settings)
    assert fine.shape == (300, 1200)
    # Single precision of the Fourier transforms, in units of the rms.
    assert_allclose(fine[::2, ::2], coarse, atol=1e-5 * 3.4e-9 * 10)


def test_humidity_makes_surfaces_stick_and_van_der_waals_forces_help(study):
    dry, wet = (study.energies(humidity).mean() for humidity in (0.5, HUMIDITY))
    assert dry < wet
    without = PairStudy.of(merged(CONFIG, {"van_der_waals": "none"}), "b")
    assert np.all(without.energies(0.5) < study.energies(0.5))


def test_energies_are_those_of_the_vectors(study):
    assert_array_equal(study.energies(HUMIDITY), study.forces(HUMIDITY)[0][:, 0])


def test_a_reading_that_changes_nothing_is_the_pair_itself(study, tmp_path):
    contact, reading = tmp_path / "contact.nc", tmp_path / "reading.nc"
    one = merged(CONFIG, {"pairs": {"b": {"humidities": [HUMIDITY]}}})
    script("reading_contact")([], contact, {"base": CONFIG, "changes": {}, "identified": []}, "b")
    script("reading")(contact, reading, one, "b")
    found = data.load(reading, "reading").isel(humidity=0)
    assert_array_equal(found.crack_length, study.beams(HUMIDITY)["crack_length"])
    script("reading_contact")(
        [], contact, {"base": CONFIG, "changes": {"van_der_waals": "none"}, "identified": []}, "b"
    )
    script("reading")(contact, reading, one, "b")
    assert np.all(data.load(reading, "reading").adhesion_energy[0] < found.adhesion_energy)


def test_a_spectrum_is_identified_as_by_the_workflow(tmp_path):
    config = merged(
        CONFIG, {"surfaces": {"B2": {"psd": "identified"}}, "identification": {"patches": 2, "patch_um": 2}}
    )
    entry, heights, found = config["surfaces"]["B2"], tmp_path / "heights.nc", tmp_path / "found.nc"
    script("heights")(heights, {key: entry[key] for key in ("rms_nm", "skewness", "kurtosis")})
    target = {key: entry[key] for key in ("mean_summit_radius_um", "summit_density_per_um2")}
    settings = {"spacing_nm": 10, "target_spacing_nm": config["character"]["spacing_nm"], "target": target}
    script("identify")(heights, found, config | settings, "B2")
    spectra = identified_spectra(config, "b")
    with pytest.raises(ValueError, match=r"spectrum of B2 has to be identified first, see stiction\.stages\.identifications"):
        PairStudy.of(config, "b")
    assert spectra == {"B2": cases.target_spectrum(data.load(found, "identification"))}
    (_, drawn), (_, other) = cases.surfaces_of(config, "b", spectra)
    assert cases.target_spectrum(drawn) == spectra["B2"] != cases.target_spectrum(other)


def test_a_pair_that_is_not_there_is_named():
    with pytest.raises(ValueError, match="there is no pair nope; the configuration has a, b, c"):
        PairStudy.of(CONFIG, "nope")
