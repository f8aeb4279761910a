"""What reruns if a file of a scan, its evaluation or the use of an estimate changes: plans with placeholder files."""

import shutil

import pytest
import yaml
from test_reruns import OF_DEVICES, READ_BY, RULES, Tree, behind
from written_scans import etched, scans_of

pytestmark = pytest.mark.slow

#: Surface of the beam of pair b; pair a has none.
CONFIG = {
    "run": {"pairs": ["a", "b"]},
    "pairs": {"a": {"humidities": [0.8]}, "b": {"humidities": [0.8]}},
    "figures": {"humidity": 0.8, "pair": "b"},
    "contact": {"chunks": 2},
    "studies": {"pressing": {"distance_nm": {"b": 4}}},
}
STUDIES = ("correlation", "plasticity/b", "full_contact/b", "pressing/b", "variants/b_rh080_base")
TARGETS = ["all", *(f"results/studies/{name}.nc" for name in STUDIES)]
#: Rules, and the rules that read their outputs, listed by hand; this configuration has no devices.
READ_BY = {
    rule: " ".join(name for name in readers.split() if name not in OF_DEVICES) for rule, readers in READ_BY.items()
}
READ = READ_BY | {
    "scan": "estimate",
    "estimate": "heights_of_scans spectrum_of_scans table_1 slope_contact choice_contact scan_uncertainty",
    "heights_of_scans": READ_BY["heights"].replace("identification spectrum ", "")
    + " spectrum_of_scans variant_summits slope_contact choice_contact",
    "spectrum_of_scans": READ_BY["spectrum"].replace("table_2 ", "") + " variant_summits slope_contact choice_contact",
    "contact": READ_BY["contact"] + " scan_uncertainty",
    "slope_contact": "slopes",
    "slopes": "scan_uncertainty",
    "choice_contact": "scan_uncertainty",
    "scan_uncertainty": "table_3",
}
OF_SCANS = {"scan", "estimate", "heights_of_scans", "spectrum_of_scans"}
OF_SCANS |= {"slope_contact", "slopes", "choice_contact", "scan_uncertainty"}

#: Description of a change; overlay; rules that it affects directly, whose readers rerun as well.
MATRIX = [
    ("levelling", "surfaces: {Etched: {scans: {level: quadratic}}}", "estimate"),
    ("lines", "surfaces: {Etched: {scans: {lines: offset}}}", "estimate"),
    ("channel", "surfaces: {Etched: {scans: {channel: Topography}}}", "scan"),
    ("tip", "surfaces: {Etched: {scans: {tip_radius_nm: 10}}}", "estimate"),
    ("form of the heights", "surfaces: {Etched: {heights: measured}}", "heights_of_scans"),
    ("form of the spectrum", "surfaces: {Etched: {psd: tabulated}}", "spectrum_of_scans"),
    ("spectrum beyond the scans", "surfaces: {Etched: {beyond: continued}}", "spectrum_of_scans"),
    ("samples of the slopes", "studies: {slopes: {samples: 30}}", "slope_contact choice_contact"),
    ("model scans", "scans: {model_scans: 9}", "estimate"),
    ("defaults written out", "surfaces: {Etched: {heights: moments, scans: {level: plane}}}", ""),
    ("moments of another surface", "surfaces: {B1: {kurtosis: 4.5}}", None),
]
ROWS = [pytest.param(*row, id=name) for name, *row in MATRIX]


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Source tree with all results from scans up to date."""
    scratch = tmp_path_factory.mktemp("scratch")
    scans_of(scratch, count=3)
    changes = etched("B2-0.gwy", "B2-1.gwy")
    for section, change in CONFIG.items():
        changes[section] = changes.get(section, {}) | change
    changes["pairs"]["b"] |= {"beam": "Etched"}
    tree = Tree(tmp_path_factory.mktemp("tree"), scratch, yaml.safe_dump(changes), TARGETS)
    yield tree
    tree.planner.close()


def known(rerun):
    """Rules that rerun, without those of figures and further tables, which are never read."""
    return (RULES | OF_SCANS) & set(rerun.values())


def of_pair_a(rerun):
    """Files of pair a and its surfaces that rerun."""
    return [name for name in rerun if "/a_" in name or "/B1" in name or "/Sub1" in name]


def test_an_unchanged_tree_reruns_nothing(done):
    assert done.rerun() == {}


@pytest.mark.parametrize(("overlay", "met"), ROWS)
def test_a_setting_of_a_measured_surface_reruns_what_depends_on_it(done, overlay, met):
    rerun = done.rerun(overlay=overlay)
    if met is None:
        assert not known(rerun) & OF_SCANS
        return
    assert known(rerun) == behind(met.split(), READ)
    assert of_pair_a(rerun) == []


def test_the_content_of_a_file_counts_and_not_its_time(done):
    path = done.small.with_name("B2-1.gwy")
    path.touch()
    assert done.rerun() == {}
    content = path.read_bytes()
    shutil.copy(done.small.with_name("B2-2.gwy"), path)
    try:
        rerun = done.rerun()
        assert known(rerun) == behind(["scan"], READ)
        assert of_pair_a(rerun) == []
        assert "results/scan/Etched_1.nc" in rerun
        assert "results/scan/Etched_0.nc" not in rerun
    finally:
        path.write_bytes(content)


def test_another_version_of_the_library_that_reads_files_reads_them_again(done):
    installed = done.folder / "src" / "SurfaceTopography-99.dist-info"
    installed.mkdir()
    try:
        (installed / "METADATA").write_text("Metadata-Version: 2.1\nName: SurfaceTopography\nVersion: 99\n")
        rerun = done.rerun()
        assert known(rerun) == behind(["scan"], READ)
        assert of_pair_a(rerun) == []
    finally:
        shutil.rmtree(installed)


def test_another_scan_reruns_the_estimate_and_reads_only_the_new_file(done):
    rerun = done.rerun(overlay="surfaces: {Etched: {scans: {files: [B2-0.gwy, B2-1.gwy, B2-2.gwy]}}}")
    assert [name for name, rule in rerun.items() if rule == "scan"] == ["results/scan/Etched_2.nc"]
    assert known(rerun) == behind(["scan"], READ)


def test_code_of_the_evaluation_reruns_measured_surfaces_only(done):
    done.append("src/stiction/scans/periodogram.py", "\nCHANGED = 1\n")
    try:
        rerun = done.rerun()
        assert known(rerun) - {"table_2"} == behind(["estimate"], READ)  # in one module with Table I, which reads it
        assert of_pair_a(rerun) == []
    finally:
        done.git("checkout", "--force", "main")
