"""What the docs say can be written passes ``stiction check``: blocks of YAML, snippets, keys, choices."""

import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from functools import reduce
from pathlib import Path
from unittest.mock import patch

import pytest
import yaml
from configurations import module

from stiction import accuracy
from stiction.command.main import main
from stiction.config.merging import merged
from stiction.config.reading import paper
from stiction.config.relations import schema
from stiction.config.test_beams import TEMPLATE
from stiction.run import disk_cache

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "examples").rglob("*.md"))]
TEXT = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
BLOCKS = re.findall(r"^```yaml\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
#: Keys that have to agree with files: tests/scans/test_scan_reading.py and test_lines_in_texts.py read them.
OF_FILES = {("surfaces", "*", "scans", "channel"), ("surfaces", "*", "scans", "height_unit")}
OF_FILES |= {("surfaces", "*", "profiles", key) for key in ("x_unit", "height_unit", "level")}
#: A study of the paper's pair b alone, and another whose beam is of a material of its own, with a liquid of its own.
PAIR_B = {"run": {"pairs": ["b"]}}
OXIDE = {
    "materials": {"Oxide": {"hamaker_constant_zJ": {"water": 5, "dry": 65}}},
    "surfaces": {"B2": {"material": "Oxide"}},
    "liquids": {"Hexane": {"surface_tension_mN_per_m": 18}},
}
#: Heights of a surface that another one can follow closely.
GAUSSIAN = {"skewness": 0, "kurtosis": 3}
#: Devices with a voltage, and a stopper on a spring.
DIELECTRIC = {"voltage_V": 1, "dielectric": {"thickness_nm": 100, "permittivity": 3.9}}
BEAM = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30, "humidities": [0.67]}
SPRING = {"stiffness_N_per_m": 2, "gap_um": 1.5, "electrode": {"area_um2": 1e4, "gap_um": 3}}
STOPPER = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "humidities": [0.67]}
ROW = {"length_um": 150, "dimples": {"number": 2, "at_um": [60, 120], "height_um": 1, "contact_um": [2, 2]}}
LIFE = {"devices": {"C": BEAM | DIELECTRIC, "D": BEAM | ROW, "S": STOPPER | SPRING}}
#: Processes of both surfaces of pair b, and a stopper over one of them.
ETCHED = [{"value": at, "rms_nm": 2 + at / 50, "uncertainty": {"rms_nm": 0.1}} for at in (30, 60, 90)]
POLISHED = [{"value": at, "rms_nm": at / 500, "uncertainty": {"rms_nm": 0.01}} for at in (60, 90)]
PROCESSES = {
    "surfaces": {"Poly": {"like": "B2", "rms_nm": 3}},
    "process": {
        "etch": {"variable": "etch_time_s", "surface": "B2", "settings": ETCHED},
        "polish": {"variable": "etch_time_s", "surface": "Sub1", "settings": POLISHED},
        "deposition": {"variable": "deposition_time_s", "surface": "Sub1", "settings": POLISHED},
    },
    "devices": {"P": STOPPER | {"restoring_force_uN": 20, "requirement": {"share": 0.01}, "process": "etch"}},
}
#: Snippets such as `level: plane`, `attraction.reach: all` and `run: {pairs: []}`; those with other values in words.
SNIPPETS = sorted(
    set(re.findall(r"`([a-z_]+(?:\.[a-z_]+)*: [^`<>…]+)`", re.sub(r"```.*?```", "", TEXT, flags=re.DOTALL)))
)
EXAMPLES = ("examples/scans/mine", "examples/devices", "examples/roughness", "examples/drawn_beams/mine")
EXAMPLES += ("examples/test_beams", "examples/sealed", "examples/life", "examples/process/mine", "workflow/smoke")
EXAMPLES += ("examples/range/mine", "examples/switch", "examples/scans/lines", "examples/mission", "examples/probe")
EXAMPLES += ("examples/pull_offs", "examples/coated")


KEYS = list(module(ROOT / "docs" / "keys.py").keys(schema()))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with files of scans and of test beams, smaller than those of the examples."""
    pytest.importorskip("SurfaceTopography")
    path = tmp_path_factory.mktemp("documented")
    draw = module(ROOT / "examples" / "scans" / "draw.py")
    draw.main(path, [replace(scans, side=5e-6, pixel=20e-9) for scans in draw.SCANS])
    module(ROOT / "examples" / "process" / "draw.py").main(path)
    module(ROOT / "examples" / "scans" / "lines.py").main(path, length=80e-6)
    for name in ("arrayA.csv", "wafer.csv"):
        (path / name).write_text(TEMPLATE, encoding="utf-8")
    shutil.copy2(ROOT / "examples" / "range" / "range.csv", path)
    return path


@pytest.fixture(scope="module")
def accepts(folder):
    """Whether ``stiction check`` accepts a study. What samples have shown is kept from check to check."""
    kept = disk_cache.DiskCache(folder / "kept.json")

    def accepts(study):
        file = folder / "mine.yaml"
        file.write_text(study if isinstance(study, str) else yaml.safe_dump(study), encoding="utf-8")
        return main(["check", str(file), "--directory", str(folder / "run")]) == 0

    # No answer depends on the numbers of beams and samples, which a pilot of few samples decides as well.
    with patch.object(disk_cache, "DiskCache", lambda *_: kept), patch.object(accuracy, "PILOT", 40):
        yield accepts


def bases() -> dict[str, dict]:
    """Studies that a key may be added to, by name."""
    found = {Path(name).parent.name + Path(name).name: (ROOT / f"{name}.yaml").read_text() for name in EXAMPLES}
    found |= {f"block{number}": block for number, block in enumerate(BLOCKS)}
    own = {"paper": PAIR_B, "oxide": PAIR_B | OXIDE, "life": PAIR_B | LIFE, "processes": PAIR_B | PROCESSES}
    over = {"requirement": {"length_um": 200, "share": 0.01}, "roughness": {"surface": "B2", "rms_nm": [2, 8]}}
    replica = {"pairs": {"b": {"replica": {"coherence": 0.5}}}, "devices": {"C": BEAM, "D": BEAM | over}}
    own["replica"] = merged(PAIR_B | {"surfaces": {"B2": GAUSSIAN, "Sub1": GAUSSIAN}}, replica)
    films = {"humidities": [0.3, 0.75, 0.9], "thickness_nm": [0.8, 1.2, 1.8]}
    own["isotherm"] = merged(PAIR_B, {"water": {"isotherm": films}})
    return own | {name: yaml.safe_load(text) for name, text in found.items()}


BASES = bases()


def places(path: tuple[str, ...], config) -> Iterator[tuple[str, ...]]:
    """Paths of a key in a study, with names that are there in place of ``*``."""
    found = [()]
    for part in path:
        found = [(*place, name) for place in found for name in (_names(config, place) if part == "*" else [part])]
    return found


def _names(config, place):
    section = reduce(lambda section, name: section.get(name, {}), place, config)
    return list(section) if isinstance(section, dict) else []


def is_accepted(accepts, path, value) -> bool:
    """Whether a key may have a value in some study."""
    if path == ("compare", "*"):
        path = ("compare", "surfaces.B2.rms_nm")
    for base in BASES.values():
        for place in places(path, merged(paper(), base)):
            change = reduce(lambda inner, key: {key: inner}, reversed(place), value)
            if accepts(merged(base, change)):
                return True
    return False


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_a_block_can_run(accepts, block):
    assert accepts(block)
    assert not accepts(block + "\nsead: 1\n")


@pytest.mark.parametrize("snippet", SNIPPETS)
def test_a_snippet_is_accepted_in_some_study(accepts, snippet):
    ((dotted, value),) = yaml.safe_load(snippet).items()
    *parents, last = dotted.split(".")
    ends = [key.path for key in KEYS if key.path[-len(parents) - 1 :] == (*parents, last)]
    assert any(
        is_accepted(accepts, path, value) for path in [(*parents, last)] * (last in schema()["properties"]) + ends
    )


def choices(key) -> list:
    """Values to try: the example of the docs, and every choice."""
    of_items = key.entry.get("items", {}).get("enum", ())
    return [key.example, *key.entry.get("enum", ()), *([choice] for choice in of_items)]


CHECKED = [key for key in KEYS if key.path not in OF_FILES]


@pytest.mark.parametrize("key", CHECKED, ids=lambda key: ".".join(key.path))
def test_every_key_takes_its_example_and_every_choice_in_some_study(accepts, key):
    refused = [value for value in choices(key) if not is_accepted(accepts, key.path, value)]
    assert refused == []


def test_a_choice_that_does_not_exist_is_accepted_in_no_study(accepts):
    assert not is_accepted(accepts, ("surfaces", "*", "beyond"), "stretched")
