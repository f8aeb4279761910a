"""Snakemake, started in this process with the workflow of this package."""

import contextlib
import gc
import importlib.util
import os
import signal
import sys
import tempfile
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TextIO

from stiction.command.last_lines import PRINTED
from stiction.command.progress_line import Display
from stiction.command.run_state import RUN
from stiction.temporary import is_writable, own_folder

PACKAGE = Path(__file__).parents[1]
#: Folder of Snakefile, configuration and profiles: within an installed package, or the root of a checkout.
WORKFLOW = PACKAGE / "project" if (PACKAGE / "project").is_dir() else PACKAGE.parents[1]
#: Signs in a path that Snakemake's command lines do not survive.
_SPECIAL = set(" '\"&;|<>`*?[]()\\!")


class RefusedError(Exception):
    """Refusal to start, in a sentence."""


def require_snakemake() -> None:
    """Raise an error with the remedy if Snakemake is missing, or cannot be started from this folder."""
    if importlib.util.find_spec("snakemake") is None:
        from importlib import metadata  # takes longer than all other imports

        requirements = (
            text.partition(";")[0].strip() for text in metadata.requires("stiction") or () if "workflow" in text
        )
        raise RefusedError(f"this needs Snakemake: {sys.executable} -m pip install '{' '.join(requirements)}'")
    if signs := sorted(_SPECIAL & set(sys.executable)):
        raise RefusedError(
            f"the path of Python ({sys.executable}) contains {' '.join(map(repr, signs))}, which Snakemake does not "
            "support: install it elsewhere"
        )


def require_folder(directory: Path) -> None:
    """Raise an error if the folder of a run, or of its results, is something else."""
    for path in (directory / "results", directory, *directory.absolute().parents):
        if os.path.lexists(path) and not path.is_dir():
            raise RefusedError(f"{path} is no folder: move it away, or choose another --directory")


def words(configs: Sequence[str], directory: str, arguments: Sequence[str]) -> list[str]:
    """Arguments of Snakemake: files with changed keys of the paper's configuration, and the folder of the run.

    Targets and further options come last, where none of the options before takes them for its values.
    """
    files = ["--configfile", str(WORKFLOW / "config.yaml"), *configs]
    return [*files, "--directory", directory, "--snakefile", str(WORKFLOW / "Snakefile"), *arguments]


def snakemake(arguments: Sequence[str], directory: Path, quiet: bool, progress: bool) -> tuple[int, bool]:
    """Run Snakemake in a folder, with arguments from `words`. It reports to `stiction.command.run_state.RUN`.

    A quiet one keeps in a file everything that Snakemake and its jobs print as errors; ``progress`` shows one line
    instead.

    Returns
    -------
    tuple of int and bool
        Exit status of Snakemake, and whether Ctrl-C or SIGTERM stopped it.
    """
    gc.set_threshold(1_000_000)  # as the Snakefile does for a plan: nearly all objects of an import remain as well
    from snakemake import cli

    if not is_writable(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()):
        os.environ["XDG_CACHE_HOME"] = str(own_folder())  # Snakemake keeps sources there
    stopped = []

    def interrupt(*received):
        """Note the interrupt, and pass it on."""
        stopped.append(received)
        warnings.filterwarnings("ignore", "coroutine .* was never awaited", RuntimeWarning)  # of jobs about to start
        signal.default_int_handler(*received)

    before = {number: signal.signal(number, interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    RUN.quiet = quiet
    try:
        with _kept_errors(directory) if quiet else contextlib.nullcontext() as terminal:
            RUN.changed = display = Display(RUN, terminal, directory) if quiet and progress else None
            code = _code(cli.main, ["--logger", "stiction", *arguments])
            if display:
                display.close()
            if RUN.fault and quiet:
                sys.stderr.write(f"{RUN.fault}\n")
            return code, bool(stopped)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _code(program, arguments):
    """Exit status of a program after its end by ``sys.exit``, Ctrl-C or SIGTERM."""
    try:
        program(list(map(str, arguments)))
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except KeyboardInterrupt:
        return 1
    return 0


@contextlib.contextmanager
def _kept_errors(directory: Path) -> Iterator[TextIO]:
    """Let this process and its children write errors to a file. Yields the former standard error."""
    sys.stderr.flush()
    with opened(directory / PRINTED) as file, os.fdopen(os.dup(2), "w") as terminal:
        os.dup2(file.fileno(), 2)
        try:
            yield terminal
        finally:
            sys.stderr.flush()
            os.dup2(terminal.fileno(), 2)


def opened(path: Path) -> TextIO:
    """New file for printed text, without a name if the folder cannot be written. The run then reports this."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)  # a link leads elsewhere, and a pipe is never read
        return path.open("x")
    except OSError:
        return tempfile.TemporaryFile("w")


def printed_last(directory: Path) -> str:
    """Last line printed by Snakemake or one of its jobs, or nothing."""
    with contextlib.suppress(OSError):
        lines = (directory / PRINTED).read_text(encoding="utf-8", errors="replace").split("\n")
        return next(filter(None, map(str.strip, reversed(lines))), "")
    return ""
