"""Configuration and plan of a run, and functions for the rules of all stages."""

import atexit
import hashlib
import json
import uuid
from functools import cache, partial

from snakemake.logging import logger

from stiction.command.prepared import prepared, problems_of_samples
from stiction.command.run_state import RUN
from stiction.config import files, merging, messages
from stiction.config.tables import device_table
from stiction.plan import cost, memory
from stiction.plan.planner import ALL_TARGETS, Planner
from stiction.plan.stage import WILDCARDS
from stiction.run import provenance, run_lock, snakemake_patches, stale_results
from stiction.run.atomic import DataError, save_text
from stiction.run.disk_cache import Caches, DiskCache, SharedCache
from stiction.run.fingerprint import PACKAGE, fingerprint


wildcard_constraints:
    **WILDCARDS,


try:
    run_lock.require_writable(".snakemake")
except RuntimeError as error:
    raise WorkflowError(str(error))

snakemake_patches.compare_without_pandas()
snakemake_patches.look_for_scripts_once()
snakemake_patches.remember_signatures()
remember_code = SharedCache(".snakemake/code.json")
is_main = snakemake_patches.is_main(workflow)
if not is_main:
    snakemake_patches.keep_to_allotted_cores(workflow)


def code(file):
    """Fingerprint of a file, and of all modules of the package that it imports."""
    return fingerprint(file, remember_code)


def contents_of_files():
    """Read the files of the configuration strictly. Snakemake silently uses the last of duplicate keys."""
    contents = {file: files.read(file) for file in snakemake_patches.files_of_configuration(workflow)}
    # A workflow that imports this one as a module gives only its changes, in place of the file with all keys.
    defaults = BASE / "config.yaml"
    sections = merging.merged(contents.get(defaults) or files.read(defaults), config)
    changes = [contents[file] for file in contents if file != defaults]
    sections = merging.without_inherited(sections, files.paper(), changes)
    for file in contents:  # paths of scans, test beams and devices are relative to the first file that matches
        sections = files.located(sections, contents[file], file.parent)
    return device_table.with_rows(sections)


#: Results of this plan for the next one.
CACHES = Caches(Path(".snakemake"), remember_code)


def complete():
    """Complete the configuration, with numbers of measured surfaces. Report the numbers that it leaves open."""
    ready = prepared(contents_of_files(), CACHES)
    if ready.numbers:
        logger.warning(str(ready.numbers))
    return ready.config, ready.estimates


#: File with the complete configuration and the numbers of measured surfaces, for the jobs of this run.
PLANNED = ".snakemake/configuration.json"

try:
    planned, preliminary = config["planned"] if "planned" in config and not is_main else complete()
except messages.ConfigError as error:
    raise WorkflowError(f"The configuration is invalid:\n{error}")

config.clear()
config.update(planned)


def refuse_what_samples_show():
    """Refuse a configuration whose first samples show that a job would fail."""
    if problems := problems_of_samples(config, preliminary, CACHES):
        raise WorkflowError("The configuration is invalid:\n" + "\n".join(map(str, problems)))


remember_jobs = DiskCache(".snakemake/jobs.json")
planner = Planner(config, preliminary, remember_code, remember_jobs)

if is_main:
    atexit.register(remember_jobs.save)


def hand_to_jobs():
    """Store the plan, so that jobs plan again in a fraction of the time."""
    remember_jobs.save()
    save_text(json.dumps({"planned": [config, preliminary]}), PLANNED)
    snakemake_patches.read_in_jobs(workflow, Path(PLANNED).absolute())


# Results of other runs


def unlike_this_run():
    """Find damaged results and results of other settings. Cache their labels for the next plan."""
    labels = DiskCache(".snakemake/labels.json")
    reasons = dict(stale_results.damaged("results/logs", labels))
    reasons |= dict(stale_results.foreign(Path("results").rglob("*.nc"), planner.settings, labels))
    reasons |= dict(stale_results.made_otherwise("results/logs", planner.origin))
    labels.save()
    return reasons


#: Marker: an input of jobs that must rerun. It is newer than their results. Each run writes other content into it,
#: because Snakemake takes a newer input with the same content for unchanged.
STALE = Path(".snakemake/stale")


@cache
def unusable():
    """Warn about unusable results and return them. This run recomputes them."""
    if not is_main:
        return {}
    reasons = RUN.unlike = unlike_this_run()
    for line in stale_results.summary(reasons):
        logger.warning(line)
    if reasons:
        save_text(uuid.uuid4().hex, STALE)
    return reasons


def refuse_to_touch():
    """Refuse to mark files of other settings as new. Snakemake would then take them for files of this run."""
    if snakemake_patches.only_touches(workflow) and unusable():
        raise WorkflowError(
            f"--touch would mark files of other settings as new: {stale_results.in_words(unusable())}. "
            "Run without --touch."
        )


def end_of_run():
    """Write the index. Leave out files of other runs."""
    from stiction.command import index

    RUN.unlike = unlike_this_run()
    index.write(Path("results"), planner.rules, RUN.unlike)


# Rules of stages. The module of a stage declares it (`stiction.plan.stage`), under the name of its rule

SCRIPT = code(BASE / "workflow" / "scripts" / "stage.py")
#: Declared stages with files under this configuration, by name.
DECLARED = {declared["name"]: declared for declared in planner.rules}


def inputs_of(stage):
    """Input function of the rule of a stage."""
    declared = DECLARED[stage]
    caption = caption_of(declared)

    def inputs(wildcards):
        files = planner.inputs(declared, dict(wildcards)) | caption
        files |= {name: ancient(paths) for name, paths in files.items() if package_files(paths)}
        files |= {"before": ancient(planner.before_last)} if declared["last"] else {}
        outputs = {file.format(**dict(wildcards)) for file in declared["files"].values()} if unusable() else set()
        return files | {"stale": STALE} if outputs & unusable().keys() else files

    return inputs


def caption_of(declared):
    """Template of the caption of a figure, for the report and for the text beside the figure."""
    caption = (declared["shown"] or {}).get("caption")
    return {"caption": str(BASE / "workflow" / "report" / f"{caption}.rst")} if caption else {}


def package_files(paths):
    """Files of this package among some inputs: captions, styles, templates, published tables.

    Their content is a parameter of the jobs. Their times are those of a checkout and decide nothing.
    """
    files = [paths] if isinstance(paths, str) else paths
    return [file for file in files if file.startswith((str(PACKAGE), str(BASE / "workflow")))]


@cache
def digest(file):
    """First digits of the hash of a file."""
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()[:8]


def outputs_of(stage):
    """Files of a stage by key."""
    declared = DECLARED[stage]
    outputs = {key: temp(file) if declared["temporary"] else file for key, file in declared["files"].items()}
    if shown := declared["shown"]:
        labels = {"shows": shown["title"]}
        outputs[shown["file"]] = report(
            outputs[shown["file"]], category=shown["category"], labels=labels, **caption_of(declared)
        )
    return outputs


#: Memory of a job that draws the largest field [MB].
MEMORY = memory.job_memory(config)


def resources_of(stage):
    """Functions for the time, the memory and the CPU time of a job, see `stiction.plan.cost`."""
    declared, job = DECLARED[stage], partial(planner.job, stage)
    megabytes = max(MEMORY, round(declared["memory"]))
    return {
        "runtime": lambda wildcards, attempt: memory.for_attempt(
            cost.minutes(job(wildcards)["seconds"], declared["minutes"]), attempt
        ),
        "mem_mb": lambda wildcards, attempt: memory.for_attempt(megabytes, attempt),
        "cpu_ms": lambda wildcards: round(1000 * job(wildcards)["seconds"]),  # whole numbers alone are allowed
    }


def params_of(stage):
    """Structure of the inputs and settings of a job, as functions of its wildcards, and the fingerprint of its code."""
    declared, job = DECLARED[stage], partial(planner.job, stage)
    code, caption = planner.code(declared) | SCRIPT, caption_of(declared)

    def texts(wildcards):
        """Digests of the files of the package that a job reads, by name."""
        inputs = (job(wildcards)["files"] | caption).values()
        return {f"stiction.{Path(file).name}": digest(file) for paths in inputs for file in package_files(paths)}

    return {
        "module": declared["module"],
        "stage": stage,
        "inputs": lambda wildcards: job(wildcards)["inputs"],
        "settings": lambda wildcards: job(wildcards)["settings"],
        "code": lambda wildcards: code | texts(wildcards),
    }


def define(stage):
    """Define the rule of a stage if it has files under this configuration. The rules of `chain.smk` are spelled out."""
    if stage not in DECLARED:
        return
    declared = DECLARED[stage]

    rule:
        name:
            stage
        input:
            unpack(inputs_of(stage)),
        output:
            **outputs_of(stage),
        log:
            declared["log"],
        wildcard_constraints:
            **declared["constraints"],
        priority: declared["priority"]
        localrule: not declared["cluster"]
        resources:
            **resources_of(stage),
        params:
            **params_of(stage),
        message:
            declared["message"]
        script:
            "../scripts/stage.py"
