"""The docs agree with the results they quote; links are valid; the pages build without warnings."""

import importlib
import importlib.util
import json
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from configurations import module
from matplotlib import rc_params_from_file
from PIL import Image

import stiction
from stiction.answer.data import Cause
from stiction.config.relations import schema
from stiction.plan.graph import Graph, stages
from stiction.plan.plan import Plan
from stiction.report.checks import RESOLVED
from stiction.report.style import DOUBLE, SINGLE, STYLE, panels, save
from stiction.run import storage
from stiction.run.atomic import DataError
from stiction.stages.devices import prediction
from stiction.surface.feasible import nearest_feasible

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.glob("*.md"))]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
#: Least height of text of a picture on a phone [pixels].
READABLE = 10
#: Pictures that full colours make too large at full width: they have a palette.
LARGE = {"figure_08.png", "surface_sheet_Etched.png", "validation.png"}
#: Brackets and # in code are not links or headings.
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)

each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)


update, quoted = (module(DOCS / f"{name}.py") for name in ("update", "quoted"))


# Numbers and tables


@pytest.fixture(scope="module")
def written():
    """Path to text of every file that ``make numbers`` writes."""
    return update.drawings() | update.tables() | update.pages()


WRITTEN = [
    *(DOCS / "pictures" / f"{name}.svg" for name in ("beam", "method", "stopper_and_bridge")),
    DOCS / "tables" / "keys_of_the_simulation.md",
    DOCS / "tables" / "materials.md",
    DOCS / "tables" / "beside_the_paper.md",
    *(ROOT / "workflow" / "rules" / f"{name}.smk" for name in ("chain", *update.rules.ROOMS)),
    DOCS / "tables" / "rules.md",
    DOCS / "pictures" / "chain.svg",
    DOCS / "results.json",
    prediction.PAPER_LENGTHS,
    *(update.page_of(path) for path in sorted((DOCS / "templates").glob("*.md"))),
]


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: path.name)
def test_numbers_and_tables_are_those_of_the_results_that_the_docs_name(written, path):
    assert path.read_text(encoding="utf-8") == written[path], f"{path.name} is out of date: run make numbers"


def test_every_file_that_is_written_is_compared(written):
    assert list(written) == WRITTEN


def test_compared_crack_lengths_are_those_of_table_3():
    table = quoted.frame(DOCS / "tables" / "table_3.csv")
    shown = (DOCS / "tables" / "crack_lengths.md").read_text(encoding="utf-8")
    assert shown == quoted.compared_lengths(table) + "\n"
    assert shown != quoted.compared_lengths(table.assign(crack_length_um=table.crack_length_um + 1)) + "\n"
    row = table.set_index(["pair", "relative_humidity", "model"]).loc["b", 0.67, "NG"]
    line = next(line for line in shown.splitlines() if line[:6] == "| 0.67")
    assert line.split(" | ")[4] == f"{row.crack_length_um:.0f} ± {row.crack_length_std_um:.0f}"


@pytest.mark.slow
def test_folders_without_a_finished_run_of_the_paper_change_nothing(tmp_path):
    results = tmp_path / "results"
    results.mkdir()
    assert "no finished run" in update.unfinished(results)
    (results / "verdict.txt").touch()
    assert "not up to date with config.yaml and the code" in update.unfinished(results)


def test_folders_without_a_finished_run_of_the_example_change_nothing(tmp_path):
    assert "no finished run" in update.unfinished_example(tmp_path)


def drawn(_folder, into, names, *configs):
    """Pictures in place of those of a run whose configuration files exist."""
    assert all(path.exists() for path in configs)
    for name in names:
        Image.new("RGB", (20, 10)).save(into / f"{name}.png")


@pytest.fixture
def made(tmp_path, monkeypatch):
    """Names of the files that are copied into folders of tables and pictures, empty at first."""
    monkeypatch.setattr(update, "DOCS", tmp_path / "docs")
    monkeypatch.setattr(update.narrow, "draw", drawn)
    (tmp_path / "mine.yaml").touch()
    for part in ("tables", "pictures"):
        (tmp_path / "docs" / part).mkdir(parents=True)
    return lambda: {path.name for path in (tmp_path / "docs").rglob("*.*")}


def test_tables_and_pictures_of_the_example_are_copied(tmp_path, made):
    for place in (*update.EXAMPLE_TABLES.values(), update.EXAMPLE_DRAWN):
        (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
        for kind in ("csv", "md"):
            (tmp_path / f"{place}.{kind}").write_text(f"{place} {kind}")
    Image.new("RGB", (20, 10)).save(tmp_path / f"{update.EXAMPLE_DRAWN}.png")
    update.collect_example(tmp_path)
    pictures = {"surface_sheet_Etched.png", "prediction.png"}
    assert made() == {path.name for path in (DOCS / "tables").glob("example_*")} | pictures
    assert (tmp_path / "docs" / "tables" / "example_scans.md").read_text() == "results/tables/scans md"


def test_table_and_picture_of_the_drawn_test_beams_are_copied(tmp_path, made):
    assert "no finished run" in update.unfinished_example(tmp_path, target="devices")
    for kind in ("csv", "md"):
        (tmp_path / f"prediction.{kind}").write_text(kind)
    Image.new("RGB", (20, 10)).save(tmp_path / "prediction.png")
    update.collect_beams(tmp_path)
    assert made() == {"drawn_beams.csv", "drawn_beams.md", "drawn_beams.png"}


def test_tables_and_picture_of_the_supplement_are_copied(tmp_path, made):
    runs = tmp_path / "runs"
    assert "supplement/sizes" in update.unfinished_supplement(runs)
    for place in update.SUPPLEMENT.values():
        (runs / place).parent.mkdir(parents=True, exist_ok=True)
        for kind in ("csv", "md"):
            (runs / f"{place}.{kind}").write_text(place)
    Image.new("RGB", (20, 10)).save(runs / "supplement" / "supplement.png")
    assert not update.unfinished_supplement(runs)
    update.collect_supplement(runs)
    tables = {f"{name}.{kind}" for name in update.SUPPLEMENT for kind in ("csv", "md")}
    assert made() == tables | {"supplement.png"}
    assert made() <= {path.name for folder in ("tables", "pictures") for path in (DOCS / folder).iterdir()}


def test_tables_and_picture_of_the_benchmark_are_copied(tmp_path, made):
    assert "no finished run" in update.unfinished_validation(tmp_path)
    for file in update.VALIDATION.values():
        (tmp_path / file).write_text(file)
    Image.new("RGB", (20, 10)).save(tmp_path / "validation.png")
    assert not update.unfinished_validation(tmp_path)
    update.collect_validation(tmp_path)
    assert made() == {*update.VALIDATION, "validation.png"}
    assert made() <= {path.name for folder in ("tables", "pictures") for path in (DOCS / folder).iterdir()}


def test_sentences_of_the_pages_with_test_beams_and_one_picture_are_copied(tmp_path, monkeypatch):
    folder, picture = tmp_path / "run", f"{update.TEST_BEAMS_PICTURE}.png"
    monkeypatch.setattr(update.narrow, "draw", drawn)
    assert "no finished run" in update.unfinished_devices("test_beams", update.TEST_BEAMS, folder)
    monkeypatch.setattr(update, "DOCS", tmp_path / "docs")
    said = {name: lambda found, _, name=name: f"{name}: {float(found.linear)}" for name in update.TEST_BEAMS_SAID}
    monkeypatch.setattr(update, "answer_of", lambda found: found)
    monkeypatch.setattr(update, "TEST_BEAMS_SAID", said)
    for part in ("docs/tables", "docs/pictures", "run/results/figures", "run/results/devices/test_beams/rerun"):
        (tmp_path / part).mkdir(parents=True)
    (folder / "results" / "devices" / "answer").mkdir()
    for device, factor in (("onB", 1.1), ("onA", 1.0)):
        path = folder / "results" / "devices" / "test_beams" / "rerun" / f"{device}.nc"
        storage.save(xr.Dataset({"linear": factor}), path, "test_beams_rerun", {})
        of_answer = folder / "results" / "devices" / "answer" / path.name
        storage.save(xr.Dataset({"share": 1e-3}), of_answer, "answer", {})
    update.collect_test_beams(folder)
    assert {path.name for path in (tmp_path / "docs").rglob("*.*")} == {"test_beams.csv", picture}
    found, kept = (quoted.frame(docs / "tables" / "test_beams.csv") for docs in (tmp_path / "docs", DOCS))
    assert [*found.text] == [f"{name}: {factor}" for factor in (1.0, 1.1) for name in said]
    assert [*found.device] == ["onA"] * len(said) + ["onB"] * len(said)
    assert set(kept.name) == set(said)
    assert set(kept.device) == set(yaml.safe_load((ROOT / "examples" / "test_beams.yaml").read_text())["devices"])


def test_shares_of_the_map_of_roughness_are_those_at_the_given_rms_by_the_skewness():
    rows = [("Skewed", 3.4, 0.0, 0.2), ("Skewed", 8.0, -1.0, 1), ("Bump", 3.4, np.nan, 80), ("Skewed", 3.4, -1.0, 100)]
    frame = pd.DataFrame(rows, columns=["device", "value", "other_value", "stuck_percent"])
    assert quoted.skewed(frame) == {"skewed_1": "100", "skewed_2": "0.2"}


def test_numbers_of_checks_scans_and_timings_are_those_of_their_tables():
    checks = pd.DataFrame(
        {
            "name": [RESOLVED, RESOLVED, "another"],
            "message": ["crack is 9 µm, -1.38 % off that on", "is 7 µm, +0.41 % off that on a finer mesh", "-9 % off"],
        }
    )
    assert quoted.mesh(checks)["mesh_off"] == "1.4"
    row = {"surface": "Etched", "points_fast": 100, "points_slow": 600, "skewness_se": 0.05}
    assert quoted.scans(pd.DataFrame([row])) == {"scan_errors": "5"}
    times = pd.DataFrame({"name": ["paper", "start"], "seconds": [250, 0.02]})
    assert quoted.timings(times) == {"time_paper": "4:10 min", "time_start": "0.02 s"}


def test_numbers_of_statements_are_those_of_their_tables():
    tables = {name: pd.read_csv(DOCS / "tables" / f"{name}.csv") for name in ("table_1", "table_3", "variants")}
    tables |= {name: pd.read_csv(DOCS / "tables" / f"{name}.csv") for name in ("sensitivity", "supplement_shares")}
    whole = quoted.statements_of_studies(tables)
    of_b = tables["table_3"].query("model == 'NG' and pair == 'b'")
    expected = 100 * np.abs(of_b.crack_length_um - of_b.experiment_um) / of_b.experiment_um
    assert float(whole["off_b"]) == pytest.approx(expected.mean(), rel=0.02)
    assert float(whole["off_b_088"]) == pytest.approx(expected.max(), rel=0.05)
    moved = tables | {"table_3": tables["table_3"].assign(crack_length_um=tables["table_3"].experiment_um)}
    assert float(quoted.statements_of_studies(moved)["off_b"]) == 0
    slopes = [float(whole[f"slope_rms_{air}"]) for air in ("wet", "dry")]
    assert slopes == pytest.approx([-1.01, -5.95], rel=0.02)


def test_numbers_of_force_laws_are_those_of_the_table_of_their_script(tmp_path):
    heads = ["pair", "air", "reach", "ē [mJ/m²]", "touching summits alone [mJ/m²]"]
    heads += ["energy left of d_max, Eq. (12) over curves", "ln l_s, curves over Eq. (12) [%]"]
    heads += ["right branch of the curve over Eq. (12) [%]", "curves over parabola [%]"]
    rows = [
        ["b", "dry", "all", "0.18 ± 0.01", "0.04 ± 0.01", "1.55", "+1.3 ± 0.4", "-0.6 ± 0.3", "-0.7 ± 0.5"],
        ["c", "RH 0.6", "touching", "0.02 ± 0.01", "0.02 ± 0.01", "1.35", "+5.0 ± 0.8", "+0.2 ± 0.3", "+0.6 ± 0.4"],
    ]
    lines = [heads, ["---"] * len(heads), *rows]
    (tmp_path / "t.md").write_text("".join(f"| {' | '.join(line)} |\n" for line in lines), encoding="utf-8")
    assert quoted.tails(quoted.of_markdown(tmp_path / "t.md")) == {
        "tail_b_dry_all": "+1.3 ± 0.4",
        "parabola_b_dry_all": "-0.7 ± 0.5",
        "tail_energy_b": "4",
        "tail_c_060_touching": "+5.0 ± 0.8",
        "parabola_c_060_touching": "+0.6 ± 0.4",
        "tail_left_least": "1.4",
        "tail_left_most": "1.6",
        "tail_right": "0.6",
    }


def test_steps_of_answers_are_those_of_their_table_and_one_that_is_not_stated_stands_beside():
    row = {f"after_{cause}": np.nan for cause in Cause} | {
        "device": "C1",
        "unit": "µm",
        "to_build": 170.0,
        "measure": "it",
        "stricter": "150 µm if fast; 160 µm if wet",
    }
    row |= {"after_estimate": 200.0, "after_simulation": 190.0, "after_fast": 150.0, "after_inputs": 171.0}
    found = quoted.answers(pd.DataFrame([row]))
    assert (found["build_C1"], found["stricter_C1"]) == ("170", "150 µm if fast and 160 µm if wet")
    assert [found[f"change_C1_{cause}"] for cause in ("simulation", "fast", "inputs")] == ["−5.0", "−21.1", "−10.0"]


def test_the_readme_states_how_far_experiments_differ():
    numbers = json.loads((DOCS / "results.json").read_text(encoding="utf-8"))["numbers"]
    said = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    of = (int(numbers[f"valid_levels{end}"]) for end in ("_inside", ""))
    for text in (
        f"off by {numbers['valid_off']} % in",
        f"factor of {numbers['valid_factor']}:",
        "{} of {} lie".format(*of),
    ):
        assert text in said
        assert re.sub(r"\d+", lambda found: f"{int(found[0]) + 1}", text) not in said, "another number is found"


def test_the_steps_of_the_page_lead_from_the_estimate_to_the_length_to_build():
    text = (DOCS / "devices.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| [a-z ]+ \| \*{0,2}(\d+)\*{0,2} \| (−[\d.]+)? ?\|$", text, re.M)
    sizes = [float(size) for size, _ in rows]
    changes = [float(change.replace("−", "-")) for _, change in rows[1:]]
    assert len(rows) == 4
    for before, after, change in zip(sizes, sizes[1:], changes, strict=False):
        assert abs(before * (1 + change / 100) - after) <= 1 + 5e-4 * before


def test_nearest_feasible_moments_are_those_that_the_heights_get():
    found = quoted.nearly_gaussian()
    for k, measured in enumerate(quoted.NEARLY_GAUSSIAN, 1):
        used = nearest_feasible(*measured)
        assert [float(text.replace("−", "-")) for text in found[f"near_{k}"].split(", ")] == pytest.approx(
            used[:2], abs=5e-4
        )


# Keys


def test_the_pages_of_keys_give_meaning_allowed_values_and_an_allowed_example_for_every_key():
    places = (DOCS / "keys.md", DOCS / "tables" / "keys_of_the_simulation.md")
    page = "\n".join(path.read_text(encoding="utf-8") for path in places)
    listed = list(update.keys.keys(schema()))
    assert len(re.findall(r"^\| `[\w.]+` \| ", page, re.MULTILINE)) == len(listed) > 100
    for key in listed:
        assert key.meaning in page
        assert jsonschema.Draft202012Validator(key.entry).is_valid(key.example), key.path


# Pictures and links


def test_pictures_keep_their_colours(tmp_path):
    # More colours than a palette holds, in equal squares: the middle of each keeps its colour at half the width.
    colours = np.random.default_rng(1).integers(0, 256, (30, 30, 3), dtype=np.uint8)
    Image.fromarray(colours.repeat(20, 0).repeat(20, 1)).save(tmp_path / "large.png")
    update.shrink(tmp_path / "large.png", tmp_path / "small.png", 300)
    with Image.open(tmp_path / "small.png") as small:
        assert small.size == (300, 300)
        np.testing.assert_array_equal(np.asarray(small.convert("RGB"))[5::10, 5::10], colours)


def test_a_picture_that_is_too_large_has_fewer_colours_before_it_has_fewer_pixels(tmp_path, monkeypatch):
    smooth = np.add.outer(np.arange(300), np.arange(300))[..., None] * [0.3, 0.2, 0.4]
    noisy = np.random.default_rng(1).normal(smooth, 4).clip(0, 255).astype(np.uint8)
    Image.fromarray(noisy).save(tmp_path / "large.png")
    for largest, expected in ((350_000, ("RGB", 300)), (100_000, ("P", 300)), (60_000, ("P", 255))):
        monkeypatch.setattr(update, "LARGEST", largest)
        update.shrink(tmp_path / "large.png", tmp_path / "small.png", 300)
        with Image.open(tmp_path / "small.png") as small:
            assert (small.mode, small.width) == expected
            if small.width == 300:
                errors = np.abs(np.asarray(small.convert("RGB")).astype(int) - noisy)
                assert np.mean(errors) < 3, "colours of a palette are near"


def test_pictures_are_small_in_full_colours_unless_large_and_all_shown():
    shown = {Path(link).name for page in PAGES for link in links(page) if link.endswith((".png", ".svg"))}
    pictures = list((DOCS / "pictures").iterdir())
    assert {path.name for path in pictures} == shown
    assert max(path.stat().st_size for path in pictures) <= update.LARGEST
    for path in (path for path in pictures if path.suffix == ".png"):
        with Image.open(path) as picture:
            assert picture.mode == ("P" if path.name in LARGE else "RGB"), f"{path.name} has a palette or needs one"
            assert picture.width == update.WIDTH


def test_figures_are_drawn_from_tables_and_datasets_of_a_run_as_wide_as_a_column(tmp_path):
    plan, heights = Plan(stiction.load()), np.linspace(-3, 3, 7)
    (tmp_path / "results" / "tables").mkdir(parents=True)
    shutil.copyfile(DOCS / "tables" / "table_3.csv", tmp_path / "results" / "tables" / "table_3.csv")
    for name in plan.surfaces:
        density = ("height", np.exp(-(heights**2) / 2) / np.sqrt(2 * np.pi))
        found = xr.Dataset({"density": density, "rms": 3e-9}, {"height": heights})
        (tmp_path / "results" / "heights").mkdir(exist_ok=True)
        storage.save(found, tmp_path / "results" / "heights" / f"{name}.nc", "heights", {})
    for name, panels_drawn in (("intervals", 3), ("figure_07", 2 * len(plan.surfaces))):
        job = Graph(plan).job(f"figures/{name}.png")
        figure = update.narrow.figure_of(tmp_path, job)
        assert len(figure.axes) == panels_drawn
        assert figure.get_figwidth() == SINGLE
    update.narrow.draw(tmp_path, tmp_path, ["intervals"], ROOT / "config.yaml")
    assert pixels_of_text(tmp_path / "intervals.png") >= READABLE
    with pytest.raises(DataError, match=r"heights/\w+.nc"):
        update.narrow.figure_of(tmp_path / "results", job)


def pixels_of_text(path):
    """Height of the smallest text of a figure where it is shown as wide as a phone [pixels]."""
    smallest = min(settings_of_style()[name] for name in ("xtick.labelsize", "ytick.labelsize", "legend.fontsize"))
    with Image.open(path) as picture:
        return smallest / 72 * 390 * picture.info["dpi"][0] / picture.width


def settings_of_style():
    """Settings of the style of all figures."""
    return rc_params_from_file(STYLE, use_default_template=False)


def test_text_of_all_pictures_can_be_read_on_a_phone(tmp_path):
    small = {path.name: round(pixels_of_text(path), 1) for path in (DOCS / "pictures").glob("*.png")}
    assert min(small.values()) >= READABLE, {name: size for name, size in small.items() if size < READABLE}
    for width, is_readable in ((SINGLE, True), (DOUBLE, False)):
        figure, _ = panels(1, 1, (width, 2))
        save(figure, tmp_path / "drawn.png")
        update.shrink(tmp_path / "drawn.png", tmp_path / "small.png", 300)
        assert (pixels_of_text(tmp_path / "small.png") >= READABLE) == is_readable


def test_no_text_of_a_figure_is_smaller_than_the_smallest_of_the_style():
    smaller = re.compile(r"(?:fontsize|labelsize)\"?[=:] ?[1-6]\b")
    places = [*(ROOT / "src" / "stiction" / "report").rglob("*.py"), *(ROOT / "examples").rglob("*.py")]
    assert smaller.search('panel.text(0, 0, "", fontsize=6)'), "a control"
    assert smaller.search('{"fontsize": 6}')
    assert not [path.name for path in places if smaller.search(path.read_text(encoding="utf-8"))]


def links(page):
    """Targets of all links and pictures of a page."""
    return LINK.findall(CODE.sub("", page.read_text(encoding="utf-8")))


def anchors(page):
    """Anchors of the headings of a page, as GitHub and MyST name them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def faults(page):
    """Invalid links of a page."""
    for link in links(page):
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        if ":" in name or not target.is_file() or (anchor and anchor not in anchors(target)):
            yield link


@each_page
def test_links_lead_somewhere(page):
    assert not list(faults(page))


def test_a_link_that_leads_nowhere_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A title (here)\n[a](page.md#a-title-here) [b](#nowhere) [c](missing.md) `[d](code.md)`\n")
    assert list(faults(page)) == ["#nowhere", "missing.md"]


def reached(page, seen):
    """Pages that links lead to from a page, over other pages."""
    for link in links(page):
        target = (page.parent / link.partition("#")[0]).resolve()
        if target in PAGES and target not in seen:
            seen.add(target)
            reached(target, seen)
    return seen


def test_every_page_is_reached_from_the_readme():
    assert set(DOCS.glob("*.md")) <= reached(ROOT / "README.md", set())


# Pages about the code


def test_the_map_of_the_code_names_every_folder_and_its_tests():
    table = re.findall(r"^\| `(\w+)` .* \| (.*) \|$", (DOCS / "code.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert {name for name, _ in table} == {
        path.parent.name for path in (ROOT / "src" / "stiction").glob("*/__init__.py")
    }
    for _, tests in table:
        assert all((ROOT / folder).is_dir() for folder in re.findall("`(.+?)`", tests))


def test_the_table_of_modules_names_every_module_of_the_physics():
    table = (DOCS / "tables" / "modules.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\| `(\w+\.\w+)`", table, re.MULTILINE))
    folders = {name.partition(".")[0] for name in named}
    files = (ROOT / "src" / "stiction").glob("*/[!_]*.py")
    assert {f"{path.parent.name}.{path.stem}" for path in files if path.parent.name in folders} == named


def blocks(language):
    """Blocks of code of all pages in one language."""
    pages = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    return re.findall(rf"^```{language}\n(.*?)^```", pages, re.MULTILINE | re.DOTALL)


def test_python_examples_use_names_that_exist():
    for block in blocks("python"):
        compile(block, "example", "exec")
        assert all(hasattr(stiction, name) for name in re.findall(r"\bstiction\.(\w+)\(", block)), block
        for place, names in re.findall(r"^from (stiction[.\w]*) import (.*)$", block, re.MULTILINE):
            assert all(hasattr(importlib.import_module(place), name) for name in names.split(", ")), block


def test_every_public_name_is_described():
    table = (DOCS / "tables" / "public_names.md").read_text(encoding="utf-8")
    assert set(stiction.__all__) <= set(re.findall(r"`(\w+)`", table))


def test_yaml_examples_are_configurations_that_can_run(tmp_path):
    draw = pytest.importorskip("SurfaceTopography") and module(ROOT / "examples" / "scans" / "draw.py")
    draw.main(tmp_path, [replace(scans, side=5e-6, pixel=20e-9) for scans in draw.SCANS])
    for block in blocks("yaml"):
        path = tmp_path / "mine.yaml"
        path.write_text(block, encoding="utf-8")
        assert stiction.load(path)["run"]["pairs"] == ["mine"]


@pytest.mark.slow
def test_every_rule_on_the_page_of_results_can_be_computed_by_its_name(tmp_path):
    table = (DOCS / "results.md").read_text(encoding="utf-8").partition("| item | rule |")[2].partition("\n\n")[0]
    named = {name for row in table.splitlines()[2:] for name in re.findall(r"`(\w+)`", row.split("|")[2])}
    words = ["--snakefile", ROOT / "Snakefile", "--directory", tmp_path, "--list-target-rules"]
    listed = subprocess.run([sys.executable, "-m", "snakemake", *words], capture_output=True, text=True, check=True)
    targets = set(listed.stdout.split())
    assert {"table_1", "figure_19", "verdict"} <= named <= targets
    assert "identification" not in targets, "a rule with wildcards"


def test_rules_on_the_page_of_clusters_reserve_the_minutes_that_it_says():
    said = re.findall(r"((?:`\w+`(?:,| and)\s+)*`\w+`) (?:have )?(\d+)", (DOCS / "cluster.md").read_text())
    minutes = {name: int(each) for names, each in said for name in re.findall(r"`(\w+)`", names)}
    assert len(minutes) > 10
    assert minutes == {name: stages()[name][0].running.minutes for name in minutes}


def test_citation_changelog_and_package_name_the_same_version():
    newest = re.search(r"^## (\S+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)[1]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == newest == stiction.__version__
    assert citation["license"] == "BSD-3-Clause"
    assert "BSD 3-Clause" in (ROOT / "LICENSE").read_text(encoding="utf-8")


# The build


@pytest.mark.parametrize(
    "builder", [pytest.param("dummy", marks=pytest.mark.slow), pytest.param("html", marks=pytest.mark.nightly)]
)
@pytest.mark.skipif(
    not all(map(importlib.util.find_spec, ("sphinx", "myst_parser", "furo"))),
    reason="Sphinx, MyST and Furo are not installed: pip install '.[docs]'",
)
def test_docs_build_without_a_warning_and_without_a_network(tmp_path, builder):
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-E", "-d", tmp_path / "tree"]
    command += ["-D", "plot_gallery=0", "-b", builder]  # test_gallery.py runs the studies
    built = subprocess.run([*map(str, command), DOCS, tmp_path / "built"], capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    if builder == "html":
        page = (tmp_path / "built" / "python.html").read_text(encoding="utf-8")
        assert "<msub>" in page
        assert not re.findall(r'(?:src|href)="(?:https?:)?//(?!pradyunsg|github)[^"]*\.(?:js|css)', page)


def test_text_of_pages_has_signs_of_minus_and_code_keeps_its_hyphens(monkeypatch):
    core = pytest.importorskip("docutils.core")
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(DOCS / "_ext")
    document = core.publish_doctree("By -5.3 %, 1 - p, 2026-11-30, ``a[-1]``::\n\n    n = -1\n")
    importlib.import_module("minus").Minus(document).run()
    assert document.astext() == "By −5.3 %, 1 − p, 2026-11-30, a[-1]:\n\nn = -1"
