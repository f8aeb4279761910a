"""Snakemake with the changes of a plan and a run: the same jobs, the same messages, one look, one timer."""

import importlib
import inspect
import json
import os
import re
import subprocess
import sys
import threading
from types import SimpleNamespace

import pandas
import pytest
import snakemake.api
from snakemake import common, dag, persistence, rules
from snakemake.persistence.file import FilePersistence
from snakemake.scheduling.job_scheduler import JobScheduler
from snakemake.script import PythonScript
from test_forkserver import BARE

from stiction.run import forkserver, snakemake_patches

ROOT = forkserver.Path(__file__).parents[2]
SNAKEFILE = """
import os, sys
from stiction.run import forkserver, snakemake_patches

forkserver.COMMAND = [sys.executable, "-P", "-c", {bare!r}]

onstart:
    if config["changed"]:
        snakemake_patches.limit_timers(workflow)
        print("forked:", snakemake_patches.fork_jobs(), flush=True)

onerror:
    print("timers limited:", "_schedule_reevalutation" in vars(workflow.scheduler), flush=True)

rule all:
    input:
        expand("{{name}}.json", name=["plain", "threads"]),
        expand("{{way}}.failed", way=["message", "error", "signal"]),

rule plain:
    input: "Snakefile"
    output: "plain.json"
    params: settings=dict(number=1.5, text="words")
    log: "plain.log"
    resources: mem_mb=17
    script: "dump.py"

rule threads:
    output: "threads.json"
    threads: 2
    script: "dump.py"

rule fails:  # one after the other, so that their messages do not mix
    output: "{{way}}.failed"
    resources: terminal=1
    script: "fail.py"
"""
DUMP = """
import json, os, sys
job = {name: repr(getattr(snakemake, name)) for name in
       ("input", "output", "params", "wildcards", "threads", "resources", "log", "config", "rule", "scriptdir")}
found = {"job": job, "environment": dict(os.environ), "folder": os.getcwd(), "path": sys.path, "file": __file__}
json.dump(found | {"parent": os.getppid()}, open(snakemake.output[0], "w"), sort_keys=True)
"""
FAIL = """
import os, sys, time
way = snakemake.wildcards.way
open(snakemake.output[0], "w").write("half")
if way == "message":
    sys.exit("DataError: a sentence")
if way == "signal":
    os.kill(os.getpid(), 9)
raise ValueError(way)
"""


def ran(folder, changed):
    """Standard output of a run of a small workflow, with or without the changes to Snakemake."""
    folder.mkdir(exist_ok=True)
    for name, text in (("Snakefile", SNAKEFILE.format(bare=BARE)), ("dump.py", DUMP), ("fail.py", FAIL)):
        (folder / name).write_text(text)
    words = [sys.executable, "-m", "snakemake", "--cores", "2", "--resources", "terminal=1", "--keep-going"]
    words += ["--config", f"changed={int(changed)}"]
    words += ["--scheduler", "greedy"]  # the other one prints an error if it takes too long on a busy machine
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(
        words, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    assert done.returncode == 1, done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """Results and output of the same workflow, in the same folder, without and with the changes."""
    folder = tmp_path_factory.mktemp("workflow")
    found = []
    for changed in (False, True):
        output = ran(folder, changed)
        found.append(
            (output, {name: json.loads((folder / f"{name}.json").read_text()) for name in ("plain", "threads")})
        )
        assert not list(folder.glob("*.failed")), "Snakemake must remove the outputs of failed jobs"
        for path in folder.glob("*.json"):
            path.unlink()
    return found


#: Variables set by the shell through which Snakemake starts an interpreter, and what differs between the two runs.
DIFFERENT = {"SHLVL", "PWD", "OLDPWD", "_", "config", "parent"}


def surroundings(found):
    """What jobs found, without ``DIFFERENT``."""
    if isinstance(found, list):
        return [re.sub("cache/tmp[a-z0-9_]+/", "cache/", path) for path in found]  # of this run
    if not isinstance(found, dict):
        return found
    return {key: surroundings(value) for key, value in found.items() if key not in DIFFERENT}


def test_a_forked_job_gets_what_a_job_in_a_new_interpreter_gets(both):
    (_, slow), (output, forked) = both
    assert "forked: True" in output
    assert surroundings(forked) == surroundings(slow)


def test_a_job_with_several_threads_starts_as_a_new_interpreter(both):
    _, (_, forked) = both
    assert forked["plain"]["environment"]["OMP_NUM_THREADS"] == "1"
    assert forked["threads"]["environment"]["OMP_NUM_THREADS"] == "2"
    assert forked["plain"]["parent"] != forked["threads"]["parent"]


def messages(output):
    """Printed lines about failed jobs, without numbers, times, paths and commands, apart where jobs write into them."""
    output = re.sub("(DataError: a sentence|Error in rule fails:)", r"\n\1\n", output)
    lines = [line for line in output.splitlines() if re.search("Error|failed|exit status|signal|Removing", line)]
    lines = [re.sub(r"Command '.*?'|Command \[.*?\]", "Command", line) for line in lines]
    return sorted(re.sub(r"jobid: \d+|tmp\w+|\d+ of|line \d+|-?\d+|died with.*|returned.*", "", line) for line in lines)


def test_a_failed_job_is_reported_as_without_the_changes(both):
    (slow, _), (forked, _) = both
    assert messages(forked) == messages(slow)
    assert "DataError: a sentence" in forked
    assert forked.count("Traceback") == slow.count("Traceback")


def test_the_scheduler_of_this_version_of_snakemake_is_changed(both):
    (slow, _), (forked, _) = both
    assert "timers limited: True" in forked
    assert "timers limited: False" in slow


class Timer(threading.Timer):
    """Timer that ends when it is told to."""

    def start(self):
        started.append(self)


started = []


@pytest.fixture
def timers(monkeypatch):
    """Timers that were started."""
    started.clear()
    monkeypatch.setattr(threading, "Timer", Timer)
    return started


def scheduler():
    """The parts of a scheduler that timers use, with the method of Snakemake."""
    found = SimpleNamespace(_open_jobs=threading.Semaphore(0))
    found._schedule_reevalutation = JobScheduler._schedule_reevalutation.__get__(found)
    return found


@pytest.mark.parametrize(("changed", "number"), [(True, 1), (False, 20)])
def test_a_scheduler_is_woken_once_per_timer(timers, changed, number):
    found = scheduler()
    if changed:
        snakemake_patches.limit_timers(SimpleNamespace(scheduler=found))
    for _ in range(20):
        found._schedule_reevalutation(0.2)
    assert [timer.interval for timer in timers] == [0.2] * number
    assert all(timer.daemon == changed for timer in timers), "Snakemake waits for timers at its end"
    for timer in timers:
        timer.function(*timer.args)
    assert [found._open_jobs.acquire(blocking=False) for _ in range(21)].count(True) == number
    found._schedule_reevalutation(0.2)
    assert len(timers) == number + 1, "a timer must follow the one that has ended"


VALUES = (1, -0.5, True, None, "text", [1, "two"], {"b": 2, "a": {1}}, (1,), object(), ROOT)


def test_parameters_compare_the_same_without_the_import_of_pandas(monkeypatch):
    records = persistence.PersistenceBase
    known = records._serialize_param_pandas
    monkeypatch.setattr(records, "_serialize_param_pandas", known)
    snakemake_patches.compare_without_pandas()
    record = object.__new__(FilePersistence)
    frame = pandas.DataFrame({"column": [1, 2]})
    assert record._serialize_param_pandas(frame) == known(record, frame)
    expected = [known(record, value) for value in VALUES]
    monkeypatch.delitem(sys.modules, "pandas")
    assert [record._serialize_param_pandas(value) for value in VALUES] == expected
    assert "pandas" not in sys.modules


class Unhashable:
    """Input function without a hash."""

    __hash__ = None

    def __call__(self, wildcards, input):
        """Nothing."""


@pytest.fixture
def signatures(monkeypatch):
    """Functions whose signatures Snakemake has read since the change."""
    inspected, known = [], common.get_function_params

    def get_function_params(func):
        inspected.append(func)
        return known(func)

    for module in (common, rules):
        monkeypatch.setattr(module, "get_function_params", get_function_params)
    snakemake_patches.remember_signatures()
    return inspected


def test_a_signature_is_read_once(signatures):
    def of_attempt(wildcards, attempt):
        """Nothing."""

    unhashable, candidates = Unhashable(), {"input": 1, "attempt": 2, "threads": 3}
    for _ in range(3):
        assert list(rules.get_function_params(of_attempt)) == ["wildcards", "attempt"]
        assert common.get_input_function_aux_params(of_attempt, candidates) == {"attempt": 2}
        assert common.get_input_function_aux_params(unhashable, candidates) == {"input": 1}
    assert signatures == [of_attempt, unhashable, unhashable, unhashable]


class Rule:
    """Rule with a script."""

    def __init__(self, script, name="stage"):
        self.script, self.name = script, name


@pytest.mark.parametrize(("script", "number"), [("a.py", 1), ("{wildcards.name}.py", 3), (ROOT / "a.py", 3), (None, 3)])
def test_a_script_is_looked_for_once_unless_its_name_depends_on_the_job(monkeypatch, script, number):
    looked_for = []

    def process_job(self, job):
        looked_for.append(job)
        assert isinstance(self, dag.ScriptProcessor)

    monkeypatch.setattr(dag.ScriptProcessor, "process_job", process_job)
    snakemake_patches.look_for_scripts_once()
    for _ in range(2):  # what one plan has found, another looks for again
        looked_for.clear()
        processor = dag.ScriptProcessor(None)
        others = Rule("other.py", "first"), Rule("other.py", "second")
        jobs = [SimpleNamespace(rule=rule) for rule in [*3 * [Rule(script)], *others]]
        for job in jobs:
            processor.process_job(job)
        assert looked_for == [*jobs[:number], *jobs[-2:]]


@pytest.mark.parametrize("module", ["common", "dag", "persistence", "rules", "script"])
def test_a_snakemake_without_a_private_module_remains_as_it_is(monkeypatch, module):
    private = common, rules, dag.ScriptProcessor, persistence.PersistenceBase, PythonScript
    for known in private:  # restored after the test
        for name in ("get_function_params", "process_job", "_serialize_param_pandas", "execute_script"):
            if hasattr(known, name):
                monkeypatch.setattr(known, name, getattr(known, name))
    before = dict(vars(sys.modules[f"snakemake.{module}"]))
    hidden = sys.modules[f"snakemake.{module}"]
    monkeypatch.setitem(sys.modules, f"snakemake.{module}", None)
    monkeypatch.delitem(sys.modules, "stiction.run.snakemake_patches")
    monkeypatch.setattr("stiction.run.snakemake_patches", snakemake_patches)
    patches = importlib.import_module("stiction.run.snakemake_patches")
    patches.compare_without_pandas()
    patches.look_for_scripts_once()
    patches.remember_signatures()
    assert dict(vars(hidden)) == before
    if module == "script":
        assert not patches.fork_jobs()


@pytest.fixture
def untouched(monkeypatch):
    """Snakemake's way to start a script, to which it is restored."""
    monkeypatch.setattr(PythonScript, "execute_script", PythonScript.execute_script)
    monkeypatch.setattr(forkserver, "COMMAND", [sys.executable, "-c", "raise SystemExit(1)"])
    return PythonScript.execute_script


def another(self, fname, debug):
    """A way to start scripts that is not known."""


def test_jobs_start_as_before_if_the_server_does_not_start_or_forks_are_not_safe(untouched, monkeypatch):
    assert not snakemake_patches.fork_jobs()
    monkeypatch.setattr(forkserver, "COMMAND", [sys.executable, "-P", "-c", BARE])
    monkeypatch.setattr(snakemake_patches.sys, "platform", "darwin")
    assert not snakemake_patches.fork_jobs()
    assert PythonScript.execute_script is untouched


def test_jobs_start_as_before_if_snakemake_starts_them_in_an_unknown_way(monkeypatch):
    monkeypatch.setattr(PythonScript, "execute_script", another)
    assert not snakemake_patches.fork_jobs()
    assert PythonScript.execute_script is another


class Stopped:
    """Server that has ended."""

    def __init__(self, environment):
        self.environment = environment

    def run(self, _script):
        raise BrokenPipeError


def test_jobs_start_as_before_once_the_server_has_ended(monkeypatch):
    def execute_script(self, fname, edit=False):
        started.append((self, fname, edit))

    started, job = [], SimpleNamespace(**PLAIN, threads=1, resources={})
    monkeypatch.setattr(PythonScript, "execute_script", execute_script)
    monkeypatch.setattr(snakemake_patches, "Server", Stopped)
    assert snakemake_patches.fork_jobs()
    PythonScript.execute_script(job, "job.py")
    assert started == [(job, "job.py", False)]
    assert PythonScript.execute_script is execute_script  # the server is not tried again


PLAIN = {"container_img": None, "conda_env": None, "env_modules": None, "shadow_dir": None, "bench_record": None}
SPECIAL = [{name: "set"} for name in PLAIN]
SPECIAL += [{"threads": 2}, {"resources": {"tmpdir": "/elsewhere"}}, {"resources": {"shell_exec": "zsh"}}]


def test_only_scripts_with_the_surroundings_of_the_server_are_forked():
    folder = snakemake_patches.tempfile.gettempdir()
    plain = PLAIN | {"threads": 1, "resources": {"tmpdir": folder}}
    assert snakemake_patches._plain(SimpleNamespace(**plain))
    for special in SPECIAL:
        assert not snakemake_patches._plain(SimpleNamespace(**plain | special)), special
    for name in plain:  # about which Snakemake may no longer tell
        without = {other: value for other, value in plain.items() if other != name}
        assert not snakemake_patches._plain(SimpleNamespace(**without)), name


class Running:
    """Server that runs all scripts."""

    def __init__(self, environment):
        self.environment = environment

    def run(self, script):
        return RAN.append(script)


RAN = []


def test_jobs_are_forked_although_a_library_sets_a_variable_during_the_run(monkeypatch):
    monkeypatch.setattr(PythonScript, "execute_script", lambda self, fname, edit=False: pytest.fail("a new process"))
    monkeypatch.setattr(snakemake_patches, "Server", Running)
    assert snakemake_patches.fork_jobs()
    monkeypatch.setenv("SET_BY_A_LIBRARY", "1")
    PythonScript.execute_script(SimpleNamespace(**PLAIN, threads=1, resources={}), "job.py")
    assert RAN == ["job.py"]


def test_a_server_starts_without_a_module_that_a_library_no_longer_has(monkeypatch):
    names = []

    def imported(name):
        names.append(name)
        if name == "snakemake.iocontainers":
            raise ModuleNotFoundError(name)
        return SimpleNamespace(main=lambda: None, preload=lambda: None)

    monkeypatch.setattr(forkserver.importlib, "import_module", imported)
    forkserver.preload()
    assert set(forkserver.LATE) <= set(names)


class Workflow:
    """What is asked of the workflow of Snakemake, of which any part may be missing."""

    def __init__(self, **parts):
        vars(self).update(parts)


def test_this_version_of_snakemake_has_all_that_is_asked_of_it():
    parts = {"is_main_process", "local_exec", "overwrite_configfiles", "rules", "scheduler"}
    assert parts <= set(dir(snakemake.workflow.Workflow))
    assert "self.configfiles = " in inspect.getsource(snakemake.workflow)
    assert "self.forcefiles = set()" in inspect.getsource(snakemake.dag)


@pytest.mark.parametrize(
    ("words", "main"), [([], True), (["--mode", "subprocess"], False), (["--mode", "remote"], False)]
)
def test_the_main_process_is_known_by_snakemake_or_by_its_arguments(monkeypatch, words, main):
    monkeypatch.setattr(sys, "argv", ["snakemake", *words])
    assert snakemake_patches.is_main(Workflow()) == main
    assert snakemake_patches.is_main(Workflow(is_main_process=not main)) != main


def test_files_of_the_configuration_come_before_those_that_they_overwrite():
    files = ["first.yaml", "second.yaml"]
    found = snakemake_patches.files_of_configuration(
        Workflow(overwrite_configfiles=files, configfiles=[*files, "config.yaml"])
    )
    assert [path.name for path in found] == ["second.yaml", "first.yaml", "config.yaml"]


def test_a_job_uses_no_more_cores_than_slurm_allots(monkeypatch):
    for allotted, cores in (("1", 1), ("12", 12), ("", 64)):
        monkeypatch.setenv("SLURM_CPUS_PER_TASK", allotted)
        limited = Workflow(global_resources={"_cores": 64})
        snakemake_patches.keep_to_allotted_cores(limited)
        assert limited.global_resources == {"_cores": cores}


def test_a_workflow_that_says_nothing_runs_without_changes(monkeypatch):
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", "1")
    snakemake_patches.keep_to_allotted_cores(Workflow())
    assert snakemake_patches.files_of_configuration(Workflow()) == []
    silent = Workflow()
    snakemake_patches.read_in_jobs(silent, forkserver.Path("configuration.json"))
    assert not vars(silent)
    unknown = Workflow(_open_jobs=threading.Semaphore(0))
    snakemake_patches.limit_timers(Workflow(scheduler=unknown))
    snakemake_patches.limit_timers(Workflow())
    assert not hasattr(unknown, "_schedule_reevalutation")
