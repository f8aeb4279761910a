"""Definitions shared by all rules: validated configuration and plan, code of a job, names of files."""

from functools import cache
from types import SimpleNamespace

from snakemake.logging import logger

from stiction.config import cases, files, jobs, memory, relations
from stiction.config.plan import Plan
from stiction.models import BEAM_MODELS, SURFACE_MODELS, surface_model
from stiction.run import folder, kept, provenance
from stiction.run.atomic import DataError
from stiction.run.fingerprint import fingerprint


wildcard_constraints:
    surface="[A-Za-z][A-Za-z0-9]*",
    pair="[A-Za-z][A-Za-z0-9]*",
    model="|".join(BEAM_MODELS),
    case=cases.CASE,
    chunk="[0-9]+",
    number="[0-9]+",
    moment="rms|skewness|kurtosis",
    side="less|more",
    variant="base|[a-z_]+_[a-z0-9.-]+",


try:
    for file in workflow.configfiles:  # Snakemake silently uses the last of duplicate keys
        files.read(file)
    relations.validate(config)
except files.ConfigError as error:
    raise WorkflowError(f"The configuration is invalid:\n{error}")

config.update(files.normalised(config))
plan = Plan(config)
MEMORY = memory.of_job(config)  # of the jobs that draw surfaces [MB]
STYLE = str(BASE / "src" / "stiction" / "report" / "stiction.mplstyle")
# Categories of the report.
ON_SURFACES, ON_FORCES, ON_BEAMS = "Surfaces (Sec. II)", "Contact forces (Sec. III)", "Beams (Secs. IV and V)"
ON_STUDIES = "Sensitivity, appendices, model choices"


def code(script):
    """Fingerprint of a script and of all modules of the package that it imports."""
    return fingerprint(BASE / "workflow" / "scripts" / script)


@cache
def settings_of(path):
    """Settings of the job that writes a dataset; ``None`` if this configuration has no such job."""
    for written_by in workflow.rules:
        if written_by.output and (found := written_by.output[0].match(path)):
            settings = written_by.params.settings
            try:
                return settings(SimpleNamespace(**found.groupdict())) if callable(settings) else settings
            except KeyError:  # of a surface, pair or variant that this configuration does not contain
                return None
    return None


@cache
def unusable():
    """Files in results/ that other settings gave, or that are damaged: to this run they are missing."""
    found = {**dict(kept.foreign(Path("results").rglob("*.nc"), settings_of)), **dict(kept.damaged("results/logs"))}
    for line in kept.summary(found):
        logger.warning(line)
    return found


def planned(wildcards):
    """No input. Snakemake calls this while it plans a run, because every run begins with the heights of a surface."""
    if workflow.is_main_process:
        workflow.dag.forcefiles.update(unusable())
    return []


def identified(wildcards):
    """Dataset of the identification if the spectrum is identified, otherwise nothing."""
    source = config["surfaces"][wildcards.surface]["psd"]
    return "results/identification/{surface}.nc" if source == "identified" else []


def surfaces_of_pair(wildcards):
    """Datasets of the surfaces of beam and substrate, in this order."""
    return {
        stage: expand("results/{stage}/{surface}.nc", stage=stage, surface=plan.sides(wildcards.pair))
        for stage in ("heights", "spectrum")
    }


def of_case(stage):
    """Dataset of a stage independent of humidity, for the pair of a case."""
    return lambda w: f"results/{stage}/{cases.pair_of(w.case)}_{w.model}.nc"


def published(table):
    """File of published values."""
    return str(BASE / "workflow" / "resources" / f"{table}.csv")


def titled(name, shows):
    """Title of a result in the report, such as ``Figure 5: a force curve``."""
    return f"{name.replace('_0', ' ').replace('_', ' ').capitalize()}: {shows}"


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
