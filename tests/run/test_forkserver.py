"""Scripts that run as forks of a server do what they do as new interpreters, and end with the server."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from stiction.run import forkserver
from stiction.run.forkserver import Server

#: Starts a server that imports nothing beforehand.
BARE = "from stiction.run import forkserver; forkserver.preload = lambda: None; forkserver.main()"
#: Variables by which libraries start threads.
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "DUCC0_NUM_THREADS")
#: Longest wait for the end of a process [s].
PATIENCE = 60


@pytest.fixture(scope="module")
def server():
    """Server that has imported all libraries and loaded all kernels, in an environment that allows several threads."""
    server = Server(dict(os.environ) | dict.fromkeys(THREADS, "4"))
    yield server
    server.close()


@pytest.fixture
def bare(monkeypatch):
    """Server that has imported nothing, started as from a terminal: a background job would ignore Ctrl-C."""
    monkeypatch.setattr(forkserver, "COMMAND", [sys.executable, "-P", "-c", BARE])
    ignored = signal.signal(signal.SIGINT, signal.default_int_handler)
    server = Server(dict(os.environ))
    signal.signal(signal.SIGINT, ignored)
    yield server
    server.close()


def script(folder, text, name="script.py"):
    """Write a script that prints into a file next to it."""
    path = folder / name
    printed = f"out = os.open({str(path) + '.out'!r}, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)"
    path.write_text(
        f"import os, sys\n{printed}\nos.dup2(out, 1), os.dup2(out, 2), os.close(out)\n{textwrap.dedent(text)}\n"
    )
    return path


def printed(path):
    return Path(f"{path}.out").read_text()


def gone(process):
    """Wait until a process has ended."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            return True
        if state == "Z":  # nobody has waited for it
            return True
        time.sleep(0.01)
    return False


def awaited(path):
    """Content of a file once it is there."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if path.exists() and (text := path.read_text()).endswith("\n"):
            return text
        time.sleep(0.01)
    raise TimeoutError(path)


ENDS = {
    "end of the file": "print('done', end='')",
    "status": "sys.exit(3)",
    "status beyond a byte": "sys.exit(259)",
    "success": "sys.exit()",
    "message": "print('before'); sys.exit('DataError: a sentence')",
    "error": "def f():\n    raise ValueError('wrong') from KeyError(1)\nf()",
    "failed import": "import stiction.nowhere",
    "assertion": "import json\nassert json is None, 'a note'",
    "interrupt": "raise KeyboardInterrupt",
    "signal": "os.kill(os.getpid(), 9)",
    "SIGTERM": "os.kill(os.getpid(), 15)",
    "syntax": "x = = 1",
}


@pytest.mark.parametrize("text", ENDS.values(), ids=ENDS)
def test_a_script_ends_with_the_status_and_the_output_of_a_new_interpreter(bare, tmp_path, text):
    if "= =" in text:  # the interpreter reports it before the script can redirect its output
        path = tmp_path / "script.py"
        path.write_text(text)
        assert bare.run(path) == subprocess.run([sys.executable, path], capture_output=True).returncode == 1
        return
    path = script(tmp_path, text)
    status = subprocess.run([sys.executable, path]).returncode
    expected = printed(path)
    Path(f"{path}.out").unlink()
    assert bare.run(path) == status
    assert printed(path) == expected


SURROUNDINGS = """
    import netCDF4, snakemake.logging  # change the environment and the path; the server has imported both
    import json, resource, signal
    handlers = [repr(signal.getsignal(number)) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGCHLD)]
    limits = [resource.getrlimit(number) for number in (resource.RLIMIT_NOFILE, resource.RLIMIT_FSIZE)]
    main = sys.modules["__main__"].__dict__ is globals()
    found = {"argv": sys.argv, "path": sys.path, "folder": os.getcwd(), "environment": dict(os.environ)}
    found |= {"name": __name__, "file": __file__, "main": main, "handlers": handlers, "limits": limits}
    found |= {"mask": os.umask(0o22), "open": sorted(os.listdir("/proc/self/fd"))[:3]}
    print(json.dumps(found, sort_keys=True))
"""


def test_a_script_finds_the_surroundings_of_a_new_interpreter(server, tmp_path):
    path = script(tmp_path, SURROUNDINGS)
    subprocess.run([sys.executable, path], env=server.environment, check=True)
    expected = json.loads(printed(path))
    assert server.run(path) == 0
    assert json.loads(printed(path)) == expected
    assert expected["name"] == "__main__"
    assert expected["main"]


PRELOADED = """
    import gc, json
    wanted = ("scipy.fft", "matplotlib.figure", "netCDF4", "stiction.stages.beams.beams")
    libraries = [name for name in wanted if name in sys.modules]
    unwanted = [name for name in ("snakemake.api", "scipy.stats") if name in sys.modules]
    from numba.core.dispatcher import Dispatcher
    beam = [vars(module).values() for name, module in sys.modules.items() if name.startswith("stiction.beam.")]
    kernels = [value for values in beam for value in values if isinstance(value, Dispatcher) and value.signatures]
    threads = os.listdir(f"/proc/{os.getppid()}/task")
    print(json.dumps([os.getppid(), len(libraries), len(kernels), len(threads), gc.get_freeze_count()]))
    assert not unwanted, unwanted
    assert gc.isenabled()
"""


def test_libraries_and_kernels_are_loaded_before_a_script_begins(server, tmp_path):
    path = script(tmp_path, PRELOADED)
    assert server.run(path) == 0, printed(path)
    parent, libraries, kernels, threads, frozen = json.loads(printed(path))
    assert parent == server.process.pid
    assert libraries == 4
    assert kernels > 0
    assert threads == 1, "a fork of a process with several threads is not safe"
    assert frozen > 100_000, "the collector would copy the memory that forks share"
    subprocess.run([sys.executable, path], check=True)
    assert json.loads(printed(path))[1:3] == [0, 0]


DRAWN = """
    before = set(sys.modules)
    from stiction.report import style
    figure, axes = style.styled(style.panels)(1, 2, (3, 2))
    axes[0, 0].set(xlabel="$x$", yscale="log")
    style.save(figure, "figure.pdf", "figure.png")
    print(len(set(sys.modules) - before))
"""


def test_a_figure_needs_nothing_that_is_not_loaded_before(server, tmp_path):
    path = script(tmp_path, f"os.chdir({str(tmp_path)!r})\n{textwrap.dedent(DRAWN)}")
    found = []
    for run in (server.run, lambda path: subprocess.run([sys.executable, path], check=True).returncode):
        assert run(path) == 0, printed(path)
        found.append((int(printed(path)), [(tmp_path / f"figure.{suffix}").read_bytes() for suffix in ("pdf", "png")]))
    (more_of_server, drawn), (more, expected) = found
    assert drawn == expected
    assert more_of_server == 0 < more


COMPUTED = """
    import numpy as np, xarray as xr, matplotlib.pyplot as plt
    from stiction.streams import stream
    from stiction.surface.summits import find_summits
    heights = stream(1, "test").standard_normal((300, 300), dtype=np.float32)
    found = np.append(find_summits(heights, 1e-8)[0], np.linalg.svd(heights[:50, :50].astype(float))[1])
    xr.Dataset({"found": ("number", found)}).to_netcdf(sys.argv[0] + ".nc")
    with xr.open_dataset(sys.argv[0] + ".nc") as dataset:
        plt.plot(dataset.found)
    plt.savefig(sys.argv[0] + ".png")
"""


@pytest.mark.slow
def test_files_arrays_and_figures_of_forks_at_the_same_time_are_those_of_a_new_interpreter(server, tmp_path):
    paths = [script(tmp_path, COMPUTED, f"{number}.py") for number in range(5)]
    assert subprocess.run([sys.executable, paths[0]], env=server.environment).returncode == 0, printed(paths[0])
    with ThreadPoolExecutor() as pool:
        assert list(pool.map(server.run, paths[1:])) == [0] * 4
    for kind in (".nc", ".png"):
        assert len({Path(f"{path}{kind}").read_bytes() for path in paths}) == 1


def test_every_script_gets_its_own_status(bare, tmp_path):
    paths = [script(tmp_path, f"sys.exit({number})", f"{number}.py") for number in range(12)]
    with ThreadPoolExecutor(12) as pool:
        assert list(pool.map(bare.run, paths)) == list(range(12))


SLEEPING = """
    import time
    open(sys.argv[0] + ".pid", "w").write(f"{os.getpid()}\\n")
    time.sleep(600)
"""


def test_scripts_end_with_a_server_that_is_killed_and_the_server_accepts_no_more(bare, tmp_path):
    path = script(tmp_path, SLEEPING)
    with ThreadPoolExecutor() as pool:
        run = pool.submit(bare.run, path)
        process = int(awaited(Path(f"{path}.pid")))
        bare.process.kill()
        with pytest.raises(ConnectionError, match="server of jobs ended"):
            run.result(PATIENCE)
    assert gone(process)
    with pytest.raises(BrokenPipeError):
        bare.run(path)


def test_server_and_scripts_end_with_the_process_that_started_them(tmp_path):
    path = script(tmp_path, SLEEPING)
    owner = "import os, sys; from stiction.run import forkserver; from pathlib import Path\n"
    owner += f"forkserver.COMMAND = [sys.executable, '-P', '-c', {BARE!r}]\n"
    owner += "server = forkserver.Server(dict(os.environ))\n"
    owner += "Path(sys.argv[1] + '.server').write_text(f'{server.process.pid}\\n'); server.run(sys.argv[1])"
    run = subprocess.Popen([sys.executable, "-c", owner, path])
    processes = [int(awaited(Path(f"{path}{kind}"))) for kind in (".server", ".pid")]
    run.kill()
    run.wait()
    assert all(map(gone, processes))


def test_a_server_that_is_closed_ends_without_an_error(bare, capfd):
    bare.close()
    assert bare.process.returncode == 0
    assert capfd.readouterr().err == ""


def test_an_interrupt_from_the_terminal_ends_scripts_but_not_the_server(bare, tmp_path):
    path = script(tmp_path, SLEEPING)
    with ThreadPoolExecutor() as pool:
        run = pool.submit(bare.run, path)
        process = int(awaited(Path(f"{path}.pid")))
        for each in (bare.process.pid, process):  # the terminal signals both
            os.kill(each, signal.SIGINT)
        assert run.result(PATIENCE) == -signal.SIGINT
    assert "KeyboardInterrupt" in printed(path)
    assert bare.run(script(tmp_path, "sys.exit(5)")) == 5


def test_a_server_that_cannot_load_the_package_is_reported(monkeypatch):
    monkeypatch.setattr(forkserver, "COMMAND", [sys.executable, "-c", "raise SystemExit(1)"])
    with pytest.raises(ConnectionError, match="ended before it was ready"):
        Server(dict(os.environ))


THREADED = """
import threading
from stiction.run import forkserver
forkserver.preload = lambda: threading.Thread(target=threading.Event().wait, daemon=True).start()
forkserver.main()
"""


def test_a_server_in_which_a_library_has_started_a_thread_is_refused(monkeypatch, capfd):
    monkeypatch.setattr(forkserver, "COMMAND", [sys.executable, "-P", "-c", THREADED])
    with pytest.raises(ConnectionError, match="ended before it was ready"):
        Server(dict(os.environ))
    assert "a library has started threads in the server of jobs (2 in all)" in capfd.readouterr().err
