"""Changes of Snakemake by this project, and questions to it, beyond its public interface.

Every use of a private part is one function here, which says what happens in a version of Snakemake without that part.
Changes save time only: another version remains as it is and is slower.
"""

import contextlib
import importlib
import inspect
import os
import subprocess
import sys
import tempfile
import threading
from functools import cache
from pathlib import Path
from typing import Any

from snakemake.logging import logger

from stiction.run.forkserver import Server

#: Variables in which Snakemake passes the number of threads and the folder of temporary files to a job.
THREADS = ("OMP_NUM", "GOTO_NUM", "OPENBLAS_NUM", "MKL_NUM", "VECLIB_MAXIMUM", "NUMEXPR_NUM")
FOLDERS = ("TMPDIR", "TMP", "TEMPDIR", "TEMP")


def _object(module, name):
    """Object of a module of Snakemake, ``None`` if this version has no such module or no such object."""
    with contextlib.suppress(ImportError):
        return getattr(importlib.import_module(f"snakemake.{module}"), name, None)


def environment(threads: int, folder: str) -> dict[str, str]:
    """Environment of a job as Snakemake sets it."""
    numbers = dict.fromkeys((f"{name}_THREADS" for name in THREADS), str(threads))
    return dict(os.environ) | numbers | dict.fromkeys(FOLDERS, folder)


def fork_jobs() -> bool:
    """Start Python scripts as forks of a server for the rest of this run, and return whether this is possible.

    The server imports all libraries and loads all kernels, which are compiled if necessary. A script that needs a
    container, an environment or threads of its own still starts as a new interpreter, like every script if forking is
    not possible; the reason is then printed.
    """
    script = _object("script", "PythonScript")
    start = getattr(script, "execute_script", None)
    if sys.platform != "linux":  # the libraries of macOS do not survive a fork
        return _without_forks("forks of loaded libraries are safe on Linux only")
    if start is None or list(inspect.signature(start).parameters) != ["self", "fname", "edit"]:
        return _without_forks("this version of Snakemake starts scripts in a way not known here")
    try:
        server = Server(environment(1, tempfile.gettempdir()))
    except ConnectionError as error:
        return _without_forks(str(error))

    def execute_script(job, fname, edit=False):
        """Run the script of a job as a fork, or as Snakemake does."""
        if _plain(job):
            try:
                return _run(server, fname)
            except BrokenPipeError:
                script.execute_script = start
                _without_forks("the server of jobs was stopped")
        return start(job, fname, edit)

    script.execute_script = execute_script
    return True


def _without_forks(reason):
    """Print why jobs do not start as forks."""
    logger.info(f"Each job starts an interpreter of its own, which takes longer: {reason}.")
    return False


def _run(server, script):
    """Run a script as a fork. Raises the errors of Snakemake."""
    if status := server.run(script):
        raise subprocess.CalledProcessError(status, f"{sys.executable} {script}")


#: Attributes of a script that Snakemake runs in other surroundings than those of the server, if they are set.
SPECIAL = ("container_img", "conda_env", "env_modules", "shadow_dir", "bench_record")


def _plain(script):
    """Whether Snakemake would start a script with the interpreter and the environment of the server.

    Not if Snakemake no longer says what this depends on. Variables that a library sets in this process when it is
    imported during the run, as netCDF4 does, are not those of the run.
    """
    if not {*SPECIAL, "threads", "resources"} <= set(dir(script)):
        return False
    folder = script.resources.get("tmpdir", tempfile.gettempdir())
    alike = (script.threads, folder) == (1, tempfile.gettempdir())
    special = [getattr(script, name) for name in SPECIAL]
    return alike and not any(special) and not script.resources.get("shell_exec")


def compare_without_pandas() -> None:
    """Let Snakemake compare parameters without pandas unless pandas is imported.

    Snakemake imports pandas to recognise its objects among the parameters of jobs; the import takes longer than the
    comparison of all parameters.
    """
    records = _object("persistence", "PersistenceBase")
    if not hasattr(records, "_serialize_param_builtin") or not hasattr(records, "_serialize_param_pandas"):
        return
    compared = records._serialize_param_pandas

    def serialize(record, value):
        """Text of a parameter, without pandas unless it is imported."""
        return compared(record, value) if "pandas" in sys.modules else record._serialize_param_builtin(value)

    records._serialize_param_pandas = serialize


def look_for_scripts_once() -> None:
    """Let Snakemake look for the script of a rule once, not for every job. An unknown way to look for it remains."""
    processor = _object("dag", "ScriptProcessor")
    look_for = getattr(processor, "process_job", None)
    if look_for is None or list(inspect.signature(look_for).parameters) != ["self", "job"]:
        return

    def process_job(self, job):
        """Look for the script of a rule, unless it was found for another job."""
        rule, present = job.rule.name, vars(self).setdefault("present", set())
        if rule not in present:
            look_for(self, job)
            if isinstance(job.rule.script, str) and "{" not in job.rule.script:  # otherwise it depends on the job
                present.add(rule)

    processor.process_job = process_job


def remember_signatures() -> None:
    """Let Snakemake read the signature of a function once, not nine times for every job. An unknown way remains."""
    inspected = _object("common", "get_function_params")
    if inspected is None or _object("rules", "get_function_params") is not inspected:
        return
    if list(inspect.signature(inspected).parameters) != ["func"]:
        return
    cached = cache(inspected)

    def get_function_params(func):
        """Names of the parameters of a function, from memory if it has a hash."""
        try:
            return cached(func)
        except TypeError:  # it has no hash
            return inspected(func)

    for module in ("common", "rules"):
        sys.modules[f"snakemake.{module}"].get_function_params = get_function_params


def list_messages(workflow: Any) -> None:
    """Let ``--list-rules`` show what each rule does. An unknown version lists names alone."""
    for rule in getattr(workflow, "rules", ()):
        if getattr(rule, "docstring", "") is None and isinstance(rule.message, str):
            rule.docstring = rule.message.replace("{wildcards.", "{")


def limit_timers(workflow: Any) -> None:
    """Let the scheduler of a run hold one timer at a time. An unknown scheduler keeps its timers, at some cost.

    Every pass of the scheduler starts a timer that starts another pass, and so does every job that ends: after n jobs,
    there are about n passes per second until the end of the run.
    """
    scheduler = getattr(workflow, "scheduler", None)
    if not {"_schedule_reevalutation", "_open_jobs"} <= set(dir(scheduler)):
        return
    waiting = threading.Lock()

    def reevaluate(delay):
        """Start a timer, unless one is waiting."""
        if waiting.acquire(blocking=False):
            timer = threading.Timer(delay, awake)
            timer.daemon = True  # otherwise Snakemake would wait for it at the end
            timer.start()

    def awake():
        """Wake the scheduler up."""
        waiting.release()
        scheduler._open_jobs.release()

    scheduler._schedule_reevalutation = reevaluate


def keep_to_allotted_cores(workflow: Any) -> None:
    """Let a group of jobs use only the cores allotted to it by SLURM. Snakemake would take all of the machine."""
    allotted, limits = os.environ.get("SLURM_CPUS_PER_TASK", ""), getattr(workflow, "global_resources", None)
    if allotted.isdecimal() and limits is not None:
        limits["_cores"] = int(allotted)


def is_main(workflow: Any) -> bool:
    """Whether this process plans the run, and is not started by Snakemake for a job with the option ``--mode``."""
    return getattr(workflow, "is_main_process", not {"subprocess", "remote"} & set(sys.argv))


def only_touches(workflow: Any) -> bool:
    """Whether a run computes nothing and marks its files as new, by the option ``--touch``.

    If Snakemake no longer says so, such a run is not refused.
    """
    return bool(getattr(workflow, "touch", False))


def files_of_configuration(workflow: Any) -> list[Path]:
    """Files of the configuration, each before the files overwritten by it.

    If Snakemake no longer names them there are none: then duplicate keys are not found, and paths of scans are relative
    to the working directory.
    """
    names = [*reversed(getattr(workflow, "overwrite_configfiles", ())), *getattr(workflow, "configfiles", ())]
    return list(dict.fromkeys(map(Path, names)))


def read_in_jobs(workflow: Any, file: Path) -> None:
    """Let jobs with their own interpreter read one file of the configuration in place of this run's files.

    If Snakemake no longer says where it keeps them, jobs read the files of this run.
    """
    settings = getattr(workflow, "config_settings", None)
    if hasattr(settings, "configfiles"):
        settings.configfiles = [file]
