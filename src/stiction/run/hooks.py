"""Changes of Snakemake during a plan and a run, to save time: look-ups, starts of jobs, timers, an import.

Each change replaces a method that is not part of Snakemake's public interface. A version of Snakemake that has another
method in its place remains as it is.
"""

import inspect
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Hashable
from functools import cache
from typing import Any

import snakemake.api  # first, because its imports are circular
from snakemake import common, persistence, rules
from snakemake.logging import logger
from snakemake.script import PythonScript

from stiction.run.forkserver import Server

#: Variables in which Snakemake passes the number of threads and the folder of temporary files to a job.
THREADS = ("OMP_NUM", "GOTO_NUM", "OPENBLAS_NUM", "MKL_NUM", "VECLIB_MAXIMUM", "NUMEXPR_NUM")
FOLDERS = ("TMPDIR", "TMP", "TEMPDIR", "TEMP")


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
    start = PythonScript.execute_script
    if sys.platform != "linux":  # the libraries of macOS do not survive a fork
        return _refused("forks of loaded libraries are safe on Linux only")
    if list(inspect.signature(start).parameters) != ["self", "fname", "edit"]:
        return _refused("this version of Snakemake starts scripts in a way not known here")
    try:
        server = Server(environment(1, tempfile.gettempdir()))
    except ConnectionError as error:
        return _refused(str(error))

    def execute_script(script, fname, edit=False):
        if _plain(script, server):
            try:
                return _run(server, fname)
            except BrokenPipeError:
                PythonScript.execute_script = start
                _refused("the server of jobs was stopped")
        return start(script, fname, edit)

    PythonScript.execute_script = execute_script
    return True


def _refused(reason):
    """Print why jobs do not start as forks."""
    logger.info(f"Each job starts an interpreter of its own, which takes longer: {reason}.")
    return False


def _run(server, script):
    """Run a script as a fork; raises the errors of Snakemake."""
    if status := server.run(script):
        raise subprocess.CalledProcessError(status, f"{sys.executable} {script}")


def _plain(script, server):
    """Whether Snakemake would start a script with the interpreter and the environment of the server."""
    special = (script.container_img, script.conda_env, script.env_modules, script.shadow_dir, script.bench_record)
    folder = script.resources.get("tmpdir", tempfile.gettempdir())
    alike = environment(script.threads, folder) == server.environment
    return alike and not any(special) and not script.resources.get("shell_exec")


def compare_without_pandas() -> None:
    """Let Snakemake compare parameters without pandas where pandas is not imported.

    Snakemake imports pandas to recognise its objects among the parameters of jobs; the import takes longer than the
    comparison of all parameters.
    """
    records = getattr(persistence, "PersistenceBase", None)
    if not hasattr(records, "_serialize_param_builtin") or not hasattr(records, "_serialize_param_pandas"):
        return
    compared = records._serialize_param_pandas

    def serialize(record, value):
        return compared(record, value) if "pandas" in sys.modules else record._serialize_param_builtin(value)

    records._serialize_param_pandas = serialize


def remember_signatures() -> None:
    """Let Snakemake read the signature of an input function once.

    It reads about nine signatures for each planned job, most of them of the same functions.
    """
    read = getattr(common, "get_function_params", None)
    if read is None or getattr(rules, "get_function_params", None) is not read:
        return
    if list(inspect.signature(read).parameters) != ["func"]:
        return
    known = cache(read)

    def get_function_params(func):
        return known(func) if isinstance(func, Hashable) else read(func)

    common.get_function_params = rules.get_function_params = get_function_params


def check_scripts_once() -> None:
    """Let Snakemake look for the script of a rule once, not for each planned job.

    A script is looked for once per job if its name depends on the job.
    """
    processor = getattr(snakemake.dag, "ScriptProcessor", None)
    check = getattr(processor, "process_job", None)
    if check is None or list(inspect.signature(check).parameters) != ["self", "job"]:
        return

    def process_job(self, job):
        script = job.rule.script
        of_rule = isinstance(script, str) and "{" not in script
        found = vars(self).setdefault("_found", set())
        if not (of_rule and job.rule in found):
            check(self, job)
            found.add(job.rule)

    processor.process_job = process_job


def limit_timers(scheduler: Any) -> None:
    """Let a scheduler of Snakemake hold one timer at a time.

    Every pass of the scheduler starts a timer that starts another pass, and so does every job that ends: after n jobs,
    there are about n passes per second until the end of the run.
    """
    if not {"_schedule_reevalutation", "_open_jobs"} <= set(dir(scheduler)):
        return
    waiting = threading.Lock()

    def reevaluate(delay):
        if waiting.acquire(blocking=False):
            timer = threading.Timer(delay, awake)
            timer.daemon = True  # otherwise Snakemake would wait for it at the end
            timer.start()

    def awake():
        waiting.release()
        scheduler._open_jobs.release()

    scheduler._schedule_reevalutation = reevaluate
