"""Stiction of MEMS beams, from the statistics of two rough surfaces to the distribution of crack lengths."""

import atexit
import gc
import os
import signal
import sys
from pathlib import Path

BASE = Path(workflow.current_basedir)
# Jobs use the code of this checkout or installed package, because its fingerprint decides which of them rerun.
SOURCE = str(BASE / "src" if (BASE / "src").is_dir() else BASE.parents[1])
sys.path.insert(0, SOURCE)
PATHS = [SOURCE, *filter(None, dict(os.environ).get("PYTHONPATH", "").split(os.pathsep))]
os.environ.update(PYTHONPATH=os.pathsep.join(dict.fromkeys(PATHS)))

# Planning frees almost nothing. The garbage collector would cost a sixth of a plan, and as much again at exit.
gc.set_threshold(1_000_000)
atexit.register(gc.freeze)


configfile: str(BASE / "config.yaml")


include: "workflow/rules/common.smk"
# The paper, from surfaces to crack lengths. All other rules read results of these eight.
include: "workflow/rules/chain.smk"
include: "workflow/rules/surfaces.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/laws.smk"
include: "workflow/rules/beams.smk"
include: "workflow/rules/devices.smk"
include: "workflow/rules/process.smk"
include: "workflow/rules/report.smk"


if is_main:
    remember_code.save()


FRONT = Path(".snakemake/front.rst")  # front page of the report, written by the command stiction report
if FRONT.exists():

    report: str(FRONT.absolute())


rule tables:
    input:
        planner.files_of("tables"),
    localrule: True
    message:
        "All tables."


rule figures:
    input:
        planner.files_of("figures"),
    localrule: True
    message:
        "All figures."


rule study_figures:
    input:
        planner.files_of("study_figures"),
    localrule: True
    message:
        "Figures and tables of the studies."


rule model_error:
    input:
        planner.files_of("model_error"),
    localrule: True
    message:
        "Error of the model of the contact: Table III under full elastic contact."


rule asperities:
    input:
        planner.files_of("asperities"),
    localrule: True
    message:
        "Table III under several readings of an asperity."


rule pressing:
    input:
        planner.files_of("pressing"),
    localrule: True
    message:
        "Adhesion after surfaces were pressed together."


rule devices:
    input:
        planner.files_of("devices"),
    localrule: True
    message:
        "Tables, figures and pages of the devices."


rule measured:
    input:
        planner.files_of("measured"),
    localrule: True
    message:
        "Sheets and tables of the measured surfaces."


rule scans:
    input:
        planner.files_of("scans"),
    localrule: True
    message:
        "Sheets and statistics of scans, without the pairs of their surfaces."


LOCKS = []  # open file with the lock on the folder of this run


onstart:
    # Stop as Ctrl-C does. Snakemake's handler acquires a lock, and deadlocks if this thread already holds it.
    interrupt = signal.getsignal(signal.SIGINT)
    signal.signal(signal.SIGTERM, interrupt if callable(interrupt) else signal.default_int_handler)
    try:
        LOCKS.append(run_lock.reserve(".snakemake/running"))
        refuse_what_samples_show()
        refuse_to_touch()
        provenance.record("results/provenance.json", BASE, config)
        hand_to_jobs()
    except (OSError, DataError) as error:
        reason = error.__cause__ or error
        raise WorkflowError(f"results/ cannot be used: {reason}. Make it writable or choose another --directory.")
    except (RuntimeError, ValueError) as error:
        raise WorkflowError(str(error))
    snakemake_patches.limit_timers(workflow)
    # Compile and cache kernels before jobs run in parallel, because two jobs could corrupt a shared entry of the cache.
    # The server that forks jobs does this itself.
    if not snakemake_patches.fork_jobs():
        shell("{sys.executable:q} -m stiction.run.warmup")


onsuccess:
    end_of_run()


rule all:
    default_target: True
    input:
        map(planner.files_of, ALL_TARGETS),
    localrule: True
    message:
        "Tables, figures, checks and pages of devices."


snakemake_patches.list_messages(workflow)
