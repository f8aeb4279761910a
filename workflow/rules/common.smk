"""What all rules share: the checked configuration, names of cases, settings and code that a job depends on."""

import fcntl

from stiction import keys, provenance, sensitivity, settings


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
PAIRS = config["run"]["pairs"]
SIDES = ("beam", "substrate")
STYLE = str(BASE / "src" / "stiction" / "stiction.mplstyle")
SUMMITS = {"mean_summit_radius_um", "summit_density_per_um2"}
SURFACES = [
    name for name in config["surfaces"] if any(name in (config["pairs"][p][side] for side in SIDES) for p in PAIRS)
]
# Those whose summits were measured can have their spectrum identified.
MEASURED = [name for name in SURFACES if SUMMITS <= config["surfaces"][name].keys()]
CASES = [keys.case_id(pair, humidity) for pair in PAIRS for humidity in config["pairs"][pair]["humidities"]]
FIGURE_CASES = [keys.case_id(pair, config["figures"]["humidity"]) for pair in PAIRS]
FIGURE_PAIR = config["figures"]["pair"] if config["figures"]["pair"] in PAIRS else PAIRS[0]
FIGURE = {"pair": FIGURE_PAIR, "humidity": config["figures"]["humidity"]}


def code(script):
    """Fingerprint of a script and of all code of the package behind it."""
    return provenance.fingerprint(BASE / "workflow" / "scripts" / script)


def section(*names, **more):
    """Sections of the configuration that a job depends on, as one plain dict."""
    return {name: config[name] for name in names} | more


def moments_of(wildcards):
    """Moments of one surface, Table I."""
    entry = config["surfaces"][wildcards.surface]
    return {key: entry[key] for key in ("rms_nm", "skewness", "kurtosis")}


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


# Studies beside the main line.
STUDIES = config["studies"]
FIGURE_CASE = keys.case_id(FIGURE_PAIR, config["figures"]["humidity"])
CONTACT = {key: value for key, value in config["contact"].items() if key not in ("chunks", "samples")}
PRESSED_PAIRS = [pair for pair in PAIRS if pair in STUDIES["plasticity"]["distance_nm"]]
# Section of the configuration in which a reading changes a key; the source of the spectra stands with each surface.
CHANGED = {"van_der_waals": None, "psd": None, "every": "contact", "spacing_nm": "sampling", "poisson_ratio": "solid"}
READINGS = {"base": {}} | {
    f"{key}_{value}": {part: {key: value}} if part else {key: value}
    for key, part in CHANGED.items()
    for value in STUDIES["readings"][key]
}


def can_be_shifted(moment):
    """Whether the beam's surface of Figure 13 exists with a little less and a little more of a moment."""
    surface = config["surfaces"][config["pairs"][FIGURE_PAIR]["beam"]]
    shape = {key: surface[key] for key in ("kurtosis", "skewness")}
    at = sensitivity.shifted(surface[moment], STUDIES["sensitivity"]["step"])
    return at[0] * at[1] > 0 and not any(settings.heights_have_a_density(**shape | {moment: value}) for value in at)


MOMENTS = ["rms", *filter(can_be_shifted, ("skewness", "kurtosis"))]


def keys_of(cases):
    """Pair, humidity and model of every (case, model)."""
    return [(keys.pair_of(case), keys.humidity_of(case), model) for case, model in cases]


def nominal_beam(pair):
    """Beam of a pair as the configuration has it."""
    dimensions = ("length_um", "width_um", "thickness_um", "elements")
    return {key: config["beam"][key] for key in dimensions} | {
        "gap_um": config["pairs"][pair]["gap_um"],
        "young_modulus_GPa": config["solid"]["young_modulus_GPa"],
    }
