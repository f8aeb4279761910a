"""Definitions shared by all rules: validated configuration and plan, code of a job, names of files."""

from stiction.config import cases, files, jobs, memory, relations
from stiction.config.plan import Plan
from stiction.models import BEAM_MODELS, SURFACE_MODELS, surface_model
from stiction.run import folder, provenance
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
