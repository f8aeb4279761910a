"""The workflow on a real SLURM cluster, which runs on this machine only, as any user, in a temporary folder.

Requires the daemons (apt-get install slurmctld slurmd slurm-client munge) and the plugin (pip install stiction[slurm]).
"""

import base64
import importlib.util
import os
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, SMOKE, datasets, snakemake

pytestmark = pytest.mark.cluster

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel")
PATH = os.pathsep.join([os.environ["PATH"], "/usr/sbin"])
#: Longest wait for a daemon, a job or a run [s].
PATIENCE = 120

#: Smallest configuration that runs every stage of the main line.
TINY = """
pairs:
  b: {humidities: [0.67]}
contact: {samples: 12, chunks: 4}
chaos: {order: 1}
beam: {samples: 4}
"""
TARGETS = ("results/beams/b_rh067_NG.nc", "results/beams/b_rh067_GEO.nc")

CONF = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
MinJobAge=86400
ReturnToService=2
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=16000
PartitionName=main Nodes={host} Default=YES MaxTime=600 State=UP
"""


def wait_for(condition, what):
    """Poll a condition and return its first true value."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.2)
    pytest.fail(f"waited {PATIENCE} s for {what}")


def free_ports(number):
    """Unused ports of this machine."""
    sockets = [socket.socket() for _ in range(number)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Cluster:
    """Running SLURM cluster; commands find it through their environment."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, []
        host = socket.gethostname().split(".")[0]
        user = subprocess.check_output(["id", "-un"], text=True).strip()
        conf = folder / "slurm.conf"
        conf.write_text(CONF.format(folder=folder, host=host, user=user, ports=free_ports(2)))
        for name in ("state", "spool", "bin"):
            (folder / name).mkdir()
        # The plugin that runs inside a job removes SLURM_CONF from the environment.
        srun = folder / "bin" / "srun"
        srun.write_text(f'#!/bin/sh\nSLURM_CONF={conf} exec {shutil.which("srun", path=PATH)} "$@"\n')
        srun.chmod(0o755)
        inherited = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST", "SLURM"))}
        self.environment = inherited | {"SLURM_CONF": str(conf), "PATH": f"{srun.parent}{os.pathsep}{PATH}"}

    def rise(self):
        """Start the daemons and wait until a node is idle."""
        key = self.folder / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o600)
        files = {
            "key": key.name,
            "socket": "munge.socket",
            "pid": "munge.pid",
            "log": "munge.log",
            "seed": "munge.seed",
        }
        names = {"socket": "--socket", "seed": "--seed-file"}
        arguments = [f"{names.get(what, f'--{what}-file')}={self.folder / file}" for what, file in files.items()]
        try:
            # --force, because munged requires a folder that other users can access, and pytest's folders are private.
            self.start("munged", "--foreground", "--force", *arguments)
            self.wait_for((self.folder / "munge.socket").exists, "munged")
            self.start("slurmctld", "-D", "-c", "-f", self.folder / "slurm.conf")
            self.start("slurmd", "-D", "-f", self.folder / "slurm.conf")
            self.wait_for(lambda: "idle" in self.command("sinfo", "-h", "-o", "%T"), "a node that is idle")
        except BaseException:
            self.fall()
            raise

    def fall(self):
        """Cancel all jobs and stop the daemons."""
        self.cancel(*(job for job, *_ in self.jobs()))
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def start(self, program, *arguments):
        """Start a daemon that runs until `fall` stops it."""
        with (self.folder / f"{program}.out").open("w") as out:
            self.daemons.append(
                subprocess.Popen(
                    [shutil.which(program, path=PATH), *map(str, arguments)],
                    env=self.environment,
                    cwd=self.folder,
                    stdin=subprocess.DEVNULL,
                    stdout=out,
                    stderr=subprocess.STDOUT,
                )
            )

    def wait_for(self, condition, what):
        """Wait for a condition while all daemons are running."""

        def asked():
            for daemon in self.daemons:
                if daemon.poll() is not None:
                    out = self.folder / f"{Path(daemon.args[0]).name}.out"
                    pytest.fail(f"{daemon.args[0]} ended with {daemon.returncode}:\n{out.read_text()[-3000:]}")
            return condition()

        return wait_for(asked, what)

    def command(self, *command):
        """Output of a SLURM command."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=PATIENCE).stdout

    def jobs(self, states="PENDING,RUNNING,COMPLETING"):
        """Number, state and rule of each job."""
        lines = self.command("squeue", "-h", "-t", states, "-o", "%i|%T|%k").splitlines()
        return [tuple(line.split("|")) for line in lines]

    def cancel(self, *jobs):
        if jobs:
            self.command("scancel", *jobs)

    def snakemake(self, directory, configs, *arguments, targets=TARGETS, rules="Snakefile"):
        """Start Snakemake on the cluster, in a process group of its own."""
        command = [sys.executable, "-m", "snakemake", "--snakefile", ROOT / rules, "--directory", directory]
        command += ["--workflow-profile", ROOT / "profiles" / "slurm", "--latency-wait", 5, "--jobs", 4]
        command += ["--slurm-status-command", "squeue", "--slurm-init-seconds-before-status-checks", 2]
        command += ["--default-resources", "slurm_partition=main", "mem_mb=500", "runtime=10", *arguments]
        command += ["--configfile", ROOT / "config.yaml", *configs] if configs else []
        command += ["--", *targets]
        with (directory / "run.log").open("a") as log:
            return subprocess.Popen(
                list(map(str, command)),
                cwd=ROOT,
                env=self.environment,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    if missing := [program for program in PROGRAMS if not shutil.which(program, path=PATH)]:
        pytest.skip(f"SLURM is not installed: no {', '.join(missing)}")
    if not importlib.util.find_spec("snakemake_executor_plugin_slurm"):
        pytest.skip("the SLURM plugin is not installed: pip install -c requirements.lock stiction[slurm]")
    cluster = Cluster(tmp_path_factory.mktemp("slurm"))
    try:
        cluster.rise()
    except pytest.fail.Exception as reason:  # a problem of the machine, not of the project
        pytest.skip(f"SLURM does not start on this machine: {reason}")
    yield cluster
    cluster.fall()


@pytest.fixture(scope="module")
def configs(tmp_path_factory):
    path = tmp_path_factory.mktemp("overlay") / "tiny.yaml"
    path.write_text(TINY)
    return SMOKE, path


@pytest.fixture(scope="module")
def local(tmp_path_factory, configs):
    """Datasets of an undisturbed run on this machine: name to content."""
    folder = tmp_path_factory.mktemp("local")
    snakemake(folder, *TARGETS, configs=configs)
    return datasets(folder)


def finished(run, folder, patience=2 * PATIENCE):
    """Wait for the end of a run, which must succeed, and return its log."""
    try:
        status = run.wait(patience)
    except subprocess.TimeoutExpired:
        os.killpg(run.pid, signal.SIGKILL)
        status = "no end"
    log = (folder / "run.log").read_text()
    assert status == 0, f"snakemake ended with {status}:\n{log[-6000:]}"
    return log


def test_points_of_the_estimate_are_jobs_of_a_cluster(cluster, tmp_path):
    (tmp_path / "control.json").write_text("{}")
    run = cluster.snakemake(tmp_path, [], targets=["bridges/control/0000"], rules="workflow/surrogate.smk")
    finished(run, tmp_path)
    assert [job[-1] for job in cluster.jobs("COMPLETED") if "points" in job[-1]] != []
    with np.load(tmp_path / "bridges/control/0000/0000.npz") as bridges:
        assert np.isfinite(bridges["lengths"]).all()


@pytest.mark.parametrize("target", ["table_3", pytest.param("all", marks=pytest.mark.nightly)])
def test_the_smoke_run_on_a_cluster_gives_the_bytes_of_a_local_run_even_if_a_job_is_cancelled(
    cluster, smoke, tmp_path, target
):
    run = cluster.snakemake(tmp_path, [SMOKE], targets=[target])
    cancelled = wait_for(lambda: [job for job, *_ in cluster.jobs("RUNNING")], "a job")[0]
    cluster.cancel(cancelled)
    log = finished(run, tmp_path, 8 * PATIENCE)
    assert cancelled in [job for job, *_ in cluster.jobs("CANCELLED")]
    assert "Trying to restart job" in log
    ran = [rule for *_, rule in cluster.jobs("COMPLETED")]
    assert any("contact_chunk" in rule for rule in ran), "the chunks must have run on the cluster"
    assert sum("beams" in rule for rule in ran) == 1, "all beams are a group, which is submitted as one job"
    found, expected = datasets(tmp_path), datasets(smoke)
    assert found == {name: expected[name] for name in found}
    assert len(found) == len(expected) if target == "all" else len(found) > 10


def test_nothing_is_lost_when_snakemake_is_killed_and_started_again(cluster, configs, local, tmp_path):
    gathered = tmp_path / "results" / "contact" / "b_NG.nc"
    run = cluster.snakemake(tmp_path, configs)
    # A job has finished when its temporary inputs are removed.
    wait_for(
        lambda: gathered.exists() and not any((gathered.parent / "b_NG").glob("*.nc")), "the contact of all samples"
    )
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    cluster.cancel(*(job for job, *_ in cluster.jobs()))
    wait_for(lambda: not cluster.jobs(), "the end of all jobs")
    # Only the jobs in progress may be lost by the kill: Snakemake marks their files, some of which may be whole.
    marks = (tmp_path / ".snakemake" / "incomplete").iterdir()
    in_progress = {tmp_path / base64.urlsafe_b64decode(mark.name).decode() for mark in marks}
    before = {path: path.stat().st_mtime_ns for path in set(tmp_path.rglob("results/**/*.nc")) - in_progress}
    assert gathered in before
    finished(cluster.snakemake(tmp_path, configs, "--unlock"), tmp_path)
    log = finished(cluster.snakemake(tmp_path, configs), tmp_path)
    assert "contact_chunk" not in log.rpartition("Job stats:")[2], "finished jobs must not rerun"
    again = [path.name for path, time_ in before.items() if path.exists() and path.stat().st_mtime_ns != time_]
    assert not again, "finished jobs must not rerun"
    assert datasets(tmp_path) == local
