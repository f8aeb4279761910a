"""Probes from their section to their page: forces, changes by full contact, and a measured force that fits or not."""

import dataclasses
import json
import re

import numpy as np
import pytest
from drawn_devices import RUN, SMALL, Files
from numpy.testing import assert_allclose, assert_array_equal
from plans import job_settings

import stiction
from stiction.config.units import in_si
from stiction.contact.vanderwaals import attraction
from stiction.errors import NotConverged
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.report.answer import screen, tables, words
from stiction.stages.answer.answer import answer_of
from stiction.stages.contact import full_contact, probes_in_full_contact
from stiction.stages.contact.pairs import Settings, surface_pair

PLACES = {"kind": "probe", "pair": "b", "radius_um": 0.5, "humidities": [0.45]}
PROBE = PLACES | {"measured_nN": 500, "measured_error_nN": 100}
AREA = 0.636e-6**2
FAR = PROBE | {"measured_nN": 3000}
DRY = PLACES | {"humidities": ["dry"], "contact_um": [0.5, 0.5]}
#: A grid of 256 points in the water under the probe.
FINE = SMALL | {"sampling": {"spacing_nm": 4}}
DEVICES = {
    "P": PROBE | {"uncertainty": {"humidity": 0.02}},
    "Exact": PROBE,
    "Near": PROBE | {"measured_nN": 300},
    "Far": FAR,
    "Dry": DRY,
}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("probes")
    (folder / "provenance.json").write_text(json.dumps([RUN]), encoding="utf-8")
    config = stiction.load(FINE | {"contact": {"samples": 300, "chunks": 1}, "devices": DEVICES})
    return Files(Graph(Plan(config)), folder=folder)


def test_forces_are_those_of_the_probe_changed_by_its_own_full_contact(results):
    stopper, change = results["devices/stoppers/P"], results["studies/model_error/probes/P"]
    study = results["studies/full_contact/probes/P"]
    both = study.pull_off.mean() / study.summit_pull_off.mean()
    assert change.pull_off_ratio == pytest.approx(float(both), rel=0.05)
    assert bool(change.pull_off_applied.all() & change.nearest)
    # The first places of both stages are the same.
    first = stopper.pull_off.values[0, : study.sizes["strip"]] / AREA
    on_summits = study.summit_pull_off.values[:, 0]
    assert np.corrcoef(np.log(first), np.log(on_summits))[0, 1] > 0.999
    of_water, of_solids = 4 * np.pi * 0.5e-6 * 0.072, 2 * np.pi * 0.5e-6 * attraction("water").work_of_adhesion
    assert stopper.pull_off.mean() < of_water + of_solids  # if they were smooth
    assert float(stopper.rms) == pytest.approx(np.hypot(3.4e-9, 0.17e-9), rel=0.01)


def test_its_contact_has_the_shape_and_one_of_a_stopper_does_not(results):
    plan = results.graph.plan
    name = "devices/contact/b_636x636"
    assert job_settings(plan, name)["probe"] == {"radius_um": 0.5}
    flat = {
        "S": {
            "kind": "stopper",
            "pair": "b",
            "contact_um": [0.636, 0.636],
            "restoring_force_uN": 1,
            "humidities": [0.45],
        }
    }
    of_flat = job_settings(Plan(stiction.load(FINE | {"devices": flat})), name)
    assert "probe" not in of_flat
    assert of_flat == {key: value for key, value in job_settings(plan, name).items() if key != "probe"} | {
        "contact": of_flat["contact"]
    }


def test_water_holds_a_probe_more_than_dry_solids_do(results):
    humid, dry = (results[f"devices/stoppers/{name}"].pull_off.mean() for name in ("P", "Dry"))
    assert 0 < dry < min(0.8 * humid, 2 * np.pi * 0.5e-6 * attraction("dry").work_of_adhesion)


def html(results, name):
    results.write(results.graph.job(f"devices/{name}.html"))
    return (results.folder / "devices" / f"{name}.html").read_text(encoding="utf-8")


def page(results, name):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html(results, name)))


@pytest.mark.parametrize(
    ("name", "sign"), [("P", "Fits"), ("Near", "Not decided"), ("Far", "Does not fit"), ("Dry", "Pull-off force")]
)
def test_page_text_table_and_python_say_whether_the_measured_force_fits(results, name, sign):
    said, found = page(results, name), answer_of(results[f"devices/answer/{name}"])
    assert words.sign_of(found)[1] == sign
    text = (results.folder / "devices" / f"{name}.txt").read_text(encoding="utf-8").splitlines()
    assert text[0] == f"{sign}: {screen.headline(found)}"
    assert screen.headline(found) in said.replace("\u00a0", " ")
    row = tables.devices({name: found})
    assert row.cells["verdict"].tolist() == [sign]
    assert row.frame["verdict"].tolist() == [str(found.verdict)]
    sliders = json.loads(re.search(r'id="explorer-data">(.*?)</script>', html(results, name), re.DOTALL)[1])["views"]
    shown = [
        *text,
        str([(list(view["words"].values()), view["grid"]["size"], view["grid"]["share"]) for view in sliders]),
    ]
    assert not re.search("stick|stuck|restoring|spring|build|weak", " ".join(shown), re.IGNORECASE)


def test_the_answer_is_that_of_the_forces_of_its_places(results):
    found, forces = answer_of(results["devices/answer/Far"]), results["devices/stoppers/Far"].pull_off.values[0]
    error = float(results["devices/stoppers/Far"].full_contact_error[0])
    assert found.stuck == found.pull_off.more
    assert found.pull_off.quantiles[:, 0] == pytest.approx(np.quantile(forces, [0.05, 0.5, 0.95]))
    z = np.random.default_rng(1).normal(size=(2, 4000, 1))
    more = np.mean(forces * np.exp(error * z[0]) > 3e-6 + 1e-7 * z[1])
    assert found.pull_off.more.value == pytest.approx(more, abs=3e-3)
    assert found.pull_off.two_sided.value == pytest.approx(2 * found.pull_off.more.value)
    inputs = [answer_of(results[f"devices/answer/{name}"]).pull_off.more for name in ("Exact", "P")]
    assert inputs[1].high - inputs[1].low > inputs[0].high - inputs[0].low
    assert "All inputs count as exact." in page(results, "Far")
    assert "the uncertainty of the inputs" in page(results, "P")


def test_places_that_do_not_settle_leave_forces_on_summits_and_say_so(monkeypatch, results):
    settings = in_si(probes_in_full_contact.Settings, job_settings(results.graph.plan, "studies/full_contact/probes/P"))
    for error in (NotConverged("no end", 1.0, 0.1, 5), ValueError("too soft")):

        def fail(*_, error=error):
            raise error

        monkeypatch.setattr(full_contact, "compute", fail)
        found = probes_in_full_contact.changes(probes_in_full_contact.compute([], settings))
        assert not found.pull_off_applied.any()
        assert np.isnan(found.pull_off_ratio).all()
    assert results["studies/model_error/probes/P"].pull_off_applied.all()  # control


def test_the_largest_residual_is_that_of_one_place(results):
    study = results["studies/full_contact/probes/P"]
    apart = study.assign(pull_off=study.summit_pull_off.copy())
    apart.pull_off[0] *= 2
    found = probes_in_full_contact.changes(apart)
    assert 0.5 < float(found.pull_off_largest_residual[0]) <= 1
    assert found.largest_residual.isnull().all()  # of energies, which say nothing about a probe
    assert float(probes_in_full_contact.changes(study).pull_off_largest_residual[0]) < 1


def test_drawn_heights_are_those_of_the_flat_pair(results):
    """Alternatives of one surface are drawn once, and the probe meets each of them."""
    settings = in_si(Settings, job_settings(results.graph.plan, "devices/contact/b_636x636"))
    surfaces = [(results[f"heights/{name}"], results[f"spectrum/{name}"]) for name in ("B2", "Sub1")]
    probed = surface_pair(surfaces, "NG", settings)
    flat = surface_pair(surfaces, "NG", dataclasses.replace(settings, probe=None))
    drawn = [one.draw(*(np.random.default_rng(k) for k in (1, 2))) for one in (probed, flat)]
    assert_array_equal(*drawn)
    rise = flat.under_flat(drawn[0]) - probed.under_flat(drawn[0]) + probed.depth
    assert_allclose(rise, probed.probe.rise(rise.shape, probed.spacing), atol=1e-13)


def test_a_finished_probe_states_no_full_contact_on_summits():
    config = stiction.load(
        FINE | {"contact": {"samples": 80, "chunks": 1, "model": "summits"}, "devices": {"P": PROBE}}
    )
    jobs = {job.stage.name for job in Graph(Plan(config)).needed("devices")}
    assert "stoppers" in jobs
    assert "probe_in_full_contact" not in jobs
