"""Bring the docs up to date with a run: ``python docs/update.py results``, the command ``make numbers``.

1. If the folder holds a finished run of the paper, its tables go to ``docs/tables``, and its pictures, drawn again as
   on a page, to ``docs/pictures``. Otherwise those from an earlier run are kept. The same holds for the runs of ``make
   example``, ``make example-process``, ``make measured-beams``, ``make devices``, ``make sealed``, ``make attraction``,
   ``make print``, ``make validation``, ``stiction devices examples/NAME.yaml --directory runs/NAME`` with the names
   roughness and test_beams in folders of ``runs`` beside it.
2. ``docs/results.json`` receives the numbers quoted by the pages, and a checksum of each table and picture. The package
   receives the lengths from which runs of devices learn how far the model errs.
3. The drawings are drawn, the tables of keys and of rules and the files of ``workflow/rules`` are written, and the
   pages of ``docs`` and ``config/README.md`` are generated from ``docs/templates``, with numbers and tables inserted.

Steps 2 and 3 depend on ``docs`` alone: ``tests/test_docs.py`` repeats them and compares.
"""

import hashlib
import json
import re
import shutil
import subprocess
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
from PIL import Image

from stiction.analysis.convergence import sampling_distance
from stiction.beam.foundation import foundation_length
from stiction.config.files import paper
from stiction.config.units import in_si
from stiction.contact import forcelaw
from stiction.plan.plan import Plan
from stiction.report.answer import words as answer_words
from stiction.report.axes import process as sentences_process
from stiction.report.format import TO_UM, with_error
from stiction.report.limits import words
from stiction.report.test_beams import tables as tables_test_beams
from stiction.run.storage import load
from stiction.stages.answer.answer import answer_of
from stiction.stages.beams.cantilevers import Cantilevers, StripLength, cantilever, sections
from stiction.stages.devices import prediction
from stiction.stages.laws.forces import vectors

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "tests")]
import keys  # noqa: E402
import narrow  # noqa: E402
import quoted  # noqa: E402
import reruns  # noqa: E402
import rules  # noqa: E402
from benchmarks import jobs  # noqa: E402
from draw import drawings  # noqa: E402

DOCS = Path(__file__).parent
ROOT = DOCS.parent
#: Parts of pages that are written from the schema, or from the declarations of the stages.
MADE = {"keys": keys.page, "sections": keys.sections, "chain": rules.chain_table}
#: Tables whose numbers are quoted; their Markdown files are also shown.
TABLES = ("table_1", "table_2", "table_3", "fit_quality", "sensitivity", "variants", "resampling")
#: Pictures of the paper that pages show.
PICTURES = (
    "overview",
    "intervals",
    *(f"figure_{number}" for number in ("05", "07", "08", "09", *range(10, 20))),
    "variants",
)
#: Width of the pictures [pixels].
WIDTH = 700
#: Tables, and pictures of the run and of the script, of ``make example``: place in its folder, without ending.
EXAMPLE_TABLES = {
    "example_scans": "results/tables/scans",
    "example_scan_uncertainty": "results/tables/scan_uncertainty",
    "example_prediction": "prediction",
}
EXAMPLE_PICTURES, EXAMPLE_DRAWN = ("surface_sheet_Etched",), "prediction"
#: Table and picture of ``make example-beams``.
DRAWN_BEAMS = "drawn_beams"
#: Numbers and table of ``make measured-beams``.
MEASURED_BEAMS = "measured_beams"
#: Tables and pictures of ``make devices``.
DEVICE_TABLES = ("devices", "safe_lengths", "stoppers", "budget", "life")
DEVICE_PICTURES = ("risk", "chart", "stoppers", "budget_C1", "life")
#: Table and pictures of ``make devices CONFIG=examples/roughness.yaml``.
ROUGHNESS = "roughness"
#: Table, sentences and pictures of ``make example-process``.
PROCESS, PROCESS_SAID = "process", "process_answers"
PROCESS_PICTURES = ("process_Bump", "process_law_etch")
ROUGHNESS_PICTURES = ("roughness_Bump", "roughness_Lever", "roughness_map_Skewed")
#: Sentences and picture of ``make devices CONFIG=examples/test_beams.yaml``.
TEST_BEAMS = "test_beams"
TEST_BEAMS_SAID = {
    "build": lambda update, answer: " ".join(
        [answer_words.headline(answer), *answer_words.by_test_beams(answer), tables_test_beams.notes(update)]
    ),
    "further": lambda update, answer: tables_test_beams.beams_to_add(update),
    "warned": lambda update, answer: " ".join(words.texts(tables_test_beams.warnings(update))),
}
TEST_BEAMS_PICTURE = "test_beams_onB"
#: Tables of studies with a command of their own: command, and whether there is a picture of the same name.
OWN_STUDIES = {
    "model_error": ("make model-error", True),
    "asperities": ("make asperities", True),
    "model_error_parts": ("make asperities", False),
    "pressing": ("make pressing", True),
}
#: Tables of ``make sealed``.
SEALED_TABLES = ("safe_lengths", "stoppers")
#: Table of ``make attraction``, and its target.
ATTRACTION, OF_ATTRACTION = "attraction", "results/tables/variants.csv"
#: Comparison of ``make print``, and its scalars of studies.
PRINT, PRINT_STUDIES = "print", "print_studies"
#: Table of ``make print`` on a finer grid, and its place in ``runs``.
PRINT_FINER, OF_PRINT_FINER = "print_finer", "print-finer/results/tables/variants"
#: Tables of ``make supplement`` by their place in ``runs``, and its picture.
SUPPLEMENT = {
    f"supplement_{name}": f"supplement/{name}" for name in ("greenwood_williamson", "sizes", "surfaces", "shares")
}
SUPPLEMENT_PICTURE = "supplement"
#: Tables of ``make validation`` by their files in its folder, and its picture.
VALIDATION = {"validation.csv": "validation.csv", "validation.md": "validation.md", "validation_misses.md": "misses.md"}
VALIDATION_PICTURE = "validation"
#: Statements of the paper one by one: a table with a template.
BESIDE = "beside_the_paper"
#: Table of ``make tails``, in Markdown alone.
TAILS = "tails"
#: Largest picture [bytes].
LARGEST = 350_000
NOTE = "<!-- Written by docs/update.py from docs/templates/{name}: edit that file, then run make numbers. -->"


def main(results):
    """Update everything, and print a message if the numbers of an earlier run are kept."""
    runs = results.resolve().parent / "runs"
    for folder, why, collected in (
        (results, unfinished, collect),
        *((results, partial(unfinished_study, name), partial(collect_study, name)) for name in OWN_STUDIES),
        (runs / "example", unfinished_example, collect_example),
        (runs / "example-beams", partial(unfinished_example, target="devices"), collect_beams),
        (runs / "measured-beams", unfinished_measured, collect_measured),
        (runs / "devices", partial(unfinished_devices, "devices", "budget"), collect_devices),
        (runs / "roughness", partial(unfinished_devices, "roughness", ROUGHNESS), collect_roughness),
        (
            runs / "example-process",
            partial(unfinished_example, target="devices", result="results/tables/process.md"),
            collect_process,
        ),
        (runs / "test_beams", partial(unfinished_devices, "test_beams", TEST_BEAMS), collect_test_beams),
        (runs / "sealed", partial(unfinished_devices, "sealed", "stoppers"), collect_sealed),
        (runs / "attraction", unfinished_attraction, collect_attraction),
        (runs / "print", unfinished_print, collect_print),
        (runs, unfinished_finer, collect_finer),
        (runs, unfinished_supplement, collect_supplement),
        (runs / "validation", unfinished_validation, collect_validation),
    ):
        if reason := why(folder):
            print(f"{reason}: the docs keep their present numbers")  # noqa: T201
        else:
            collected(folder)
    for written in (drawings, tables, reruns.written, pages):  # pages state checksums of drawings and tables
        for path, text in written().items():
            path.write_text(text, encoding="utf-8")


# 1. From a run to docs/tables and docs/pictures


def unfinished(results):
    """Why a folder does not hold a finished run of the paper by this code; empty if it does."""
    if not (results / "verdict.txt").exists():
        return f"{results} holds no finished run"
    if up_to_date(results.resolve().parent):
        return ""
    return f"{results} is not up to date with config.yaml and the code, see make paper ARGS=-n"


def unfinished_study(name, results):
    """Why a folder does not hold a finished study of `OWN_STUDIES` by this code; empty if it does."""
    command, _ = OWN_STUDIES[name]
    if not (results / "tables" / f"{name}.csv").exists():
        return f"{results} holds no results of {command}"
    more = ("--configfile", *configs_of_study(name)) if name == "model_error" else ()
    if up_to_date(results.resolve().parent, command.removeprefix("make ").replace("-", "_"), *more):
        return ""
    return f"{results} is not up to date with config.yaml and the code, see {command} ARGS=-n"


def configs_of_study(name):
    """Configuration files of a study of `OWN_STUDIES`."""
    return ROOT / "config.yaml", *[ROOT / "workflow" / "model_error.yaml"] * (name == "model_error")


def unfinished_example(folder, target="measured", result="prediction.md"):
    """Why a folder does not hold a finished run of an example with a known truth by this code; empty if it does."""
    if not (folder / result).exists():
        return f"{folder} holds no finished run"
    configs = ROOT / "config.yaml", folder.resolve() / "mine.yaml"
    if up_to_date(folder.resolve(), target, "--configfile", *configs):
        return ""
    return f"{folder} is not up to date with the code, see make {folder.name}"


def unfinished_measured(folder):
    """Why a folder does not hold the numbers of ``make measured-beams``; empty if it does, of whatever code."""
    return "" if (folder / "measured.csv").exists() else f"{folder} holds no finished run"


def unfinished_devices(example, table, folder):
    """Why a folder does not hold a finished run of an example of devices by this code; empty if it does."""
    if not (folder / "results" / "tables" / f"{table}.csv").exists():
        return f"{folder} holds no finished run"
    if up_to_date(folder.resolve(), "devices", "--configfile", *configs_of_example(example)):
        return ""
    return f"{folder} is not up to date with examples/{example}.yaml and the code, see stiction devices"


def configs_of_example(name):
    """Configuration files of an example of devices."""
    return ROOT / "config.yaml", ROOT / "examples" / f"{name}.yaml"


def unfinished_attraction(folder):
    """Why a folder does not hold a finished comparison of attraction across gaps; empty if it does."""
    if not (folder / OF_ATTRACTION).exists():
        return f"{folder} holds no finished run"
    configs = ROOT / "config.yaml", ROOT / "examples" / "attraction.yaml"
    if up_to_date(folder.resolve(), OF_ATTRACTION, "--configfile", *configs):
        return ""
    return f"{folder} is not up to date with examples/attraction.yaml and the code, see make attraction ARGS=-n"


def unfinished_print(folder):
    """Why a folder does not hold a finished comparison with print by this code; empty if it does."""
    if not (folder / f"{PRINT}.csv").exists():
        return f"{folder} holds no finished run"
    configs = ROOT / "config.yaml", ROOT / "examples" / "print.yaml"
    if up_to_date(folder.resolve(), "tables", "figures", "--configfile", *configs):
        return ""
    return f"{folder} is not up to date with examples/print.yaml and the code, see make print ARGS=-n"


def unfinished_finer(runs):
    """Why a folder does not hold the reading of print on a finer grid; empty if it does, of whatever code."""
    return "" if (runs / f"{OF_PRINT_FINER}.csv").exists() else f"{runs} does not hold {OF_PRINT_FINER}"


def unfinished_supplement(runs):
    """Why folders do not hold the tables of ``make supplement``; empty if they do, of whatever code."""
    missing = [place for place in SUPPLEMENT.values() if not (runs / f"{place}.csv").exists()]
    return f"{runs} does not hold {' and '.join(missing)} of make supplement" if missing else ""


def unfinished_validation(folder):
    """Why a folder does not hold the tables of ``make validation``; empty if it does, of whatever code."""
    return "" if (folder / "validation.csv").exists() else f"{folder} holds no finished run"


def up_to_date(folder, *arguments):
    """Whether Snakemake has nothing to do in a working directory."""
    plan = [sys.executable, "-m", "snakemake", *arguments, "--snakefile", ROOT / "Snakefile", "--directory", folder]
    plan += ["--workflow-profile", ROOT / "profiles" / "default", "--dry-run"]
    done = subprocess.run(list(map(str, plan)), cwd=ROOT, capture_output=True, text=True)
    return "Nothing to be done" in done.stdout + done.stderr


def collect(results):
    """Copy tables, pictures and scalars of the studies of a run."""
    for name in TABLES:
        for kind in ("csv", "md"):
            shutil.copyfile(results / "tables" / f"{name}.{kind}", DOCS / "tables" / f"{name}.{kind}")
    shutil.copyfile(results / "checks.csv", DOCS / "tables" / "checks.csv")
    texts = scalars(results / "studies") | meshes(results) | timing(results)
    pd.DataFrame(texts.items(), columns=["name", "text"]).to_csv(DOCS / "tables" / "studies.csv", index=False)
    (DOCS / "tables" / "jobs.md").write_text(jobs.table(results), encoding="utf-8")
    compared = quoted.compared_lengths(quoted.frame(DOCS / "tables" / "table_3.csv"))
    (DOCS / "tables" / "crack_lengths.md").write_text(compared + "\n", encoding="utf-8")
    drawn = [name for name in PICTURES if (results / "figures" / f"{name}.png").exists()]
    redraw(results.parent, drawn, ROOT / "config.yaml")


def collect_study(name, results):
    """Copy table and picture of a study of `OWN_STUDIES`."""
    for kind in ("csv", "md"):
        shutil.copyfile(results / "tables" / f"{name}.{kind}", DOCS / "tables" / f"{name}.{kind}")
    if OWN_STUDIES[name][1]:
        redraw(results.parent, [name], *configs_of_study(name))


def collect_example(folder):
    """Copy tables and pictures of a run of the example."""
    for name, place in EXAMPLE_TABLES.items():
        for kind in ("csv", "md"):
            shutil.copyfile(folder / f"{place}.{kind}", DOCS / "tables" / f"{name}.{kind}")
    redraw(folder, EXAMPLE_PICTURES, ROOT / "config.yaml", folder / "mine.yaml")
    shrink(folder / f"{EXAMPLE_DRAWN}.png", DOCS / "pictures" / f"{EXAMPLE_DRAWN}.png", WIDTH)


def collect_beams(folder):
    """Copy table and picture of a run of the example of test beams."""
    for kind in ("csv", "md"):
        shutil.copyfile(folder / f"prediction.{kind}", DOCS / "tables" / f"{DRAWN_BEAMS}.{kind}")
    shrink(folder / "prediction.png", DOCS / "pictures" / f"{DRAWN_BEAMS}.png", WIDTH)


def collect_measured(folder):
    """Copy numbers and table of the test beams that the paper measured."""
    for kind in ("csv", "md"):
        shutil.copyfile(folder / f"measured.{kind}", DOCS / "tables" / f"{MEASURED_BEAMS}.{kind}")


def collect_devices(folder):
    """Copy tables and pictures of a run of the example of devices."""
    for name in DEVICE_TABLES:
        for kind in ("csv", "md"):
            shutil.copyfile(folder / "results" / "tables" / f"{name}.{kind}", DOCS / "tables" / f"{name}.{kind}")
    redraw(folder, DEVICE_PICTURES, *configs_of_example("devices"))


def collect_sealed(folder):
    """Copy tables of a run of the example of sealed devices."""
    for name in SEALED_TABLES:
        for kind in ("csv", "md"):
            shutil.copyfile(folder / "results" / "tables" / f"{name}.{kind}", DOCS / "tables" / f"sealed_{name}.{kind}")


def collect_attraction(folder):
    """Copy the numbers of Table III with and without attraction across gaps, and their table."""
    csv = DOCS / "tables" / f"{ATTRACTION}.csv"
    shutil.copyfile(folder / OF_ATTRACTION, csv)
    csv.with_suffix(".md").write_text(quoted.across_gaps(quoted.frame(csv)) + "\n", encoding="utf-8")


def collect_print(folder):
    """Copy the comparison of both readings with print, and the scalars of the studies under the other reading."""
    for kind in ("csv", "md"):
        shutil.copyfile(folder / f"{PRINT}.{kind}", DOCS / "tables" / f"{PRINT}.{kind}")
    texts = scalars(folder / "results" / "studies")
    frame = pd.DataFrame(texts.items(), columns=["name", "text"])
    frame.to_csv(DOCS / "tables" / f"{PRINT_STUDIES}.csv", index=False, lineterminator="\n")


def collect_finer(runs):
    """Copy the table of the reading of print on a finer grid."""
    for kind in ("csv", "md"):
        shutil.copyfile(runs / f"{OF_PRINT_FINER}.{kind}", DOCS / "tables" / f"{PRINT_FINER}.{kind}")


def collect_supplement(runs):
    """Copy tables and picture of the supplement."""
    for name, place in SUPPLEMENT.items():
        for kind in ("csv", "md"):
            shutil.copyfile(runs / f"{place}.{kind}", DOCS / "tables" / f"{name}.{kind}")
    shrink(runs / "supplement" / "supplement.png", DOCS / "pictures" / f"{SUPPLEMENT_PICTURE}.png", WIDTH)


def collect_validation(folder):
    """Copy tables and picture of the benchmark."""
    for name, file in VALIDATION.items():
        shutil.copyfile(folder / file, DOCS / "tables" / name)
    shrink(folder / f"{VALIDATION_PICTURE}.png", DOCS / "pictures" / f"{VALIDATION_PICTURE}.png", WIDTH)


def collect_roughness(folder):
    """Copy table and pictures of a run of the example of roughness."""
    for kind in ("csv", "md"):
        shutil.copyfile(folder / "results" / "tables" / f"{ROUGHNESS}.{kind}", DOCS / "tables" / f"{ROUGHNESS}.{kind}")
    redraw(folder, ROUGHNESS_PICTURES, *configs_of_example("roughness"))


def collect_process(folder):
    """Table, pictures and sentences on each device of a run of the example of a process."""
    results, tables = folder / "results", DOCS / "tables"
    for kind in ("csv", "md"):
        shutil.copyfile(results / "tables" / f"{PROCESS}.{kind}", tables / f"{PROCESS}.{kind}")
    redraw(folder, PROCESS_PICTURES, ROOT / "config.yaml", folder / "mine.yaml")
    (path,) = (results / "process" / "settings").glob("*.nc")
    settings = load(path, "process_settings")
    rows = [
        {"device": who.replace(" ", "_"), "name": number, "text": text}
        for who in map(str, settings.who.values)
        for number, text in enumerate(sentences_process.answers(settings, who), 1)
    ]
    pd.DataFrame(rows).to_csv(tables / f"{PROCESS_SAID}.csv", index=False, lineterminator="\n")


def collect_test_beams(folder):
    """Sentences of the pages of a run of the example of test beams, by device and name, and one picture."""
    rows = []
    for path in sorted((folder / "results" / "devices" / "test_beams" / "rerun").glob("*.nc")):
        update = load(path, "test_beams_rerun")
        answer = answer_of(load(folder / "results" / "devices" / "answer" / path.name, "answer"))
        said = {name: of(update, answer) for name, of in TEST_BEAMS_SAID.items()}
        rows += [{"device": path.stem, "name": name, "text": text} for name, text in said.items()]
    pd.DataFrame(rows).to_csv(DOCS / "tables" / f"{TEST_BEAMS}.csv", index=False, lineterminator="\n")
    redraw(folder, [TEST_BEAMS_PICTURE], *configs_of_example("test_beams"))


def scalars(studies):
    """Single numbers of the studies that have no table: name to text."""
    texts = {}
    for path in sorted((studies / "plasticity").glob("*.nc")):
        study = load(path, "plasticity")
        share, error = 100 * float(study.plastic_share), 100 * float(study.plastic_share_error)
        texts[f"plastic_{path.stem}"] = f"{with_error(share, error)} %" if share > 0 else "0 %"
    sizes, orders, mesh, correlation = (
        load(studies / f"{name}.nc", name) for name in ("sample_sizes", "orders", "mesh", "correlation")
    )
    total, half = (int(size) for size in sizes["size"].values[[-1, -2]])
    texts["samples"], texts["samples_distance"] = str(total), f"{sampling_distance(total):.3f}"
    texts["half"], texts["half_distance"] = str(half), f"{float(sizes.distance.sel(size=half)):.3f}"
    texts |= {f"order_{k}": str(order) if order else "none" for k, order in enumerate(orders.converged_order.values, 1)}
    texts["orders"] = str(int(orders.order[-1]))
    of_paper = np.isclose(mesh.element_length, 7.5e-6) & np.isclose(mesh.point_distance, 1.5e-6)
    excess = mesh.energy.values[of_paper][0] / forcelaw.energy(mesh.law.values) - 1
    texts["mesh_excess"] = f"{100 * excess:.1f}"
    for name, length in zip(correlation.surface.values, correlation.correlation_length.values, strict=True):
        texts[f"correlation_{name}"] = f"{TO_UM * float(length):.2f}"
    return texts


def meshes(results):
    """Elements and strips of the beams in foundation lengths, over all cases; size of one stored sample of contact."""
    plan, lengths = Plan(paper()), []
    for case, model in plan.laws:
        samples, limit = vectors(load(results / "forces" / f"{case}_{model}.nc", "forces"))
        beam = cantilever(in_si(Cantilevers, sections(plan, case.pair)), case.pair)
        laws = forcelaw.coefficients(samples[forcelaw.admissible(samples, limit)], limit)
        lengths.append(foundation_length(beam, laws))
    strip = in_si(StripLength, {"strip_length_um": plan.config["sampling"]["strip_length_um"]}).strip_length
    texts = {}
    for name, size in (("elements", beam.element_length), ("strips", strip)):
        texts |= {f"{name}_least": f"{size / max(lengths):.2g}", f"{name}_most": f"{size / min(lengths):.2g}"}
    contact = load(results / "contact" / f"{plan.figure_pair}_NG.nc", "contact")
    return texts | {"sample_kB": f"{4e-3 * (contact.sizes['distance'] + contact.sizes['height']):.1f}"}


def timing(results):
    """Number, time and memory of the jobs of a run, and the machine: name to text."""
    costs = list(jobs.costs(results))
    _, number, longest, seconds, megabytes, *_ = zip(*costs, strict=True)
    run = json.loads((results / "provenance.json").read_text(encoding="utf-8"))[-1]
    machine = run["machine"]
    return {
        "jobs": str(sum(number)),
        "job_minutes": f"{sum(seconds) / 60:.1f}",
        "job_longest": f"{max(longest):.0f}",
        "job_memory": f"{max(megabytes):.0f}",
        "cpu": " ".join(machine["cpu"].split()),
        "cores": str(machine["cores"]),
    }


def redraw(folder, names, *configs):
    """Draw figures of a run in a working folder again, as on a page, for ``docs/pictures``."""
    with TemporaryDirectory() as drawn:
        narrow.draw(folder, Path(drawn), names, *configs)
        for name in names:
            shrink(Path(drawn) / f"{name}.png", DOCS / "pictures" / f"{name}.png", WIDTH)


def shrink(picture, smaller, width):
    """Copy of a picture in its own colours and at most ``width`` pixels across, small enough for a repository.

    A large one has 256 colours, before it has fewer pixels. The copy tells its resolution, so that the size of its text
    is known.
    """
    with Image.open(picture) as image:
        inches = image.width / image.info["dpi"][0] if "dpi" in image.info else None
        flat = Image.new("RGB", image.size, "white")
        flat.paste(image, mask=image.convert("RGBA").getchannel("A"))
    for scale in (1, 0.85, 0.7, 0.6, 0.5):
        across = min(flat.width, round(scale * width))
        resized = flat.resize((across, round(flat.height * across / flat.width)), Image.Resampling.LANCZOS)
        for image in (resized, resized.quantize(256, dither=Image.Dither.NONE)):
            image.save(smaller, optimize=True, **({"dpi": (across / inches,) * 2} if inches else {}))
            if smaller.stat().st_size <= LARGEST:
                return
    raise ValueError(f"{picture} stays above {LARGEST} bytes")


# 2. and 3. From docs/tables to results.json and the pages


def tables():
    """Path to text of every table and rule that is written from schema, stages, or a template with numbers."""
    made = {"keys_of_the_simulation": keys.of_simulation(), "materials": keys.materials()}
    template = (DOCS / "templates" / "tables" / f"{BESIDE}.md").read_text(encoding="utf-8")
    made[BESIDE] = filled(template, quoted_numbers()).strip()
    return {DOCS / "tables" / f"{name}.md": text + "\n" for name, text in made.items()} | rules.written()


def pages():
    """Path to text of every file that is written from ``docs/tables`` and ``docs/templates``, one in the package."""
    numbers = quoted_numbers()
    texts = {
        DOCS / "results.json": json.dumps(record(numbers), indent=1, ensure_ascii=False, sort_keys=True) + "\n",
        prediction.PAPER_LENGTHS: measured_lengths(),
    }
    for template in sorted((DOCS / "templates").glob("*.md")):
        body = filled(template.read_text(encoding="utf-8"), numbers)
        texts[page_of(template)] = NOTE.format(name=template.name) + "\n\n" + body
    return texts


def page_of(template):
    """File that is written from a template."""
    return ROOT / "config" / "README.md" if template.name == "config.md" else DOCS / template.name


def measured_lengths():
    """Measured lengths, and those computed without and with attraction across gaps, for the package.

    They are rounded to 0.1 µm, so that a run with the same lengths reruns no devices.
    """
    case, computed = ["pair", "relative_humidity"], "crack_length_um"
    table, gaps = (quoted.frame(DOCS / "tables" / f"{name}.csv") for name in ("table_3", ATTRACTION))
    touching = table[(table.model == "NG") & table.experiment_um.notna()].set_index(case)
    across = gaps[gaps.variant == "reach_all"].set_index(case)[computed]
    lengths = pd.DataFrame(
        {
            prediction.TOUCHING: touching[computed],
            prediction.ACROSS_GAPS: across.reindex(touching.index),
            prediction.MEASURED: touching.experiment_um,
        }
    )
    return lengths.round(1).to_csv(lineterminator="\n")


def quoted_numbers():
    """Every number that may be quoted, by name."""
    frames = {
        name: quoted.frame(DOCS / "tables" / f"{name}.csv")
        for name in (
            *TABLES,
            *OWN_STUDIES,
            ATTRACTION,
            MEASURED_BEAMS,
            PRINT,
            PRINT_STUDIES,
            PRINT_FINER,
            *SUPPLEMENT,
            ROUGHNESS,
            PROCESS_SAID,
            TEST_BEAMS,
            *(f"sealed_{name}" for name in SEALED_TABLES),
            *DEVICE_TABLES,
            "example_scans",
            "studies",
            "checks",
            "timings",
        )
    }
    frames |= {"validation": quoted.licensed(DOCS / "tables" / "validation.csv")}
    return quoted.numbers(frames | {TAILS: quoted.of_markdown(DOCS / "tables" / f"{TAILS}.md")})


def record(numbers):
    """Numbers quoted by the pages, and checksums of the tables and pictures that the pages are made of."""
    quoted_names = {name for text in templates() for name in re.findall(r"{{ (\w+) }}", text)} - {*MADE}
    files = sorted(path for folder in ("tables", "pictures") for path in (DOCS / folder).iterdir())
    return {
        "numbers": {name: numbers[name] for name in sorted(quoted_names)},
        "files": {f"{path.parent.name}/{path.name}": hashlib.sha256(path.read_bytes()).hexdigest() for path in files},
    }


def templates():
    """Text of all templates."""
    return [path.read_text(encoding="utf-8") for path in sorted((DOCS / "templates").rglob("*.md"))]


def filled(template, numbers):
    """Template with ``{{ name }}`` replaced by a number and ``{{ table: name }}`` by a table with its caption."""
    with_tables = re.sub(r"{{ table: (\w+) }}", lambda match: shown(DOCS / "tables" / f"{match[1]}.md"), template)
    with_keys = with_tables
    for name, made in MADE.items():
        if f"{{{{ {name} }}}}" in with_keys:
            with_keys = with_keys.replace(f"{{{{ {name} }}}}", made())
    return re.sub(r"{{ (\w+) }}", lambda match: numbers[match[1]], with_keys)


def shown(path):
    """Markdown table in which values and errors stay on one line."""
    return path.read_text(encoding="utf-8").strip().replace(" ± ", "\N{NO-BREAK SPACE}±\N{NO-BREAK SPACE}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
