"""Stiction of MEMS beams, from the statistics of two rough surfaces to the distribution of crack lengths."""

import os
import signal
import sys
import threading
from pathlib import Path

BASE = Path(workflow.basedir)
# The code that runs is the code beside this file, whose fingerprint decides what reruns.
sys.path.insert(0, str(BASE / "src"))
os.environ.update(PYTHONPATH=str(BASE / "src"))


configfile: str(BASE / "config.yaml")


# Used only with --software-deployment-method apptainer; see workflow/stiction.def.
container: "stiction.sif"


include: "workflow/rules/common.smk"
include: "workflow/rules/common_studies.smk"
include: "workflow/rules/surfaces.smk"
include: "workflow/rules/contact.smk"
include: "workflow/rules/laws.smk"
include: "workflow/rules/beams.smk"
include: "workflow/rules/studies.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/checks.smk"
include: "workflow/rules/figures_studies.smk"
include: "workflow/rules/figures.smk"


onstart:
    # Snakemake's answer to SIGTERM needs a lock, for which it would wait for ever if this thread holds it already.
    if callable(answer := signal.getsignal(signal.SIGTERM)):
        signal.signal(signal.SIGTERM, lambda *received: threading.Thread(target=answer, args=received).start())
    reserve_folder()
    try:
        provenance.record("results/provenance.json", BASE, config)
    except OSError as error:
        raise WorkflowError(f"results/ cannot be used: {error}. Make it writable or choose another --directory.")
    except ValueError as error:
        raise WorkflowError(str(error))
    # Compiled code is cached before jobs fan out: two jobs that write one cache entry at once could mix it up.
    shell("{sys.executable:q} -m stiction.run.warmup")


# Seconds of work each, that do not wait in the queue of a cluster.
localrules:
    all,
    heights,
    spectrum,
    contact,
    forces,
    chaos,
    fit,
    humidity,
    sensitivity,
    sample_sizes,
    mesh,
    correlation,
    tables,
    table_1,
    table_2,
    table_3,
    fit_quality,
    table_sensitivity,
    table_readings,
    table_resampling,
    checks,
    verdict,
    study_figures,
    figures,
    figure_05,
    figure_07,
    figure_08,
    figure_09,
    figure_10,
    figure_11,
    figure_11_supplement,
    figure_12,
    figure_13,
    figure_14,
    figure_15,
    figure_16,
    figure_17,
    figure_18,
    figure_19,
    figure_readings,


rule all:
    default_target: True
    input:
        rules.tables.input,
        rules.figures.input,
        rules.verdict.output,
    message:
        "The paper's tables and figures."
