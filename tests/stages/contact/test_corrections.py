"""Laws and lengths corrected to full elastic contact, on a small study of pair b."""

from dataclasses import replace

import numpy as np
import pytest
import small
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

from stiction.config.files import load
from stiction.contact.correction import NONE, Correction, ElasticChange
from stiction.contact.environment import Water
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.beams import variant_beams
from stiction.stages.contact import contact, corrections, curves, full_contact, pair_model_error
from stiction.stages.devices import device_model_error, stoppers
from stiction.stages.devices.opening import EITHER, FORCE, MIDDLE, S_SHAPE, DesignedBeam
from stiction.stages.laws import fit, forces

HUMIDITIES = (0.44, 0.67, 0.92)
WATER = Water(300.0)


def corrected(energy, pull_off):
    """Water with the same ratios at all humidities."""
    return replace(WATER, correction=Correction(np.array(HUMIDITIES), *map(ElasticChange, (energy, pull_off))))


def ratios_at(given, humidity):
    """Ratios of e and f_max of a correction at a humidity."""
    return tuple(change.ratio for change in given.at(humidity))


def study(energy=(0.6, 0.9, 1.0), pull_off=(0.7, 0.95, 1.0), strips=6):
    """Study in which full contact has exactly these ratios to the sum over summits."""
    values = np.ones((strips, 3, 9))
    values[..., 2] = 1e-3 * np.random.default_rng(3).gamma(9, size=(strips, 3))
    values[..., 3] = 1e6 * np.random.default_rng(4).gamma(9, size=(strips, 3))
    values[..., 0], values[..., 1] = values[..., 2] * energy, values[..., 3] * pull_off
    return full_contact.layout(values, HUMIDITIES, 1e-8)


SETTINGS = small.settings_of(forces, job_settings(small.PLAN, f"forces/{small.CASE}_NG"))


# Force laws


def test_ratios_of_one_leave_all_laws_as_they_are_bit_for_bit():
    same = forces.compute(small.contact_of_pair(), replace(SETTINGS, water=corrected(1, 1)))
    assert_array_equal(forces.vectors(same)[0], forces.vectors(small.forces_of_case())[0])
    assert forces.vectors(same)[1] == forces.vectors(small.forces_of_case())[1]


def test_every_reader_of_the_curves_is_corrected_by_the_same_ratios():
    base, full, given = WATER, corrected(0.7, 0.8), (small.contact_of_pair(), small.HUMIDITY)
    assert_allclose(curves.energies(*given, full), 0.7 * curves.energies(*given, base))
    assert_allclose(curves.pull_offs(*given, full), 0.8 * curves.pull_offs(*given, base))
    vectors, limit = curves.vectors(*given, full)
    of_stage = forces.compute(given[0], replace(SETTINGS, water=full))
    assert_array_equal(vectors, forces.vectors(of_stage)[0])
    assert limit == forces.vectors(of_stage)[1] == vectors[:, 1].max()
    assert_allclose(vectors, curves.vectors(*given, base)[0] * [0.7, 0.8, 1, 1])


def test_samples_of_corrected_laws_scatter_as_full_contact_does_and_keep_their_order():
    given = small.contact_of_pair(), small.HUMIDITY
    wide = replace(WATER, correction=Correction(np.array(HUMIDITIES), ElasticChange(0.7, 1.3), ElasticChange(0.8, 1.2)))
    (base, _), (vectors, limit) = (curves.vectors(*given, water) for water in (WATER, wide))
    for k, (ratio, power) in enumerate([(0.7, 1.3), (0.8, 1.2)]):
        assert_allclose(vectors[:, k].mean(), ratio * base[:, k].mean())
        assert_allclose(np.log(vectors[:, k]).std(), power * np.log(base[:, k]).std())
        assert_array_equal(np.argsort(vectors[:, k]), np.argsort(base[:, k]))
    assert limit == pytest.approx(vectors[:, 1].max())
    assert_allclose(curves.energies(*given, wide), vectors[:, 0])
    assert_allclose(curves.pull_offs(*given, wide), vectors[:, 1])
    fast = curves.fast_pull_offs(*given, wide)
    assert np.all(fast >= vectors[:, 1] * (1 - 1e-9))


def test_the_fit_of_the_curves_is_that_without_a_correction():
    full = replace(SETTINGS, water=corrected(0.7, 0.8))
    found = forces.compute(small.contact_of_pair(), full)
    assert_allclose(forces.vectors_of_curves(found)[0], forces.vectors(small.forces_of_case())[0])
    assert not np.allclose(forces.vectors(found)[0], forces.vectors(small.forces_of_case())[0])
    errors = [fit.compute(small.contact_of_pair(), one, SETTINGS) for one in (found, small.forces_of_case())]
    assert_allclose(errors[0].curve_error, errors[1].curve_error, rtol=1e-6)


# Beams


@pytest.fixture(scope="module")
def base():
    settings = small.settings_of(variant_beams, job_settings(small.PLAN, f"studies/variants/{small.CASE}_base"))
    settings = replace(settings, beam=replace(settings.beam, samples=12))
    return settings, variant_beams.compute(small.contact_of_pair(), small.CASE, settings)


def shifted(base, energy, pull_off):
    settings, found = base
    full = replace(settings, water=corrected(energy, pull_off))
    return variant_beams.compute(small.contact_of_pair(), small.CASE, full), found


def test_the_variant_of_full_contact_is_corrected_where_predictions_are_not():
    """Ratios of a study are not applied to predictions, which stay on summits: the variant shows what they do."""
    error = pair_model_error.compute(study(), HUMIDITIES)
    job = Graph(Plan(load({"run": {"studies": ["full_contact", "variants"]}}))).job(
        "studies/variants/b_rh067_contact_full"
    )
    settings = job.stage.complete(job.stage.converted(job.settings), {"model_error": error})
    assert settings.water.changes(0.67)[0].ratio == pytest.approx(0.9)
    plain = corrections.with_correction(settings, {"model_error": error})
    assert plain.water.changes(0.67) == (NONE, NONE)


def test_ratios_of_one_leave_all_crack_lengths_as_they_are(base):
    full, found = shifted(base, 1, 1)
    assert full.equals(found)


def test_cracks_on_corrected_laws_follow_the_fourth_root_of_the_energy(base):
    full, found = shifted(base, 0.7, 0.7)
    longer = float(full.crack_length.mean() / found.crack_length.mean())
    assert longer == pytest.approx(0.7**-0.25, rel=0.01)
    assert longer != pytest.approx(0.7**-0.5, rel=0.01)


# Dry air


def test_dry_air_has_a_ratio_of_its_own_and_is_no_end_of_a_line():
    ratios = ElasticChange(np.array([0.5, 0.6, 1.0])), ElasticChange(np.array([0.4, 0.7, 0.9]))
    given = Correction(np.array([0, 0.44, 0.92]), *ratios)
    assert ratios_at(given, 0) == pytest.approx((0.5, 0.4))
    assert ratios_at(given, 0.44) == pytest.approx((0.6, 0.7))
    with pytest.raises(ValueError, match=r"from 0\.44 to 0\.92 and is not extrapolated to 0\.2"):
        given.at(0.2)
    with pytest.raises(ValueError, match="in other air alone and is not extrapolated to 0"):
        Correction(np.array([0.44, 0.92]), ElasticChange(0.6), ElasticChange(0.7)).at(0)
    assert Correction(np.array([0.0]), ElasticChange(0.6), ElasticChange(0.7)).at(0.5) == (NONE, NONE), (
        "humid air has none by default"
    )


def test_surfaces_without_condensation_have_the_ratios_of_dry_air_at_any_humidity():
    given = Correction(np.array([0.0]), ElasticChange(0.6), ElasticChange(0.7))
    waxed = Water(300.0, contact_angles=(1.8, 1.8), correction=given)
    assert waxed.changes(0.5) == waxed.changes(0.0) == (ElasticChange(0.6), ElasticChange(0.7))
    assert Water(300.0).changes(0.5) == (NONE, NONE)


def test_the_error_in_dry_air_is_that_of_its_strips_and_changes_no_humid_one():
    dry = study(energy=(0.5, 0.6, 1.0)).assign_coords(humidity=[0, 0.44, 0.92])
    at = 0, 0.3, 0.44, 0.6, 0.92
    found = pair_model_error.compute(dry, at)
    alone = pair_model_error.compute(dry.isel(humidity=[1, 2]), at)
    assert float(found.energy_ratio[0]) == pytest.approx(0.5)
    assert float(found.energy_ratio_error[0]) < 1e-9
    assert np.isnan(found.energy_ratio[1])
    for name in ("energy_ratio", "energy_ratio_error", "length_factor_error"):
        assert_allclose(found[name][2:], alone[name][2:], rtol=1e-9)


# The error beside predictions


def test_the_error_of_a_pair_is_interpolated_between_the_computed_humidities_and_marked():
    found = pair_model_error.compute(study(), (0.92, 0.55, 0.44, 0.67, 0.4), (0.44, 0.55, 0.67, 0.92))
    assert found.humidity.values.tolist() == [0.4, 0.44, 0.55, 0.67, 0.92]
    assert found.interpolated.values.tolist() == [True, False, True, False, False]
    assert np.isnan(found.energy_ratio[0])
    assert_allclose(found.energy_ratio.sel(humidity=list(HUMIDITIES)), [0.6, 0.9, 1.0])
    assert_allclose(found.length_factor[1:], found.energy_ratio[1:] ** -0.25)
    assert_allclose(found.pull_off_ratio.sel(humidity=list(HUMIDITIES)), [0.7, 0.95, 1.0])
    error = found.length_factor_error[1:]
    assert_allclose(error[[0, 2, 3]], 0, atol=1e-12)  # no scatter between strips
    assert 0.001 < error[1] < 0.05  # of the interpolation alone
    given = corrections.applied(found)
    assert ratios_at(given, 0.55) == pytest.approx((float(found.energy_ratio[2]), float(found.pull_off_ratio[2])))


def of_device(device, **changed):
    settings = device_model_error.Settings((0.44, 0.55, 0.92, 0.95), device, **changed)
    return device_model_error.compute(settings, study())


def test_cracks_of_a_cantilever_change_like_those_of_table_3_and_nothing_is_said_about_its_tip():
    found = of_device(DesignedBeam("cantilever", "b", 2.6e-6, 20e-6, 30e-6, 164e9, 1.5e-6))
    assert found["shape"].values.tolist() == [S_SHAPE, EITHER]
    assert_allclose(found.factor.sel(shape=S_SHAPE)[:3], [0.6**-0.25, found.factor[0, 1], 1])
    assert found.interpolated.values.tolist() == [False, True, False, True]
    assert np.isnan(found.factor.sel(shape=EITHER)).all()
    assert np.isnan(found.factor[0, 3])


def test_forces_of_stoppers_change_by_the_ratio_of_the_forces_and_not_by_that_of_the_energies():
    found = of_device(None).sel(shape=FORCE)
    assert_allclose(found.factor.sel(humidity=[0.44, 0.92]), [0.7, 1.0])
    assert not np.allclose(found.factor.sel(humidity=0.44), 0.6)


def test_lengths_of_bridges_change_with_energy_and_force():
    bridge = DesignedBeam("bridge", "b", 2e-6, 2e-6, 30e-6, 164e9, 0.5e-6, residual_stress=50e6)
    both = of_device(bridge).factor.sel(shape=MIDDLE, humidity=0.44)
    same = device_model_error.Settings((0.44,), bridge)
    of_energy = device_model_error.compute(same, study(pull_off=(1, 1, 1))).factor[0, 0]
    nothing = device_model_error.compute(same, study((1, 1, 1), (1, 1, 1))).factor[0, 0]
    assert float(both) > float(of_energy) > float(nothing) == pytest.approx(1)


# Which stages


FULL = Plan(
    load(
        {
            "contact": {"model": "full"},
            "pairs": {"b": {"humidities": [0.4, 0.67, 0.98]}},
            "devices": {
                "C1": {
                    **{"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30},
                    **{"humidities": [0.67], "chart": {"thicknesses_um": [2, 4], "humidities": [0.5, 0.9]}},
                    "uncertainty": {"gap_um": 0.1},
                },
                "S1": {
                    **{"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20},
                    **{"humidities": [0.67], "uncertainty": {"humidity": 0.01}},
                },
            },
        }
    )
)
#: Jobs that make force laws of a contact.
OF_LAWS = ("forces/b_rh067_NG", "humidity/b_NG", "studies/variants/b_rh067_base", "devices/ground/b_rh067_1500x30000")
OF_LAWS += (
    "devices/ground/b_rh050_1500x30000",
    "devices/stoppers/S1",
    "devices/budget/C1_rh067",
    "devices/budget/S1_rh067",
)


@pytest.mark.parametrize("name", OF_LAWS)
def test_all_laws_of_a_corrected_pair_are_corrected_and_otherwise_none(name):
    """Ratios have the attraction across gaps of the laws: devices have it, pairs of the paper in humid air do not."""
    between = "across/" if name.startswith("devices") else ""
    assert Graph(FULL).job(name).inputs["model_error"] == f"studies/model_error/{between}b"
    plain = Plan(FULL.config | {"contact": FULL.config["contact"] | {"model": "summits"}})
    assert "model_error" not in Graph(plain).job(name).inputs
    assert Graph(plain).job(name).settings == Graph(FULL).job(name).settings


def test_gaussian_surfaces_and_errors_of_fits_are_not_corrected():
    for name in ("forces/b_rh067_G", "fit/b_rh067_NG"):
        assert "model_error" not in Graph(FULL).job(name).inputs


def test_a_stopper_is_corrected_by_the_ratio_of_the_forces():
    wanted = stoppers.Settings(1, WATER, (6e-6, 1.5e-6), (0.67,), (0.5, 0.8), restoring_force=2e-5)
    error = pair_model_error.compute(study(), HUMIDITIES, HUMIDITIES)
    full = corrections.with_correction(wanted, {"model_error": error})
    base, found = (stoppers.compute(small.contact_of_pair(), one) for one in (wanted, full))
    assert_allclose(found.pull_off, 0.95 * base.pull_off)
    assert corrections.with_correction(wanted, {}) is wanted


def test_the_contact_itself_does_not_know_of_the_correction():
    settings = [Graph(of).job("contact/b_NG/0-of-5").settings for of in (FULL, Plan(load()))]
    assert "model" not in settings[0]["contact"]
    assert settings[0]["contact"] == settings[1]["contact"]
    assert contact.first(small.contact_of_pair(), 3).sizes["strip"] == 3
