"""Energies by levels for the beams of devices: of strips, as data, as corrections, and in a plan."""

from types import SimpleNamespace

import numpy as np
import pytest
import small
from answers import CANTILEVER, STOPPER
from numpy.testing import assert_allclose
from plans import job_settings
from test_corrections import study

from stiction.analysis.levels import FINE, SUMMITS, Ratio
from stiction.config.cases import Case
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact.correction import NONE
from stiction.contact.full.effort import Effort, TooLong
from stiction.contact.full.smooth_pairs import in_wetter_air
from stiction.errors import NotConverged
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.stages.contact import corrections, full_contact, full_energy, pair_model_error, tips_in_full_contact
from stiction.stages.devices import device_model_error
from stiction.stages.devices.opening import EITHER, MIDDLE, S_SHAPE, DesignedBeam

SIZE = {"pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
BRIDGE = SIZE | {"kind": "bridge", "gap_um": 2, "thickness_um": 2, "residual_stress_MPa": 50, "humidities": [0.67]}
ENERGY = "studies/full_contact/energy/b_rh044"


def found(ratio, error, power=1.2):
    """Dataset of energies with a ratio and its relative error."""
    strips = {SUMMITS: 64, FINE: 4, 2: 10, 3: 64}
    values = Ratio(ratio, error, power, 0.05, (FINE, 2, 3, SUMMITS), strips, 0.2)
    return full_energy.layout(values, full_energy.StripQuantities(2e-3, 1e6))


UNKNOWN = full_energy.layout(full_energy.UNKNOWN, full_energy.NOT_FOUND, "it does not settle")
BY_HUMIDITY = {
    ("b", 0.67): found(0.9, 0.02),
    ("b", 0.44): found(0.7, 0.03),
    ("b", 0.8): found(1.1, 0.2),
    ("b", 0.9): UNKNOWN,
}


@pytest.fixture(scope="module")
def strips():
    """Strips of a narrow pair b at RH 0.44."""
    settings = in_si(full_energy.Settings, job_settings(small.PLAN, ENERGY) | {"forces": True})
    return full_energy.strips_of(small.surfaces(), "b", settings)


@pytest.mark.slow
def test_the_state_from_a_coarse_one_has_the_energy_and_the_force_of_the_whole_separation(strips):
    """The whole separation begins without attraction, on the fine grid alone."""
    level = strips.levels[FINE]
    for place in range(3):
        nested = strips.energy(FINE, place)
        heights = strips.heights(strips.resisting[place])
        separated = full_contact.separated(
            level.space, heights, full_contact.StripInAir(level.adhesion, strips.curves[place], 0.0)
        )
        assert nested == pytest.approx(separated.adhesion_energy, rel=4e-3)
        assert strips.pull_off(FINE, place) == pytest.approx(separated.pull_off, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("quantity", ["energy", "pull_off"])
def test_a_coarse_grid_scatters_less_about_full_contact_than_summits_do(strips, quantity):
    of = getattr(strips, quantity)
    values = {level: np.array([of(level, k) for k in range(6)]) for level in (FINE, 2, 3, SUMMITS)}
    scatter = {level: np.std(np.log(values[FINE] / values[level])) for level in (2, 3, SUMMITS)}
    # Six strips know a scatter to 30 %, so that both grids cannot be told apart where forces jump.
    assert max(scatter[2], scatter[3]) < scatter[SUMMITS]
    assert scatter[2] < 0.05


@pytest.mark.slow
def test_energies_on_summits_are_those_of_the_contact_of_the_same_strips(strips):
    airs = full_contact._airs(small.surfaces(), "b", strips_settings(), 2)[1][0]
    assert_allclose([strips.energy(SUMMITS, k) for k in range(2)], [airs(k).on_summits[0] for k in range(2)], rtol=1e-5)


def strips_settings():
    """Settings of the strips of these tests."""
    return in_si(full_energy.Settings, job_settings(small.PLAN, ENERGY))


def test_energies_that_are_not_found_correct_nothing(monkeypatch):
    def fails(*_):
        raise NotConverged("full elastic contact does not settle", 1.0, 0.1, 3)

    monkeypatch.setattr(full_energy, "strips_of", fails)
    unknown = full_energy.compute([], Case("b_rh044"), strips_settings())
    assert "does not settle" in unknown.reason
    assert not unknown.applied
    assert np.isnan(unknown.ratio)


def test_without_forces_energies_alone_are_corrected_where_their_error_allows():
    error = pair_model_error.of_devices(BY_HUMIDITY)
    assert error.applied.values.tolist() == [True, True, False, False]
    changes = corrections.applied(error)
    energy, pull_off = changes.at(0.44)
    assert energy[:3] == pytest.approx((0.7, 1.2, 0.03))
    for humidity in (0.44, 0.5, 0.67, 0.8, 0.9):
        assert changes.at(humidity)[1] == NONE
    assert changes.at(0.8)[0] == changes.at(0.9)[0] == NONE
    assert changes.at(0.43)[0] == energy
    assert pull_off == NONE


def with_forces(ratio, error):
    """Dataset of energies and forces, these with a ratio and its relative error."""
    strips = {SUMMITS: 64, FINE: 4, 2: 10, 3: 64}
    forces = Ratio(ratio, error, 1.1, 0.05, (FINE, 2, 3, SUMMITS), strips, 0.2)
    return found(0.9, 0.02).assign(full_energy._ratio(forces, full_energy.ALLOWED_OF_FORCES, "pull_off_"))


def test_forces_are_corrected_at_their_humidities_and_between_them_with_the_error_of_the_interpolation():
    forces = {0.44: (0.7, 0.03), 0.6: None, 0.9: (1.2, 0.02), 0.95: (1.5, 0.3)}
    data = {("b", rh): with_forces(*of) if of else found(0.9, 0.02) for rh, of in forces.items()}
    changes = corrections.applied(pair_model_error.of_devices(data))
    assert changes.at(0.44)[1] == pytest.approx((0.7, 1.1, 0.03, 0.05))
    assert changes.at(0.4)[1] == changes.at(0.44)[1], "drier air"
    between = changes.at(0.6)[1]
    assert between.ratio == pytest.approx(0.7 * (1.2 / 0.7) ** (0.16 / 0.46))
    assert between.ratio_error > 0.03
    assert changes.at(0.95)[1] == NONE, "its error is too large"


def test_forces_beyond_the_wettest_hold_as_much_as_summits_in_saturated_air_and_never_less_than_in_drier_air():
    for ratio, rises in ((0.6, True), (1.2, False)):
        data = {("b", 0.5): with_forces(ratio, 0.03), ("b", 0.9): found(0.9, 0.02)}
        changes = corrections.applied(pair_model_error.of_devices(data))
        stated, beyond = changes.at(0.5)[1], changes.at(0.9)[1]
        assert beyond.ratio == pytest.approx(ratio**0.2 if rises else in_wetter_air(ratio, 0.5, 0.9))
        if rises:
            assert beyond.ratio_error > abs(0.8 * np.log(ratio)), "one humidity does not know the curve"
        wetter = changes.at(0.95)[1]
        shifted = beyond.ratio**0.5 if rises else in_wetter_air(beyond.ratio, 0.9, 0.95)
        assert wetter.ratio == pytest.approx(shifted), "a shift of a budget"
        assert wetter.ratio > beyond.ratio
        assert changes.at(0.45)[1] == stated, "control: drier air"


def test_a_humidity_whose_forces_are_not_found_stays_on_summits_though_a_drier_one_is_known():
    data = {("b", 0.5): with_forces(0.6, 0.03), ("b", 0.9): with_forces(np.nan, np.nan)}
    error = pair_model_error.of_devices(data)
    assert error.pull_off_applied.values.tolist() == [True, False]
    assert np.isnan(error.pull_off_ratio[1])
    assert corrections.applied(error).at(0.9)[1] == NONE


def test_a_strip_that_cannot_be_separated_leaves_its_energy():
    strips = full_energy.Strips(None, None, {full_energy.FINE: AtRest()}, None, 0.5, Effort(np.inf), forces=True)
    strips.resisting.append(0)
    strips.curves.append(())
    strips.last[0] = np.zeros((4, 4))
    assert strips.energy(full_energy.FINE, 0) == 2.0
    with pytest.raises(ValueError, match="was not found"):
        strips.pull_off(full_energy.FINE, 0)


def test_what_would_take_too_long_stays_on_summits_with_this_reason(monkeypatch):
    strips = full_energy.strips_of(small.surfaces(), "b", strips_settings())
    for place in range(full_energy.PILOT):
        for grid in full_energy.GRIDS:
            strips.energy(grid, place)
    on_coarse_grids = strips.effort.spent
    strips.effort.most = 7 * on_coarse_grids
    with pytest.raises(TooLong):
        strips.energy(FINE, 0)
    assert strips.effort.spent == on_coarse_grids, "before the first strip on the fine grid"
    monkeypatch.setattr(full_energy, "EFFORT", on_coarse_grids / 2)
    unknown = full_energy.compute(small.surfaces(), Case("b_rh044"), strips_settings())
    assert "takes too long" in unknown.reason
    assert not unknown.applied


class AtRest:
    """Level whose strips come to rest and cannot be separated."""

    def at_rest(self, *_):
        """State at rest."""

    def energy(self, *_):
        """Energy of the state [J m⁻²]."""
        return 2.0

    def pull_off(self, *_):
        """Raise, as a separation that does not settle does."""
        raise NotConverged("full elastic contact does not settle", 1.0, 0.1, 3)


def tips(humidity, ratios, strips=8):
    """Study of tips at one humidity, whose forces are those on summits times a ratio at each slope."""
    summits = np.exp(0.5 * np.random.default_rng(1).standard_normal((strips, len(ratios), 1)))
    rows = np.stack([summits * np.reshape(ratios, (-1, 1)), summits], axis=-1)
    settings = small_tips(humidity, len(ratios))
    return tips_in_full_contact.layout(rows, settings)


def small_tips(humidity, slopes):
    """Settings with the slopes and the humidity of tips."""
    slopes = tuple(np.geomspace(0.03, 0.2, slopes))
    return SimpleNamespace(tilt=SimpleNamespace(slopes=slopes), humidities=(humidity,))


def test_tips_are_corrected_at_all_humidities_and_hold_as_much_as_summits_in_saturated_air():
    data = {("b", rh): tips(rh, ratios) for rh, ratios in ((0.44, [0.5, 0.3]), (0.9, [0.9, 1.1]))}
    changes = corrections.applied(
        pair_model_error.of_devices(BY_HUMIDITY | {("b", 0.97): found(1, 0.02)}, None, None, data)
    )
    at = {
        rh: [change.ratio for change in changes.of_tips(rh, np.array([0.03, 0.2]))]
        for rh in (0.4, 0.44, 0.67, 0.9, 0.97)
    }
    assert at[0.44] == pytest.approx([0.5, 0.3])
    assert at[0.4] == at[0.44]
    assert at[0.67] == pytest.approx([np.sqrt(0.45), np.sqrt(0.33)], rel=1e-9)
    assert at[0.97] == pytest.approx([0.9**0.3, in_wetter_air(1.1, 0.9, 0.97)], rel=1e-9)
    assert [change.ratio for change in pair_model_error_without_tips().of_tips(0.44, np.array([0.1]))] == [1.0]


def test_tips_that_do_not_settle_stay_on_summits(monkeypatch):
    def fails(*_):
        raise NotConverged("full elastic contact does not settle", 1.0, 0.1, 3)

    monkeypatch.setattr(tips_in_full_contact, "compute", fails)
    settings = SimpleNamespace(strips=8, **vars(small_tips(0.44, 2)))
    unknown = tips_in_full_contact.compute_for_devices([], "b", settings)
    error = pair_model_error.of_devices(BY_HUMIDITY, tips_in_water={("b", 0.44): unknown})
    assert not error.tip_applied.any()
    assert corrections.applied(error).of_tips(0.44, np.array([0.1])) == [NONE]


def pair_model_error_without_tips():
    """Changes of a pair without tips."""
    return corrections.applied(pair_model_error.of_devices(BY_HUMIDITY))


def test_dry_air_keeps_its_own_corrections_beside_humid_air():
    dry = study().isel(humidity=[0]).assign_coords(humidity=[0.0])
    joined = corrections.applied(pair_model_error.of_devices(BY_HUMIDITY, dry))
    alone = pair_model_error.compute(dry, [0.0], [0.0])
    for change, expected in zip(joined.at(0.0), corrections.applied(alone).at(0.0), strict=True):
        assert change == pytest.approx(expected)
    assert joined.at(0.44)[0].ratio == pytest.approx(0.7)


def designed(section):
    """Beam of a section."""
    plan = Plan(load({"devices": {"One": section}}))
    return in_si(DesignedBeam, job_settings(plan, "devices/model_error/One")["device"])


def test_the_change_of_a_length_is_the_fourth_root_of_that_of_the_energy():
    by_levels = pair_model_error.of_devices(BY_HUMIDITY)
    device = in_si(
        DesignedBeam, job_settings(Plan(load({"devices": {"C1": CANTILEVER}})), "devices/model_error/C1")["device"]
    )
    settings = device_model_error.Settings((0.44, 0.9), device, by_levels=True)
    changed = device_model_error.compute(settings, by_levels=by_levels)
    assert float(changed.factor.sel(shape=S_SHAPE, humidity=0.44)) == pytest.approx(0.7**-0.25, rel=1e-6)
    assert float(changed.factor_error.sel(shape=S_SHAPE, humidity=0.44)) == pytest.approx(
        0.7**-0.25 * 0.03 / 4, rel=0.03
    )
    assert np.isnan(changed.factor.sel(shape=EITHER)).all()
    assert np.isnan(changed.factor.sel(humidity=0.9)).all()
    assert changed.applied.values.tolist() == [True, False]


def test_a_bridge_changes_less_than_by_its_energy_because_its_force_stays():
    device = in_si(
        DesignedBeam, job_settings(Plan(load({"devices": {"R1": BRIDGE}})), "devices/model_error/R1")["device"]
    )
    settings = device_model_error.Settings((0.44,), device, by_levels=True)
    changed = device_model_error.compute(settings, by_levels=pair_model_error.of_devices(BY_HUMIDITY))
    assert 1 < float(changed.factor.sel(shape=MIDDLE, humidity=0.44)) < 0.7**-1


@pytest.mark.parametrize(("model", "of_device"), [(None, "devices"), ("summits", None), ("full", "across")])
def test_by_default_devices_have_changes_by_levels_and_pairs_have_none(model, of_device):
    contact = {"contact": {"model": model}} if model else {}
    chart = {"thicknesses_um": [2, 2.6], "humidities": [0.5, 0.8]}
    devices = {"C1": CANTILEVER | {"humidities": [0.44, 0.67], "chart": chart}, "R1": BRIDGE, "S1": STOPPER}
    plan = Plan(
        load(contact | {"devices": devices, "run": {"pairs": ["b"]}, "design": {"worst_humidities": [0.5, 0.9]}})
    )
    graph = Graph(plan)
    expected = f"studies/model_error/{of_device}/b" if of_device else None
    for job in ("ground/b_rh067_1500x30000", "safe_lengths/C1_rh067", "chart/C1_rh067", "stoppers/S1"):
        assert graph.job(f"devices/{job}").inputs.get("model_error") == expected
    assert ("model_error" in graph.job("forces/b_rh067_NG").inputs) == (model == "full")
    if model is None:
        inputs = graph.job("studies/model_error/devices/b").inputs
        stopper = set(STOPPER["humidities"])
        assert {rh for _, rh in inputs["energies"]} == {0.44, 0.67, 0.9, *plan.devices.axis("C1"), *stopper}
        assert {rh for _, rh in inputs["tips_in_water"]} == {0.44, 0.67}
        assert "study" not in inputs
        separated = {rh for (_, rh), file in inputs["energies"].items() if graph.job(file).settings.get("forces")}
        assert separated == {0.67, 0.9, *stopper}


@pytest.mark.parametrize(("length", "spacing", "width"), [(1.5, 10, 30), (2.47, 10, 18), (4.49, 10, 10), (90, 10, 2)])
def test_long_strips_are_narrower_and_have_no_more_points_than_others(length, spacing, width):
    seen = {
        "sampling": {"spacing_nm": spacing, "strip_length_um": length},
        "contact": {"every": 1},
        "beam": {"width_um": 30},
    }
    assert full_energy._width(seen) == width
    points = (1e3 / spacing) ** 2 * length * width
    assert points <= full_energy.POINTS or width == full_energy.NARROWEST
    assert full_energy._width(seen | {"beam": {"width_um": 1.5}}) == 1.5, "those of a narrow beam stay"
    finer = full_energy._width(seen | {"contact": {"every": 1}, "sampling": seen["sampling"] | {"spacing_nm": 5}})
    assert finer == max(2, width // 4) or length == 1.5
