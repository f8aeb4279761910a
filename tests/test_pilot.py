"""The first samples of a run decide before any job what its jobs would refuse, by the criteria of the jobs.

An earlier estimate without samples refused surfaces on which no adhesion is left by false sentences, and accepted
strips that were twice too long.
"""

import functools
import re
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
import yaml
from configurations import PAPER, ROOT, configured
from hypothesis import assume, given
from hypothesis import strategies as st
from written_scans import etched, scans_of

from stiction import pilot
from stiction.chaos.model import draw_laws
from stiction.config import scans
from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.config.validation import normalised
from stiction.contact import forcelaw
from stiction.contact.environment import ForceCurves
from stiction.contact.forcelaw import coefficients
from stiction.device import Device
from stiction.plan.devices import Patch
from stiction.plan.plan import Plan
from stiction.run.disk_cache import DiskCache
from stiction.stages.contact import curves
from stiction.stages.devices import cracks, ground
from stiction.stages.devices.opening import fit_chaos
from stiction.stages.laws import forces
from stiction.study import PairStudy

REMEMBER = DiskCache("none")  # the tests ask for many of the same samples
B = "run: {pairs: [b]}\n"
BEAM = "kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.67]"
STOPPER = "kind: stopper, pair: b, restoring_force_uN: 20, humidities: [0.5]"


def refused(*overlays):
    """What the pilot of a configuration refuses, one line each."""
    return list(map(str, pilot.problems(configured(*overlays), {}, "code", REMEMBER)))


@pytest.mark.parametrize(
    "file",
    ["config.yaml", "examples/devices.yaml", pytest.param("examples/test_beams.yaml", marks=pytest.mark.slow)],
)
def test_the_paper_and_the_examples_can_run(file):
    assert refused((ROOT / file).read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("rms", [10, *(pytest.param(rms, marks=pytest.mark.slow) for rms in (20, 40))])
def test_rough_surfaces_can_run(rms):
    assert refused(B, f"surfaces: {{B2: {{rms_nm: {rms}}}}}\npairs: {{b: {{humidities: [0.67]}}}}") == []


def test_poorly_wetted_surfaces_can_run():
    wax = "materials: {Wax: {contact_angle_deg: 80}}\nsurfaces: {B2: {material: Wax}, Sub1: {material: Wax}}"
    assert refused(B, wax, "pairs: {b: {humidities: [0.85, 0.9]}}\nfigures: {humidity: 0.9}") == []


#: Without a bound by flat surfaces in contact, every sample must resist the adhesion.
TOUCHING = "attraction: {reach: touching}"
DRY = "attraction: {reach: all}\npairs: {b: {humidities: [dry]}}\nfigures: {humidity: dry}"
WEAK, FEW = "surfaces rough enough and a solid stiff enough", "so many summits that every sample resists the adhesion"
#: Mesh of a pair that is not the paper's.
FINE = "pairs: {b: {coarser_mesh: 1}}"
CHART = "chart: {thicknesses_um: [0.2, 3], gaps_um: [10, 20], humidities: [0.5, 0.9]}"
REFUSALS = [
    (
        "surfaces: {B2: {rms_nm: 0.3}}",
        "run.pairs[0] is 'b'",
        f"{WEAK} for its humidities: at RH 0.44 and others, water",
    ),
    (
        f"surfaces: {{B2: {{rms_nm: 0.3}}}}\n{TOUCHING}",
        "run.pairs[0] is 'b'",
        "or choose other humidities in pairs.b.humidities",
    ),
    (
        f"surfaces: {{B2: {{rms_nm: 0.3}}}}\n{DRY}",
        "run.pairs[0] is 'b'",
        f"{WEAK}: in dry air, van der Waals forces pull with up to ",
    ),
    ("surfaces: {B2: {rms_nm: 0.2, psd: identified}}", "run.pairs[0]", "(preliminary, given surfaces.B2.psd = 'identi"),
    ("solid: {young_modulus_GPa: 0.1}", "run.pairs[0] is 'b'", "the summits of sample 0 of"),
    (
        "materials: {Gel: {young_modulus_GPa: 1.0e-4}}\nsurfaces: {Sub1: {material: Gel}}",
        "run.pairs[0] is 'b'",
        "increase the roughness or young_modulus_GPa",
    ),
    (f"beam: {{width_um: 0.06}}\n{TOUCHING}", "beam.width_um is 0.06", f"{FEW}: at RH 0.44 and others, water"),
    (
        f"beam: {{width_um: 0.06}}\n{TOUCHING}",
        "beam.width_um is 0.06",
        "on 1.5 x 0.06 µm of pair b; as far as these samples show, ",
    ),
    (
        f"beam: {{thickness_um: 1}}\n{FINE}",
        "sampling.strip_length_um is 1.5",
        "µm to resolve the cracks of pair b: at RH ",
    ),
    (
        "surfaces: {B2: {kurtosis: 1.5777}}\npairs: {b: {attraction: all, coarser_mesh: 1}}",
        "sampling.strip_length_um is 1.5",
        "must be at most 0.6",
    ),
    (
        "figures: {humidity: 0.88}\npairs: {b: {humidities: [0.44], coarser_mesh: 1}}\nbeam: {thickness_um: 1.2}",
        "sampling.strip_length_um",
        "pair b: at RH 0.88 ",
    ),
    (f"devices: {{D: {{{BEAM}, thickness_um: 0.1}}}}", "devices.D.thickness_um is 0.1", "must be so large that strips"),
    (f"devices: {{D: {{{BEAM}, {CHART}}}}}", "devices.D.chart.thicknesses_um is [0.2, 3]", "of 1.5 µm resolve its"),
    (
        f"devices: {{D: {{{BEAM}, kind: bridge, residual_stress_MPa: 50, thickness_um: 0.1}}}}",
        "devices.D.thickness_um is 0.1",
        "strips of 0.5 µm resolve its cracks, at least 0.3",
    ),
    (
        f"devices: {{D: {{{BEAM}, width_um: 0.06}}}}\n{TOUCHING}",
        "devices.D.width_um is 0.06",
        f"{FEW}: at RH 0.67, water",
    ),
    (
        f"devices: {{D: {{{STOPPER}, contact_um: [0.1, 0.1]}}}}\n{TOUCHING}",
        "devices.D.contact_um is [0.1, 0.1]",
        "0.1 x 0.1 µm of",
    ),
    (
        f"devices: {{D: {{{BEAM}, test_beams: [first]}}}}\ntest_beams: {{first: {{pair: b, thickness_um: 0.2, gap_um: "
        "20, width_um: 30, length_um: 900, crack_lengths: [{humidity: 0.67, mean_um: 100, std_um: 5, beams: 9}]}}",
        "test_beams.first.thickness_um is 0.2",
        "must be so large that strips of 1.5 µm resolve its cracks, at least",
    ),
]


#: One of each kind: pairs, strips and devices; the others are slow tests.
FAST = {0, 5, 7, 12}
ROWS = [
    pytest.param(*row, id=row[0][:50], marks=[pytest.mark.slow] * (number not in FAST))
    for number, row in enumerate(REFUSALS)
]


@pytest.mark.parametrize(("overlay", "key", "words"), ROWS)
def test_what_the_jobs_would_refuse_is_refused_by_name(overlay, key, words):
    (line,) = refused(B, overlay)
    assert line.startswith(key)
    assert f"{key.split(' is')[0]} is " in line
    assert ", must " in line
    assert words in line


@pytest.mark.parametrize(
    ("humidities", "weak", "advice"),
    [
        ([0.44, 0.67], [0.44], "young_modulus_GPa, or choose only 0.67 in pairs.b.humidities"),
        ([0.0, 0.67], [0.67], "young_modulus_GPa, or choose only dry in pairs.b.humidities"),
        ([0.0, 0.67], [0.0, 0.67], "young_modulus_GPa, or choose other humidities in pairs.b.humidities"),
        ([0.0], [0.0], "young_modulus_GPa"),
    ],
)
def test_other_humidities_are_advised_where_a_study_has_humid_air(humidities, weak, advice):
    use = pilot.PatchUse(Patch("b", 1500, 30000), ("NG",), humidities, (), (), ("pairs", "b", "humidities"))
    _, message = pilot._weak(use, weak, {"pull": 1e6, "repulsion": 0, "sample": 0, "samples": 5, "together": 0})
    assert message.endswith(f"; increase the roughness or {advice}")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Folder with two scans of B2."""
    path = tmp_path_factory.mktemp("scans")
    scans_of(path, count=2)
    return path


@pytest.mark.parametrize("heights", ["moments", pytest.param("measured", marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    ("overlay", "begins"),
    [
        ("solid: {young_modulus_GPa: 0.05}", "run.pairs[0] is 'b', must have surfaces rough enough"),
        ("beam: {thickness_um: 0.5}", "sampling.strip_length_um is 1.5, must be at most"),
    ],
)
def test_measured_surfaces_are_drawn_from_their_preliminary_numbers(written, overlay, begins, heights):
    files = sorted(written.glob("B2-*.gwy"))
    unmet = {"surfaces": {"Unmet": {"scans": {"files": [str(files[1])]}}}}
    valid = functools.reduce(merged, (etched(files[0], heights=heights), unmet, yaml.safe_load(B)), PAPER)
    found = scans.preliminary_estimates(valid)[0]
    assert pilot.problems(normalised(valid), found, "code", REMEMBER) == []
    config = normalised(merged(valid, yaml.safe_load(overlay)))
    (line,) = map(str, pilot.problems(config, found, "code", REMEMBER))
    assert line.startswith(begins)
    assert line.endswith("(preliminary, given surfaces.Etched.scans.files = ['B2-0.gwy'])")


@pytest.mark.parametrize(
    "overlay",
    ["surfaces: {B2: {rms_nm: 0.3}}", pytest.param("solid: {young_modulus_GPa: 0.1}", marks=pytest.mark.slow)],
)
def test_a_patch_that_does_not_resist_is_refused_with_the_forces_of_its_weakest_sample(overlay):
    config = configured(B, overlay, "contact: {samples: 40}\nchaos: {order: 2}\npairs: {b: {attraction: all}}")
    (line,) = map(str, pilot.problems(config, {}, "code", REMEMBER))
    number, of = map(int, re.search(r"sample (\d+) of (\d+)", line).groups())
    pull = float(re.search(r"with up to ([\d.]+) MPa", line)[1])
    study = PairStudy.of(config, "b", "G" if "Gaussian" in line else "NG")
    pulls = study.forces(0.44).pull_off.values
    assert np.mean(pulls == pulls.max()) > 1 / 3  # so many count as flat surfaces, all with the same force
    assert 0 <= number < of
    assert 0 < pull < 500


@pytest.mark.slow
def test_strips_are_allowed_where_those_of_the_jobs_are_accurate_within_the_error_of_the_samples():
    config = configured(
        B, f"contact: {{samples: 300}}\nchaos: {{order: 4}}\ndevices: {{D: {{{BEAM}, thickness_um: 1, width_um: 10}}}}"
    )
    (line,) = map(str, pilot.problems(config, {}, "code", REMEMBER))
    thickness, longest, error, enough = map(float, re.search(LENGTHS, line).groups())
    device = Device.of(config, "D")
    graph = device.results.graph
    settings = in_si(cracks.Settings, graph.job("devices/cracks/D_rh067").settings)
    of_laws = in_si(ground.Settings, graph.job("devices/ground/b_rh067_1500x10000").settings)
    vectors, limit = curves.vectors(device.contact, 0.67, of_laws.water)
    laws = draw_laws(fit_chaos(vectors, limit, of_laws.chaos), 10_000, np.random.default_rng(1))

    def is_accurate(thickness_um, strip_um):
        """Whether stage cracks resolves another thickness and length of the strips on the same force laws."""
        beam = replace(settings.device, thickness=1e-6 * thickness_um, strip=1e-6 * strip_um)
        beam.opening.resolved(beam, laws)  # goes on even if they are too long
        return beam.strip <= beam.opening.longest_strip(beam, laws)

    assert is_accurate(1, longest - 4 * error)
    assert is_accurate(1, enough)
    assert is_accurate(thickness, 1.5)
    assert not is_accurate(1, longest + 4 * error)
    assert not is_accurate(0.9 * thickness, 1.5)


#: Thickness that would do, longest strip and its error, strips that would do.
LENGTHS = r"at least ([\d.]+) µm: .* allow ([\d.]+) ± ([\d.]+) µm; or decrease strip_um to at most ([\d.]+) µm"


def test_what_is_close_to_the_limit_of_the_samples_runs():
    def lines(strip):
        beam = f"devices: {{D: {{{BEAM}, thickness_um: 1, strip_um: {strip}}}}}"
        return list(map(str, pilot.problems(normalised(merged(PAPER, yaml.safe_load(B + beam))), {}, "code", REMEMBER)))

    (line,) = lines(1.5)
    _, longest, error, _ = map(float, re.search(LENGTHS, line).groups())
    assert 0 < 3 * error < 0.1 * longest
    assert lines(round(longest + error, 2)) == []
    assert len(lines(round(longest + 6 * error, 2))) == 1


@pytest.mark.parametrize("model", ["NG", "G"])
def test_the_samples_are_the_first_ones_of_the_run(model):
    changes = (
        "contact: {samples: 8, asperity: island}\nbeam: {width_um: 3}\nchaos: {order: 1}\nattraction: {reach: all}"
    )
    config = configured(B, changes)
    plan = Plan(config)
    surfaces = functools.partial(pilot.surface, plan)
    samples = pilot.Samples(plan, surfaces, [], lambda _, compute: compute(), Patch("b", 1500, 3000), model, False)
    study = PairStudy.of(config, "b", model)
    solid, bearing, *_ = samples._contact
    np.testing.assert_array_equal(solid, study.contact.solid_pressure)
    np.testing.assert_array_equal(bearing, study.contact.bearing_area)
    expected = coefficients(*forces.vectors(study.forces(0.67)))
    np.testing.assert_array_equal(samples.at(0.67, law=True, preliminary=False)["laws"], expected)


def test_answers_are_remembered_until_something_changes_on_which_they_depend(tmp_path):
    config = configured(B, "contact: {samples: 5}\nchaos: {order: 1}\nbeam: {width_um: 10}")
    kept = tmp_path / "pilot.json"

    def drawn(config, code="code"):
        """Number of contacts that are computed."""
        with patch.object(pilot, "contacts_of_samples", wraps=pilot.contacts_of_samples) as contacts:
            remember = DiskCache(kept)
            pilot.problems(config, {}, code, remember)
            remember.save()
        return contacts.call_count

    assert drawn(config) == 2, "with Gaussian heights and others"
    assert drawn(config) == 0
    assert drawn(merged(config, {"beam": {"thickness_um": 3}})) == 0
    assert drawn(config, "other code") == 2
    for changed in ({"attraction": {"reach": "all"}}, {"surfaces": {"B2": {"rms_nm": 4}}}, {"seed": 2}):
        assert drawn(config) == 2, "the last configuration is remembered"
        assert drawn(merged(config, changed)) == 2


# What force curves show

DISTANCE = 1e-9 * np.arange(40.0)


def curve(repulsion, pull):
    """Force that rises to a repulsion at the distance 2 nm, with its largest attraction at 10 nm."""
    return np.interp(DISTANCE, 1e-9 * np.array([0, 2, 10, 30]), [0.5 * repulsion, repulsion, -pull, 0])


def shown(curves, law=True, preliminary=False):
    return pilot.shown_by(ForceCurves(DISTANCE, curves.__getitem__, len(curves)), law, preliminary)


forces_of_samples = st.lists(st.tuples(st.floats(-1, 5), st.floats(0.5, 3)), min_size=3, max_size=8)


@given(forces_of_samples)
def test_samples_are_weak_if_their_force_curves_have_no_parameters(samples):
    curves = np.array([curve(*sample) for sample in samples])
    repulsion, pull = np.array(samples).T
    assume(np.all(np.abs(repulsion - pull.max()) > 1e-3))
    found = shown(curves)
    if "weak" not in found:
        vectors, limit = forcelaw.parametrise(DISTANCE, curves.__getitem__, len(curves))
        assert len(found["laws"]) == forcelaw.admissible(vectors, limit).sum()
        return
    assert (found["weak"]["sample"], found["weak"]["samples"]) == (np.argmin(repulsion), len(samples))
    assert found["weak"]["pull"] == pytest.approx(pull.max())
    with pytest.raises(ValueError, match="does not rise"):
        forcelaw.parametrise(DISTANCE, curves.__getitem__, len(curves))


def test_a_stopper_resists_if_anything_stops_it():
    held, pressed = curve(0.1, 2.0), np.interp(DISTANCE, [0, 30e-9], [-1, 0])
    assert shown(np.array([held, held]), law=False) == {"laws": []}
    assert "weak" in shown(np.array([held, held]))
    weak = shown(np.array([held, pressed]), law=False)["weak"]
    assert (weak["sample"], weak["repulsion"]) == (1, 0)


def test_larger_patches_resist_if_their_samples_do_together():
    strong, soft = curve(4.0, 1.0), curve(0.0, 1.0)
    assert shown(np.array([strong, soft] * 4))["weak"]["together"] == 2
    assert shown(np.array([strong, soft, soft, soft] * 4))["weak"]["together"] is None, "0.25 x 4 does not exceed 1"
    assert shown(np.array([soft] * 4))["weak"]["together"] is None


def test_surfaces_whose_spectrum_is_preliminary_are_refused_if_no_sample_resists():
    strong, soft = curve(4.0, 1.0), curve(0.0, 1.0)
    assert len(shown(np.array([strong, soft, strong]), preliminary=True)["laws"]) == 2
    assert "weak" in shown(np.array([soft, soft]), preliminary=True)


def test_wedges_of_stiff_beams_above_a_small_gap_that_do_not_fit_into_memory_are_refused():
    stiff = {"kind": "cantilever", "pair": "b", "thickness_um": 100, "gap_um": 1, "width_um": 800, "humidities": [0.67]}
    (line,) = map(str, pilot.problems(normalised(merged(PAPER, {"devices": {"C1": stiff}})), {}, "code", REMEMBER))
    assert line.startswith("devices.C1.gap_um is 1, must leave fields within 8 GB of memory")


def test_single_samples_that_do_not_resist_are_left_to_jobs_that_count_them_as_flat_surfaces():
    strong, soft = curve(4.0, 1.0), curve(-0.1, 1.0)

    def shown(curves, law=True, flat=(1e-7, 50.0)):
        return pilot.shown_by(ForceCurves(DISTANCE, np.array(curves).__getitem__, len(curves), None, flat), law)

    # With the law of a flat surface, no strips would be short enough; jobs then state the safe side.
    assert shown([strong, strong, soft])["laws"] == shown([strong, strong])["laws"]
    assert shown([strong, strong, soft], law=False) == {"laws": []}
    assert "weak" in shown([strong, soft, soft])
    assert "weak" in shown([strong, strong, soft], flat=None)


def test_solids_of_devices_attract_each_other_as_in_their_jobs():
    dry = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 20, "humidities": [0, 0.44]}
    config, asked = normalised(merged(PAPER, {"run": {"pairs": []}, "devices": {"S1": dry}})), []

    def remember(question, compute):
        asked.append(question)
        return compute()

    assert pilot.problems(config, {}, "code", remember) == []
    plan = Plan(config)
    for humidity in (0, 0.44):
        water = plan.air_of_devices.water(plan.air_of_devices.contact("b", humidity))
        assert "gaps" in water
        assert any(water in question and humidity in question for question in asked)
