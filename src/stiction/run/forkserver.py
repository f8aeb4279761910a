"""Jobs as forks of a process after the imports of every library and kernel.

A new interpreter spends about a second on imports and compiled kernels before a job can begin; a fork of a process that
has done so begins within hundredths of a second. `Server` starts that process, ``python -m stiction.run.forkserver``,
and asks it to run scripts. The process has a single thread, because only then a fork is safe.

The fork server of ``multiprocessing`` is for callers of one thread: a start reads the ends of children for which other
threads wait. Of 1000 jobs without errors that four threads started, 161 were reported as failed (Python 3.11).
"""

import contextlib
import ctypes
import gc
import importlib
import os
import pkgutil
import select
import signal
import socket
import subprocess
import sys
import traceback
import types
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

PACKAGE = Path(__file__).parents[1]
#: Command that starts the process of a `Server`. With -P, no file in the working directory is imported as a library.
COMMAND = [sys.executable, "-P", "-m", "stiction.run.forkserver"]
#: Module that changes Snakemake itself, of which jobs import only a small part.
_OF_SNAKEMAKE = "stiction.run.snakemake_patches"
#: Modules that jobs import only when they start, read, write or draw.
LATE = (
    "snakemake.iocontainers",
    "snakemake.logging",
    "netCDF4",
    "matplotlib.backends.backend_agg",
    "matplotlib.backends.backend_pdf",
    "matplotlib.style",
    "pandas.io.formats.csvs",
    "pandas.io.formats.html",
    "tabulate",
)
#: Variables that limit the threads of libraries. OpenBLAS reads its own when it is loaded; the FFT of SciPy 1.18 and
#: newer, DUCC, at its first transform and at every fork, after which it starts its threads again.
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "DUCC0_NUM_THREADS")
_READY = b"ready"
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


class Server:
    """Process for running scripts in forks of itself, all in one environment. It ends with its parent process.

    Raises
    ------
    ConnectionError
        If the process ends before it is ready.
    """

    def __init__(self, environment: dict[str, str]):
        self.environment = environment
        self._requests, theirs = _channel()
        with theirs:
            words = [*COMMAND, str(theirs.fileno())]
            self.process = subprocess.Popen(words, env=environment, pass_fds=[theirs.fileno()])
        if self._requests.recv(len(_READY)) != _READY:
            self.close()
            raise ConnectionError("the server of jobs ended before it was ready")

    def run(self, script: str | Path) -> int:
        """Run a script as ``python script`` does and wait for its end.

        Returns
        -------
        int
            Exit status, negative if a signal ended the script, as in ``subprocess``.

        Raises
        ------
        BrokenPipeError
            If the server had ended before.
        ConnectionError
            If the server ended while the script was running; its scripts are killed with it.
        """
        reply, theirs = _channel()
        with reply:
            with theirs:
                socket.send_fds(self._requests, [os.fsencode(script)], [theirs.fileno()])
            status = reply.recv(64)
        if not status:
            raise ConnectionError(
                "the server of jobs ended while a script was running. If the memory was full, run fewer jobs at a "
                "time, for example with ARGS='--cores 1'"
            )
        return int(status)

    def close(self) -> None:
        """End the server and its running scripts."""
        self._requests.close()
        self.process.wait()


def _channel():
    """Pair of sockets with limits between messages."""
    return socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)


def main() -> None:
    """Serve requests on the socket with the number of the argument. Each child runs its script and ends."""
    requests = socket.socket(fileno=int(sys.argv[1]))
    with one_thread():
        preload()
        refuse_threads()
        # Ctrl-C reaches the children, which must have ended before the server does.
        interrupt = signal.signal(signal.SIGINT, signal.SIG_IGN)
        requests.send(_READY)
        script = serve(requests)
    if script:
        signal.signal(signal.SIGINT, interrupt)
        become(script)


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Let libraries have one thread in this context, also after a fork. Its end restores the variables."""
    before = {name: os.environ[name] for name in _THREADS if name in os.environ}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name in _THREADS:
            os.environ.pop(name)
        os.environ.update(before)


def refuse_threads() -> None:
    """End this process if it has several threads: a child has only one of them, and could wait for the others."""
    threads = len(list(Path("/proc/self/task").iterdir()))
    if threads > 1:
        sys.exit(
            f"a library has started threads in the server of jobs ({threads} in all), whose forks would not be safe"
        )


def preload() -> None:
    """Import all libraries of jobs. Load fonts and the compiled kernels, and compile these if necessary."""
    gc.disable()  # nearly all objects remain, and looking for garbage among them would take a tenth of the time
    for module in pkgutil.walk_packages([str(PACKAGE)], "stiction."):
        if module.name != _OF_SNAKEMAKE:
            importlib.import_module(module.name)
    for name in LATE:
        with contextlib.suppress(ImportError):  # what a library no longer has, no job imports
            importlib.import_module(name)
    importlib.import_module("stiction.run.warmup").main()
    importlib.import_module("stiction.report.style").preload()
    gc.freeze()  # the collector of a child would otherwise write to, and thereby copy, every page that it shares
    gc.enable()


def serve(requests: socket.socket) -> str | None:
    """Fork for every request. Returns the script in each child, and ``None`` once the other side has closed.

    Each request is the path of a script, with a socket for the exit status.
    """
    running = {}  # pipe that a child holds open until it ends: its process and the socket for its status
    server = os.getpid()
    while True:
        ready, _, _ = select.select([requests, *running], [], [])
        for ended in set(ready) - {requests}:
            child, reply = running.pop(ended)
            _, status = os.waitpid(child, 0)
            with reply:
                reply.send(b"%d" % os.waitstatus_to_exitcode(status))
            os.close(ended)
        if requests in ready:
            message, descriptors, _, _ = socket.recv_fds(requests, 65536, 1)
            if not message:
                return None
            reply = socket.socket(fileno=descriptors[0])
            lasting, end_of_child = os.pipe()
            child = os.fork()
            if child == 0:
                _end_with(server)
                for other in (requests, reply, *(other for _, other in running.values())):
                    other.close()
                return os.fsdecode(message)
            os.close(end_of_child)
            running[lasting] = child, reply


def _end_with(server):
    """Let the kernel kill this process when the server ends, even if the server is killed."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != server:
        os.kill(os.getpid(), signal.SIGKILL)


def become(script: str) -> NoReturn:
    """Run a script in this process as ``python script`` does, then end the process.

    The interpreter is not taken down, which would copy all memory shared with the server and take longer than most
    scripts; functions registered with ``atexit`` are not called.
    """
    sys.argv[:] = [script]
    sys.path.insert(0, str(Path(script).parent))
    module = types.ModuleType("__main__")
    module.__file__ = script
    sys.modules["__main__"] = module
    status = 0
    try:
        exec(compile(Path(script).read_bytes(), script, "exec"), module.__dict__)
    except BaseException as error:
        status = _status(error)
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(status)


def _status(error):
    """Exit status after an exception not caught by a script. Prints the interpreter's message."""
    if isinstance(error, SystemExit) and isinstance(error.code, int | None):
        return (error.code or 0) & 0xFF
    sys.stdout.flush()  # an interpreter writes what was printed before the message of an error
    if isinstance(error, SystemExit):
        print(error.code, file=sys.stderr)  # noqa: T201
        return 1
    traceback.print_exception(error.with_traceback(error.__traceback__.tb_next))  # without the frame of this module
    if isinstance(error, KeyboardInterrupt):
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        signal.raise_signal(signal.SIGINT)
    return 1


if __name__ == "__main__":
    main()
