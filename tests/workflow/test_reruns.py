"""Which rules a change reruns and which it must not: plans with placeholder files, in a copy of the source tree."""

# ruff: noqa: E501
import contextlib
import os
import re
import shutil
import subprocess
from functools import cache, reduce
from itertools import product
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
import xarray as xr
import yaml
from conftest import ROOT
from planner import PILOT, Planner

from stiction import accuracy
from stiction.config.files import paper
from stiction.config.merging import merged, without_inherited
from stiction.config.scans import resolve_scan_paths
from stiction.config.surfaces import process
from stiction.config.validation import normalised
from stiction.plan.graph import Graph, stages, structured
from stiction.plan.plan import Plan
from stiction.plan.stage import File
from stiction.run import storage
from stiction.run.fingerprint import PACKAGE, fingerprint

#: Two pairs, one figure case, so that every rule has few jobs.
SMALL = """
run: {pairs: [a, b]}
pairs: {a: {humidities: [0.6, 0.8]}, b: {humidities: [0.8]}}
figures: {humidity: 0.8, pair: b}
contact: {chunks: 2}
design: {chart_points: 2}
devices:
  C1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.7],
       chart: {thicknesses_um: [2.6, 3], humidities: [0.6, 0.8]}}
  R1: {kind: bridge, pair: b, thickness_um: 2, gap_um: 2, width_um: 20, residual_stress_MPa: 50, humidities: [0.7]}
studies: {pressing: {distance_nm: {a: 2, b: 4}}}
"""
STUDIES = (
    "correlation",
    "mesh",
    "orders",
    "sample_sizes",
    "sensitivity/b_rms",
    "plasticity/a",
    "plasticity/b",
    *(f"{study}/{pair}" for study in ("full_contact", "asperities", "pressing") for pair in "ab"),
)
VARIANTS = (
    "resampling/a_rh060",
    "resampling/b_rh080",
    "variants/a_rh060_base",
    "variants/b_rh080_base",
    "variants/a_rh060_psd_identified",
)
TARGETS = ["all", *(f"results/studies/{name}.nc" for name in STUDIES + VARIANTS)]

#: Rules, and the rules that read their outputs, listed by hand.
READ_BY = {
    "heights": "identification spectrum iteration character contact_chunk sensitivity_contact plasticity full_contact pressed table_1 checks"
    " device_contact tip_contact",
    "identification": "table_2 variant_summits checks",
    "spectrum": "iteration character contact_chunk table_2 correlation sensitivity_contact plasticity full_contact pressed checks"
    " device_contact tip_contact",
    "character": "table_1 checks",
    "contact_chunk": "contact",
    "contact": "forces fit humidity variant sensitivity",
    "forces": "fit chaos table_3 sample_sizes orders mesh resampling checks",
    "sensitivity_contact": "sensitivity",
    "variant_summits": "variant_contact",
    "variant_contact": "variant",
    "chaos": "beams orders checks",
    "beams": "table_3 checks model_limits",
    "plasticity": "model_limits device_warnings",
    "device_warnings": "table_safe_lengths table_chart device_limits",
    "device_contact": "ground safe_lengths",
    "ground": "cracks chart",
    "tip_contact": "safe_lengths chart",
    "cracks": "safe_lengths",
    "safe_lengths": "table_safe_lengths device_warnings",
    "chart": "table_chart device_warnings",
    "resampling": "checks",
    "checks": "verdict",
}
RULES = {*READ_BY, *" ".join(READ_BY.values()).split(), "readings"}
#: Rules whose files are about all pairs, or about a device with all that it meets.
SHARED = {"table_3", "device_warnings", "table_safe_lengths", "table_chart"}
#: Rules of pair b only.
OF_FIGURE = {"sensitivity_contact", "sensitivity", "sample_sizes", "orders", "mesh"}
#: Rules of devices, which belong to pair b as well.
OF_DEVICES = {
    "ground",
    "device_contact",
    "tip_contact",
    "cracks",
    "safe_lengths",
    "chart",
    "table_safe_lengths",
    "table_chart",
}
OF_DEVICES |= {"device_warnings", "device_limits"}
OF_FIGURE |= OF_DEVICES

#: Description of a change; overlay; rules that it affects directly, whose readers rerun as well; rules excepted because
#: their files do not depend on it; pattern of files that must not rerun.
MATRIX = [
    ("kurtosis of one surface", "surfaces: {B1: {kurtosis: 4.5}}", "heights table_1 variant_summits readings", OF_FIGURE, "B2|Sub1|/b_"),
    # The surface, hence its pair, is no longer the paper's: published values leave the tables.
    ("radius of its summits", "surfaces: {B1: {mean_summit_radius_um: 0.42}}",
     "identification table_1 table_3 checks", OF_FIGURE, "B2|/b_|contact/a_(NG|G)|forces|beams"),
    ("its published spectrum", "surfaces: {B1: {published_psd: {floor_nm4: 0.9}}}", "spectrum variant_summits readings",
     OF_FIGURE, "B2|Sub1|/b_|(summits|contact)/a_psd_identified"),
    ("source of its spectrum", "surfaces: {B1: {psd: identified}}", "spectrum variant_summits readings", OF_FIGURE,
     "B2|/b_|psd_identified"),
    ("surface in a pair", "pairs: {a: {beam: B2}}",
     "table_1 table_2 correlation contact_chunk plasticity full_contact pressed variant_summits readings checks", OF_FIGURE,
     "heights|spectrum|/b_"),
    ("gap of one pair", "pairs: {a: {gap_um: 19}}", "beams resampling variant checks", OF_FIGURE, "/b_|contact|forces|chaos"),
    ("one humidity added", "pairs: {a: {humidities: [0.6, 0.7, 0.8]}}", "full_contact pressed readings forces variant table_3 checks", OF_FIGURE,
     "/b_|/a_rh060|/a_rh080"),
    ("one humidity removed", "pairs: {a: {humidities: [0.6]}}", "full_contact pressed readings humidity table_3 checks model_limits", (), "/b_|/a_rh"),
    ("seed", "seed: 2",
     "identification iteration character contact_chunk chaos beams sensitivity_contact plasticity full_contact pressed readings orders resampling "
     "variant_summits device_contact tip_contact cracks safe_lengths chart", (), ""),
    ("van der Waals model", "van_der_waals: dry",
     "contact_chunk sensitivity_contact plasticity full_contact pressed readings variant_contact device_contact tip_contact", (), "variants/summits"),
    ("elasticity", "solid: {young_modulus_GPa: 160}",
     "contact_chunk beams mesh resampling sensitivity_contact plasticity full_contact pressed readings variant_contact variant checks device_contact "
     "tip_contact cracks safe_lengths chart", (), "variants/summits"),
    ("grid of surfaces", "sampling: {spacing_nm: 5}", "identification spectrum variant_summits readings", (), "heights"),
    ("length of strips", "sampling: {strip_length_um: 2.5}\ndevices: {R1: {thickness_um: 3}}",
     "character contact_chunk beams resampling sensitivity_contact plasticity full_contact pressed variant_summits readings checks device_contact cracks "
     "safe_lengths chart", (),
     "heights|identification|spectrum|tips"),
    ("strips of Table I", "character: {strips: 50}", "character", (), "contact|forces"),
    ("spacing of Table I", "character: {spacing_nm: 10}", "identification character", (), "results/contact|forces"),
    ("patches of identification", "identification: {patches: 4}", "identification", (), "spectrum|_base"),
    # Water moves the scatter of energies, and if that is enough for another number of samples, the contact of devices.
    ("water", "water: {temperature_K: 310}", "full_contact pressed readings forces humidity sensitivity variant ground safe_lengths chart", (), "results/contact"),
    ("adsorbed water", "water: {adsorbed_nm: 0.1}", "full_contact pressed readings forces humidity sensitivity variant device_contact ground safe_lengths chart", (), "results/contact"),
    ("number of samples", "contact: {samples: 5500}", "contact_chunk device_contact", (),
     "studies/(sensitivity/contact|plas|variants/(contact|summits))|psd_identified|tips"),
    ("distance step", "contact: {distance_step_nm: 0.1}",
     "contact_chunk sensitivity_contact plasticity full_contact pressed variant_summits readings device_contact tip_contact", (), "spectrum"),
    ("chaos order", "chaos: {order: 6}", "chaos variant ground", (), "forces"),
    ("beam thickness", "beam: {thickness_um: 2.5}",
     "beams resampling mesh variant checks", (), "contact|forces|chaos"),
    # Energies of devices in full contact are those of strips of their pair, which are as wide as its beam.
    ("beam width", "beam: {width_um: 24}", "character contact_chunk beams resampling mesh sensitivity_contact plasticity full_contact pressed variant_summits readings checks model_limits ground safe_lengths cracks chart",
     (), "heights|spectrum|tips"),
    ("number of beams", "beam: {samples: 500}", "beams", (), "chaos|studies"),
    ("scatter of beams", "beam: {scatter: 0.03}", "beams", (), "chaos|studies|beams/.*_N?G.nc"),
    ("humidity of the figures", "pairs: {b: {humidities: [0.6, 0.8]}}\nfigures: {humidity: 0.6}",
     "full_contact pressed readings forces humidity table_3 checks sample_sizes orders mesh sensitivity variant", (),
     "results/contact|/b_rh080|/a_"),
    ("chunks", "contact: {chunks: 7}", "", (), ""),
    ("points along the humidity", "figures: {humidity_points: 5}", "humidity", (), ""),
    ("study: iteration", "studies: {iteration: {fields: 4}}", "iteration", (), ""),
    ("studies", "studies: {sensitivity: {step: 0.05}, plasticity: {strips: 50}, sample_shares: [0.1, 0.2], "
     "orders: {draws: 1000}, mesh: {strips_um: [7.5]}}",
     "sensitivity_contact plasticity sample_sizes orders mesh", (), "variants"),
    ("study: full contact", "studies: {full_contact: {samples: 9}}", "full_contact", (), ""),
    ("study: readings of an asperity", "studies: {asperities: {samples: 50}}", "readings", (), ""),
    ("study: pressing", "studies: {pressing: {steps: 3}}", "pressed", (), ""),
    ("study: how close one pair is pressed", "studies: {pressing: {distance_nm: {b: 3}}}", "pressed", (), "pressing/a"),
    ("study: resampling", "studies: {resampling: {beams: 5}}", "resampling", (), ""),
    ("study: variants", "studies: {variants: {samples: 500}}", "variant_summits", (), ""),
    ("study: a Poisson's ratio added", "studies: {variants: {poisson_ratio: [0.18, 0.28, 0.3]}}", "variant_contact",
     (), "variants/summits|_base|0.18|0.28"),
    ("study: finer elements", "studies: {variants: {strips_per_element: [2, 1]}}", "variant", (), "_base|_element_2"),
    # A wetter air reaches further: the strips of the tips are stored at more distances. The energies of a pair in full
    # contact at all humidities of devices are one file, which lengths at each of them read.
    ("one humidity of a device", "devices: {C1: {humidities: [0.7, 0.9]}}",
     "tip_contact ground table_safe_lengths device_limits", (), "contact/b"),
    ("a device added", "devices: {C2: {kind: cantilever, pair: a, thickness_um: 3, gap_um: 20, width_um: 30, "
     "humidities: [0.6]}}", "device_contact tip_contact ground table_safe_lengths device_limits verdict", {"chart", "table_chart"}, "results/contact/[ab]_|contact/b_|tips/b_|C1|R1|beams"),
    ("thickness of a device", "devices: {C1: {thickness_um: 3}}", "cracks safe_lengths chart", (), "contact|R1"),
    ("thicknesses of a chart", "devices: {C1: {chart: {thicknesses_um: [2.6]}}}", "tip_contact ground chart", (),
     "contact/b"),
    ("uncertainty of a device", "devices: {C1: {uncertainty: {gap_um: 1}}}", "device_limits verdict", (), ""),
    ("beams of devices", "design: {beams: 300}", "tip_contact cracks chart", (), "results/contact"),
    ("contact angle of a body", "materials: {Wet: {contact_angle_deg: 20}}\nsurfaces: {B2: {material: Wet}}",
     "full_contact pressed readings forces humidity sensitivity variant ground safe_lengths chart table_1 table_2 table_3 checks model_limits",
     (), "results/contact/|/a_"),
    ("order of humidities", "pairs: {a: {humidities: [0.8, 0.6]}}", "", (), ""),
]  # fmt: skip
#: One change of each part of the workflow; the other rows are slow tests.
FAST = {"kurtosis of one surface", "water", "a device added"}
ROWS = [pytest.param(*row, id=name, marks=[pytest.mark.slow] * (name not in FAST)) for name, *row in MATRIX]


def behind(rules, read_by=READ_BY):
    """Rules and all rules downstream of them."""
    reached = set(rules)
    while more := set(" ".join(read_by.get(rule, "") for rule in reached).split()) - reached:
        reached |= more
    return reached


#: Dataset larger than the files whose contents Snakemake compares by default.
LARGE = "results/contact/a_NG.nc"
NOISE = np.frombuffer(np.random.default_rng(0).bytes(2_000_000), np.uint8)  # cannot be compressed


def all_but_sources_and_kernels(folder, names):
    """Names in a folder that its copy leaves out. Compiled kernels come along; other compiled files may be half-written."""
    is_cache = Path(folder).name == "__pycache__"
    return [name for name in names if name.endswith(".egg-info") or (is_cache and not name.endswith((".nbi", ".nbc")))]


class Tree:
    """Copy of the source tree under git, with placeholder files for all results, which are up to date."""

    def __init__(self, folder, scratch, config=SMALL, targets=TARGETS):
        self.folder, self.targets = folder, targets
        for name in ("Snakefile", "config.yaml"):
            shutil.copy2(ROOT / name, folder)
        for name in ("workflow", "src", "profiles"):
            shutil.copytree(ROOT / name, folder / name, ignore=all_but_sources_and_kernels)
        (folder / ".gitignore").write_text(".gitignore\n.snakemake/\nresults/\n__pycache__/\n")
        for command in (["init", "-b", "main"], ["add", "."], ["commit", "-m", "all"]):
            self.git(*command)
        self.small = scratch / "small.yaml"
        self.small.write_text(config)
        named = yaml.safe_load(config)
        joined = without_inherited(merged(paper(), named), paper(), [named])
        whole = process.with_surfaces(resolve_scan_paths(joined, named, scratch))
        with patch.object(accuracy, "PILOT", PILOT):
            self.graph = Graph(Plan(accuracy.decided(normalised(whole))))
        self.overlay = scratch / "overlay.yaml"
        self.planner = Planner(folder, scratch)
        with contextlib.chdir(folder):
            for name in self.planner.outputs(*targets, config=[self.small]):
                self.place(name)
        touched = [*targets, "--touch", "--forceall", "--scheduler", "greedy", "--no-hooks"]
        status, printed = self.planner(*touched, config=[self.small])  # results of the present settings and code
        assert status == 0, printed

    def place(self, name):
        """Make an empty file, or a dataset with settings and inputs but without numbers, except for `LARGE`."""
        path = Path(name)
        if path.exists():
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix != ".nc":
            path.touch()
            return
        job = self.graph.job(name.removeprefix("results/").removesuffix(".nc"))
        read = []
        for files in job.inputs.values():
            structured(files, read.append)
        before = [f"results/{file}.nc" for file in read if not isinstance(file, File)]
        for file in before:
            self.place(file)
        content = xr.Dataset({"limit": ("byte", NOISE)} if name == LARGE else {})
        storage.save(content, name, job.stage.stage, job.settings, before)

    def git(self, *command):
        """Run git in the copy."""
        person = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]
        subprocess.run(["git", "-C", self.folder, *person, *command], check=True, capture_output=True)

    def append(self, path, text):
        """Append text to a file."""
        with (self.folder / path).open("a") as file:
            file.write(text)

    def rerun(self, *arguments, overlay="{}"):
        """Files that would be updated: name to rule."""
        self.overlay.write_text(overlay)
        outputs = self.planner.outputs(*self.targets, *arguments, config=[self.small, self.overlay])
        return {name: rule for name, (rule, again) in outputs.items() if again}


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Source tree with all results up to date."""
    tree = Tree(tmp_path_factory.mktemp("tree"), tmp_path_factory.mktemp("scratch"))
    yield tree
    tree.planner.close()


def known(rerun):
    """Rules that rerun, without those of figures and further tables, which are never read."""
    return RULES & set(rerun.values())


@pytest.mark.parametrize(("overlay", "met", "spared", "stay"), ROWS)
def test_a_setting_reruns_the_rules_it_affects_and_their_readers_and_no_others(tree, overlay, met, spared, stay):
    rerun = tree.rerun(overlay=overlay)
    assert known(rerun) == behind(met.split()) - set(spared)
    assert not [name for name in rerun if stay and re.search(stay, name) and rerun[name] in RULES - SHARED]


@pytest.mark.slow
def test_other_samples_of_the_main_line_or_of_the_variants_rerun_the_base_of_the_variants(tree):
    more, fewer = (
        {name.rpartition("/")[2] for name, rule in tree.rerun(overlay=overlay).items() if rule == "variant"}
        for overlay in ("contact: {samples: 5500}", "studies: {variants: {samples: 500}}")
    )
    assert more == {name for name in fewer if re.search("_base|_element_2", name)} > {"a_rh060_base.nc"}
    assert "a_rh060_psd_identified.nc" in fewer


def test_adding_a_humidity_runs_no_contact_and_no_surface(tree):
    rerun = tree.rerun(overlay="pairs: {a: {humidities: [0.6, 0.7, 0.8]}}")
    made = {name.removeprefix("results/") for name in rerun if name.startswith(("results/c", "results/f", "results/b"))}
    files = {f"{stage}/a_rh070_{model}.nc" for stage, model in product(("forces", "chaos"), ("G", "NG"))}
    beams = {f"beams/a_rh070_{model}.nc" for model in ("G", "NG", "GEO")}
    assert {name for name in made if not re.match("checks|figures|fit/", name)} == files | beams


@pytest.mark.slow
def test_adding_a_humidity_to_the_pair_of_the_figures_draws_no_surface_either(tree):
    rerun = tree.rerun(overlay="pairs: {b: {humidities: [0.7, 0.8]}}")
    assert {"forces", "chaos", "beams", "resampling", "sensitivity", "variant"} <= known(rerun)
    drawing = {"heights", "spectrum", "character", "contact_chunk", "sensitivity_contact", "variant_contact"}
    assert not drawing & known(rerun)


def test_number_of_cores_order_of_keys_comments_docstrings_and_touched_files_rerun_nothing(tree):
    def backwards(value):
        return {key: backwards(value[key]) for key in reversed(value)} if isinstance(value, dict) else value

    path = tree.folder / "config.yaml"
    path.write_text(yaml.safe_dump(backwards(yaml.safe_load(path.read_text())), sort_keys=False))
    assert path.read_text().startswith("studies:")
    for path in [*tree.folder.rglob("*.py"), *tree.folder.rglob("*.smk"), tree.folder / "config.yaml"]:
        tree.append(path, "\n\n# A remark.\n")
        if path.suffix == ".py" and path.read_text().startswith('"""'):
            path.write_text(path.read_text().replace('"""', '"""In other words: ', 1))
    for path in tree.folder.glob("src/stiction/report/resources/*"):
        path.touch()
    assert tree.rerun("--cores", "7", "--set-threads", "beams=3") == {}


@pytest.mark.parametrize(
    ("changed", "rerun"),
    [pytest.param(0, set(), marks=pytest.mark.slow), (1, behind(READ_BY["contact"].split()) - OF_FIGURE)],
)
def test_a_large_file_counts_as_changed_by_its_content_and_not_by_its_time(tree, changed, rerun):
    path = tree.folder / LARGE
    before, content = path.stat(), path.read_bytes()
    middle = len(content) // 2  # among the numbers
    path.write_bytes(content[:middle] + bytes([content[middle] ^ changed]) + content[middle + 1 :])
    try:
        assert known(tree.rerun()) == rerun
    finally:
        path.write_bytes(content)
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


@pytest.mark.slow
def test_switching_to_another_branch_and_back_reruns_nothing(tree):
    tree.git("checkout", "-b", "other")
    tree.append("src/stiction/streams.py", "\nOTHER = 1\n")
    tree.append("src/stiction/stages/heights.py", "\nOTHER = 1\n")
    tree.git("commit", "-am", "other")
    assert tree.rerun() != {}
    tree.git("checkout", "main")
    assert tree.rerun() == {}


@pytest.mark.slow
def test_results_beside_a_new_checkout_are_up_to_date_and_see_its_files(tree, tmp_path):
    moved = tmp_path / "moved"
    shutil.copytree(tree.folder, moved, symlinks=True)
    for path in [*moved.glob("src/**/*.*"), *moved.glob("workflow/**/*.*")]:
        path.touch()
    planner = Planner(moved, tmp_path)

    def rerun():
        outputs = planner.outputs(*tree.targets, config=[tree.small])
        return {rule for rule, again in outputs.values() if again}

    try:
        assert rerun() == set()
        for changed in ("src/stiction/report/resources/table_3.csv", "workflow/report/figure_05.rst"):
            with (moved / changed).open("a") as file:
                file.write("\n")
        beside_published = {"table_3", "table_variants", "figure_15", "figure_variants", "figure_overview"}
        assert (
            beside_published | {"figure_05"}
            <= rerun() & {*stages()}
            <= beside_published | {*("figure_05", "checks", "verdict")}
        )
    finally:
        planner.close()


#: Modules, the rules that a change of the module must rerun and those that it must not, listed by hand.
SPOTS = [
    (
        "beam/release",
        "beams resampling mesh variant",
        "heights spectrum contact_chunk contact variant_contact forces chaos",
    ),
    (
        "contact/meniscus",
        "forces humidity sensitivity variant",
        "heights character contact_chunk contact variant_contact sensitivity_contact plasticity",
    ),
    (
        "contact/asperity",
        "contact_chunk sensitivity_contact variant_contact plasticity",
        "heights spectrum identification character",
    ),
    ("contact/forcelaw", "forces fit humidity sensitivity variant", "contact_chunk contact sensitivity_contact"),
    (
        "devices/chart",
        "chart",
        "heights spectrum contact_chunk contact variant_contact forces chaos beams fit humidity table_3",
    ),
    (
        "beam/energy",
        "beams table_3 checks",
        "heights spectrum contact_chunk contact variant_contact forces chaos fit humidity",
    ),
    ("surface/identify", "identification variant_summits", "heights spectrum character contact_chunk forces beams"),
    ("report/surfaces/tables", "table_1 table_2", "heights spectrum character forces beams table_3 variant"),
    ("report/beams/tables", "table_3", "heights spectrum character forces beams table_1 table_2 variant"),
    ("run/provenance", "", " ".join(RULES - {"device_limits"})),
    ("run/logs", "", " ".join(RULES)),
    ("config/relations", "", " ".join(RULES)),
    ("config/plan", "", " ".join(RULES)),
    ("plan/stage", "", " ".join(RULES)),
    ("plan/graph", "", " ".join(RULES)),
    ("config/files", "", " ".join(RULES)),
    ("config/merging", "variant_summits", "heights spectrum contact_chunk forces beams"),
    ("plan/names", "", " ".join(RULES)),
    ("stages/contact/changes/table", "", " ".join(RULES)),
    ("stages/devices/contact_names", "", " ".join(RULES)),
    (
        "stages/contact/changes/variants",
        "variant_summits variant_contact",
        "heights spectrum contact_chunk plasticity sensitivity_contact device_contact",
    ),
    (
        "stages/contact/changes/moments",
        "sensitivity_contact",
        "contact_chunk variant_summits plasticity device_contact",
    ),
    ("study", "", " ".join(RULES)),
    ("stages/devices/opening", "cracks chart", "heights spectrum contact_chunk tip_contact beams"),
    ("stages/devices/sticking", "cracks safe_lengths chart", "heights spectrum contact_chunk tip_contact beams"),
    # The page of warnings has those about test beams, whose inputs may come from scans.
    (
        "scans/estimate",
        "table_1 table_3",
        " ".join(RULES - {"table_1", "table_2", "table_3", "checks", "verdict", "device_limits"}),
    ),
]
#: The computation of a stage and the layout of its dataset are in one module, so that a new variable in the dataset is
#: a change of that module only. It reruns the stage and the readers of its dataset, and nothing else.
LAYOUTS = {
    "stages/surfaces/heights": {
        "heights",
        *[
            "identification",
            "spectrum",
            "iteration",
            "character",
            "contact_chunk",
            "plasticity",
            "full_contact",
            "pressed",
        ],
    }
    | {"sensitivity_contact", "variant_summits", "readings"},
    "stages/surfaces/identification": {"identification"},
    "stages/surfaces/spectrum": {"spectrum", "sensitivity_contact", "variant_summits", "readings"},
    "stages/surfaces/character": {"character", "table_2"},  # in one module with Table I, which reads it
    "stages/contact/contact": {
        "contact_chunk",
        "full_contact",
        "pressed",
        "readings",
        "sensitivity_contact",
        "variant_summits",  # in one module with the contact of solids on them
        "variant_contact",
        "device_contact",
        "tip_contact",
    }
    | OF_DEVICES,
    "stages/laws/forces": {"forces"},
    "stages/laws/chaos": {"chaos"},
    "stages/beams/beams": {"beams"},
    "stages/surfaces/iteration": {"iteration"},
    "stages/laws/fit": {"fit"},
    "stages/laws/humidity": {"humidity"},
    "stages/laws/sensitivity": {"sensitivity"},
    "stages/contact/plasticity": {"plasticity"},
    "stages/contact/full_contact": {"full_contact", "pressed"},
    "stages/contact/pressing": {"pressed"},
    "stages/contact/asperities": {"readings"},
    "stages/laws/sample_sizes": {"sample_sizes"},
    "stages/laws/orders": {"orders"},
    "stages/beams/mesh": {"mesh"},
    "stages/surfaces/correlation": {"correlation"},
    "stages/beams/resampling": {"resampling"},
    "stages/contact/changes/variants": {"variant_summits", "readings"},
    "stages/beams/variant_beams": {"variant"},
    "stages/devices/cracks": {"cracks", "safe_lengths"},
    "stages/devices/safe_lengths": {"safe_lengths"},
    "stages/devices/chart": {"chart"},
}


@cache
def codes():
    """Names of the modules in the fingerprint of the code of every rule, which is a parameter of all its jobs."""
    script = fingerprint(ROOT / "workflow" / "scripts" / "stage.py")
    modules = {rule: PACKAGE.joinpath(*stage.code.split(".")[1:]) for rule, (stage, _) in stages().items()}
    return {rule: {*fingerprint(modules[rule].with_suffix(".py")), *script} for rule in RULES}


def readers_of(path):
    """Rules with a module in the fingerprint of their code, and all their readers."""
    met = {rule for rule, names in codes().items() if f"stiction.{path.replace('/', '.')}" in names}
    # Chunks are temporary and must be recomputed to be joined.
    return behind(met | ({"contact_chunk"} if "contact" in met else set()))


#: One module of each kind: physics, stage, command line, configuration, log, drawing; the other rows are slow tests.
CHANGED = ["contact/meniscus", "stages/laws/forces", "config/plan"]
CHANGED += [
    pytest.param(path, marks=pytest.mark.slow)
    for path in ("beam/release", "stages/contact/contact", "run/logs", "report/beams/tables", "study", "models")
]


@pytest.mark.parametrize("path", CHANGED)
def test_a_changed_module_reruns_the_rules_with_it_in_their_fingerprint_and_their_readers(tree, path):
    tree.append(f"src/stiction/{path}.py", "\nCHANGED = 1\n")
    assert known(tree.rerun()) == readers_of(path)


@pytest.mark.slow
def test_a_changed_script_reruns_every_rule(tree):
    tree.append("workflow/scripts/stage.py", "\nCHANGED = 1\n")
    assert known(tree.rerun()) == RULES


@pytest.mark.parametrize(("module", "rules"), LAYOUTS.items(), ids=LAYOUTS)
def test_a_new_variable_in_a_dataset_reruns_its_stage_and_its_readers_and_no_others(module, rules):
    """It changes the module of the stage, see above."""
    code = (PACKAGE / f"{module}.py").read_text()
    assert code.count("return xr.Dataset(") + code.count("return parameters.variables(") == 1
    assert readers_of(module) == behind(rules)


@pytest.mark.parametrize(("path", "must", "must_not"), SPOTS, ids=[path for path, *_ in SPOTS])
def test_a_changed_module_reruns_the_rules_that_use_it(path, must, must_not):
    rerun = readers_of(path)
    assert set(must.split()) <= rerun
    assert not set(must_not.split()) & rerun


def test_a_figure_style_redraws_all_figures_and_nothing_else(tree):
    tree.append("src/stiction/report/stiction.mplstyle", "\nlines.linewidth: 2\n")
    drawn = {f"results/figures/{path.name}" for path in (tree.folder / "results" / "figures").iterdir()}
    assert set(tree.rerun()) == drawn | pages(tree)
    assert len(drawn) > 20


def pages(tree):
    """Pages of devices and their answers."""
    folder = tree.folder / "results" / "devices"
    found = {f"results/devices/{path.name}" for end in ("html", "txt") for path in folder.glob(f"*.{end}")}
    assert len(found) >= 2
    return found


@pytest.mark.parametrize("template", ["templates/style.css", "templates/table.html", "devices/terms.yaml"])
def test_a_template_writes_its_tables_and_pages_again_and_nothing_else(tree, template):
    tree.append(f"src/stiction/report/{template}", "\n")
    tables = {f"results/tables/{path.name}" for path in (tree.folder / "results" / "tables").iterdir()}
    has_tables, has_pages = "templates/" in template, template != "templates/table.html"
    assert set(tree.rerun()) == (tables if has_tables else set()) | (pages(tree) if has_pages else set())
    assert len(tables) > 20


@pytest.mark.slow
def test_a_change_of_the_drawing_code_reruns_no_computation(tree):
    drawing = sorted((tree.folder / "src" / "stiction" / "report").rglob("figures.py"))
    assert len(drawing) > 5
    for path in drawing:
        tree.append(path, "\nCHANGED = 1\n")
    assert known(tree.rerun()) == set()


IMPORT = re.compile(r"^\s*(?:from (stiction[\w.]*) import (.+)|import (stiction[\w.]*))", re.MULTILINE)


def imported(path):
    """Paths of the modules that a file imports, found without a parser."""
    found = set()
    for folder, names, module in IMPORT.findall(path.read_text()):
        words = [name.split(" as ")[0].strip(" ()") for name in names.split(",") if name.strip(" (")]
        for dotted in [module] if module else [folder, *(f"{folder}.{word}" for word in words)]:
            file = ROOT / "src" / f"{dotted.replace('.', '/')}.py"
            found |= {file} if file.is_file() else set()
    return found


#: Modules that affect no result, or only settings and names of inputs, which count themselves.
SILENT = {
    PACKAGE / f"{name}.py"
    for name in (
        *("progress", "run/logs", "config/messages", "plan/stage", "plan/names"),
        *("stages/contact/changes/patches", "stages/contact/changes/table", "stages/devices/contact_names"),
    )
}


def reached(file):
    """Modules that a file imports, directly or through other modules, but not through those that affect no result."""
    modules = imported(file)
    while more := reduce(set.union, map(imported, modules - SILENT), set()) - modules:
        modules |= more
    return modules - SILENT


CODE = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py") if path.name != "__init__.py")


def test_every_module_reruns_the_rules_that_reach_it_and_their_readers():
    modules = {name: ROOT / "src" / f"{stage.code.replace('.', '/')}.py" for name, (stage, _) in stages().items()}
    code = {name: reached(modules[name]) | {modules[name]} for name in RULES}
    of_all = reached(ROOT / "workflow" / "scripts" / "stage.py")
    assert len(CODE) > 200
    for path in CODE:
        met = {name for name in RULES if PACKAGE / path in code[name] | of_all}
        met |= {"contact_chunk"} if "contact" in met else set()
        assert readers_of(str(path.with_suffix(""))) == behind(met), path
