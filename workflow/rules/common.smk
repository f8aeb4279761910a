"""Definitions shared by all rules: validated configuration and plan, code of a job, files of tables and figures."""

from functools import cache

from snakemake.logging import logger

from stiction.config import cases, files, jobs, measured, memory, messages
from stiction.config.designs import KEYS_OF_SOLIDS, Designs
from stiction.config.paths import Paths, one_of, titled
from stiction.config.plan import Plan
from stiction.models import (
    ALTERNATIVES_OF_SCANS,
    BEAM_MODELS,
    OF_MEASURED,
    OF_MOMENTS,
    OF_SPECTRUM,
    SHIFTED,
    SURFACE_MODELS,
    surface_model,
)
from stiction.run import folder, hooks, kept, provenance
from stiction.run.atomic import DataError
from stiction.run.fingerprint import PACKAGE, fingerprint
from stiction.run.remembered import Remembered


wildcard_constraints:
    surface="[A-Za-z][A-Za-z0-9]*",
    device="[A-Za-z][A-Za-z0-9]*",
    pair="[A-Za-z][A-Za-z0-9]*",
    model="|".join(BEAM_MODELS),
    case=cases.CASE,
    chunk="[0-9]+",
    number="[0-9]+",
    moment="|".join(OF_MOMENTS),
    quantity="|".join({*OF_MOMENTS, *OF_MEASURED, *OF_SPECTRUM}),
    side="|".join(SHIFTED),
    solid_property="|".join(KEYS_OF_SOLIDS),
    choice="|".join(ALTERNATIVES_OF_SCANS),
    variant="base|[a-z_]+_[a-z0-9.-]+",
    length="[0-9]+",
    width="[0-9]+",


try:
    folder.require_writable(".snakemake")
except RuntimeError as error:
    raise WorkflowError(str(error))

hooks.compare_without_pandas()
remember = Remembered(".snakemake/planning.json")


def code(script):
    """Fingerprint of a script, or of a module of the package, and of all modules of the package that it imports."""
    return fingerprint(BASE / "workflow" / "scripts" / script, remember)


def validated():
    """Preliminary numbers of the measured surfaces of a valid configuration."""
    from stiction.config.validation import validate

    return validate(config, kept=".snakemake/scans")


def rules_of_the_configuration():
    """Code and schema that decide whether a configuration is valid."""
    folder = PACKAGE / "config"
    modules = [
        code(folder / f"{name}.py")
        for name in ("validation", "conditions", "relations", "relations_devices", "messages")
    ]
    return [*modules, (folder / "schema.yaml").read_text(encoding="utf-8")]


try:
    # Read again, because Snakemake silently uses the last of duplicate keys.
    contents = {file: files.read(file) for file in hooks.files_of_configuration(workflow)}
    for file in contents:  # files of scans are relative to the first match
        config.update(measured.anchored(config, contents[file], file.parent))
    scanned = measured.has_scans(config)
    preliminary = validated() if scanned else remember(["valid", config, rules_of_the_configuration()], validated)
except messages.ConfigError as error:
    raise WorkflowError(f"The configuration is invalid:\n{error}")

config.update(files.normalised(config))
plan = Plan(config, preliminary)
if not scanned:  # finding out takes the solver of densities
    shifted = ["shifted", config, code(PACKAGE / "config" / "plan.py")]
    vars(plan)["shifted_moments"] = remember(shifted, lambda: plan.shifted_moments)
designs = Designs(config)
paths = Paths(plan)
MEMORY = memory.of_job(config)  # of the jobs that draw surfaces [MB]
VIEW = measured.view(config, preliminary)  # configuration with preliminary numbers of measured surfaces
SAMPLES = memory.of_samples(VIEW)  # of the jobs that hold the contact of all samples [MB]
STYLE = str(PACKAGE / "report" / "stiction.mplstyle")
# Categories of the report.
ON_SURFACES, ON_FORCES, ON_BEAMS = "Surfaces (Sec. II)", "Contact forces (Sec. III)", "Beams (Secs. IV and V)"
ON_STUDIES = "Sensitivity, appendices, model choices"
ON_DEVICES = "Devices"


@cache
def settings_of(path):
    """Settings of the job that writes a dataset; ``None`` if this configuration has no such job."""
    return kept.settings(path, hooks.rules_of(workflow))


def unlike_this_run():
    """Files in results/ that other settings gave, or that are damaged; what is read of them, the next plan knows."""
    read = Remembered(".snakemake/labels.json")
    found = dict(kept.damaged("results/logs", read))
    found |= dict(kept.foreign(Path("results").rglob("*.nc"), settings_of, read))
    read.save()
    return found


@cache
def unusable():
    """These files, which are named: to this run they are missing."""
    found = unlike_this_run()
    for line in kept.summary(found):
        logger.warning(line)
    return found


def planned(wildcards):
    """No input. Snakemake calls this while it plans a run, because every run begins with the heights of a surface."""
    if hooks.is_main(workflow):
        hooks.force(workflow, unusable())
    return []


def surfaces_of_pair(wildcards):
    """Datasets of the surfaces of beam and substrate, in this order."""
    return paths.surfaces(wildcards.pair)


def published(table):
    """File of published values."""
    return str(BASE / "workflow" / "resources" / f"{table}.csv")


def table_files(name, shows):
    """Outputs of a rule for a table; the HTML page is for the report."""
    title = titled(name, shows)
    page = report(f"results/tables/{name}.html", category="Tables", labels={"shows": title})
    return {"csv": f"results/tables/{name}.csv", "markdown": f"results/tables/{name}.md", "html": page}


def figure_files(name, category, shows, caption=None):
    """Outputs of a rule for a figure; the PNG file is for the report."""
    title = titled(name, shows)
    text = f"../report/{caption or name}.rst"
    picture = report(f"results/figures/{name}.png", caption=text, category=category, labels={"shows": title})
    return {"pdf": f"results/figures/{name}.pdf", "png": picture}
