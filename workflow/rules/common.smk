"""What all rules share: the checked configuration, names of cases, settings and code that a job depends on."""

import fcntl

from stiction.config import cases as keys
from stiction.run import fingerprint, provenance
from stiction.config import settings


wildcard_constraints:
    surface="[A-Za-z][A-Za-z0-9]*",
    pair="[A-Za-z][A-Za-z0-9]*",
    model="NG|G|GEO",
    case=keys.CASE,
    chunk="[0-9]+",
    number="[0-9]+",


try:
    for file in workflow.configfiles:  # Snakemake takes the last of two equal keys without a word
        settings.read(file)
    settings.validate(config, settings.read(BASE / "workflow" / "schemas" / "config.schema.yaml"))
except settings.ConfigError as error:
    raise WorkflowError(f"The configuration cannot run:\n{error}")


def in_order(value):
    """The same with sorted keys: their order in a file changes no parameter of a rule."""
    return {key: in_order(value[key]) for key in sorted(value)} if isinstance(value, dict) else value


config.update(in_order(config))
for pair in config["pairs"].values():
    pair["humidities"].sort()  # tables and curves begin with the driest, in whatever order they were written
PAIRS = config["run"]["pairs"]
SIDES = ("beam", "substrate")
MODELS = ("G", "NG", "GEO")
STYLE = str(BASE / "src" / "stiction" / "report" / "stiction.mplstyle")
MOMENTS = ("rms_nm", "skewness", "kurtosis")
SUMMITS = ("mean_summit_radius_um", "summit_density_per_um2")
SURFACES = [
    name for name in config["surfaces"] if any(name in (config["pairs"][p][side] for side in SIDES) for p in PAIRS)
]
# Those whose summits were measured can have their spectrum identified.
MEASURED = [name for name in SURFACES if all(key in config["surfaces"][name] for key in SUMMITS)]
CASES = [keys.case_id(pair, humidity) for pair in PAIRS for humidity in config["pairs"][pair]["humidities"]]
# Force laws, of which model GEO has those of NG, and beams: case and model.
LAWS = [(case, model) for case in CASES for model in ("G", "NG")]
OUTCOMES = [(case, model) for case in CASES for model in MODELS]
STRIP = {"strip_length_um": config["sampling"]["strip_length_um"]}
FIGURE_CASES = [keys.case_id(pair, config["figures"]["humidity"]) for pair in PAIRS]
FIGURE_PAIR = config["figures"]["pair"] if config["figures"]["pair"] in PAIRS else PAIRS[0]
FIGURE_CASE = keys.case_id(FIGURE_PAIR, config["figures"]["humidity"])
FIGURE_SURFACE = config["pairs"][FIGURE_PAIR]["beam"]
FIGURE = {"pair": FIGURE_PAIR, "humidity": config["figures"]["humidity"]}


def code(script):
    """Fingerprint of a script and of all code of the package behind it."""
    return fingerprint.fingerprint(BASE / "workflow" / "scripts" / script)


def section(*names, **more):
    """Sections of the configuration that a job depends on, as one plain dict."""
    return {name: config[name] for name in names} | more


def chosen(entry, names):
    """Those keys of a section that are named and given."""
    return {name: entry[name] for name in names if name in entry}


def spectrum_source(wildcards):
    """An identified spectrum depends on its identification."""
    identified = config["surfaces"][wildcards.surface]["psd"] == "identified"
    return {"identification": "results/identification/{surface}.nc"} if identified else {}


def surfaces_of_pair(wildcards):
    """Datasets of the beam's and the substrate's surface, in this order."""
    names = [config["pairs"][wildcards.pair][side] for side in SIDES]
    return {
        stage: expand("results/{stage}/{surface}.nc", stage=stage, surface=names) for stage in ("heights", "spectrum")
    }


def meeting(wildcards):
    """Which surfaces meet, as names because a change of input files reruns nothing, and how wide."""
    pair = config["pairs"][wildcards.pair]
    return {"surfaces": [pair[side] for side in SIDES], "beam": {"width_um": config["beam"]["width_um"]}}


def contact_settings(wildcards):
    """All that the contact of a pair depends on; neither humidity nor the number of chunks."""
    contact = {key: value for key, value in config["contact"].items() if key != "chunks"}
    return section("seed", "sampling", "solid", "van_der_waals", contact=contact, **meeting(wildcards))


def printed(number):
    """The published table."""
    return str(BASE / "workflow" / "resources" / f"table_{number}.csv")


def table_files(name, shows):
    """Outputs of a rule that makes a table; the page is for the report."""
    labels = {"item": name.replace("_", " ").capitalize(), "shows": shows}
    page = report(f"results/tables/{name}.html", category="Tables", labels=labels)
    return {"csv": f"results/tables/{name}.csv", "markdown": f"results/tables/{name}.md", "html": page}


def keys_of(cases):
    """Pair, humidity and model of every (case, model)."""
    return [(keys.pair_of(case), keys.humidity_of(case), model) for case, model in cases]


def cantilever_settings(*pairs):
    """Sections from which `stiction.stages.cantilevers` makes the nominal beams of pairs."""
    return {
        "solid": chosen(config["solid"], ["young_modulus_GPa"]),
        "beam": chosen(config["beam"], ("length_um", "width_um", "thickness_um", "elements")),
        "pairs": {pair: chosen(config["pairs"][pair], ["gap_um"]) for pair in pairs},
    }


HELD = []  # open files: the lock of this run goes with the process


def reserve_folder():
    """Refuse a second run in this folder; unlike Snakemake's own lock, this one does not outlive a killed run."""
    try:
        HELD.append(open(".snakemake/running", "w"))
        fcntl.flock(HELD[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise WorkflowError("Another run works in this folder. Wait for its end, or end it.")
    except OSError as error:
        raise WorkflowError(f"This folder cannot be locked ({error}). Choose a --directory on a disk that knows locks.")
