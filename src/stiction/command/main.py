"""Command line: ``stiction COMMAND [FILE ...] [OPTIONS] [-- ARGUMENTS OF SNAKEMAKE]``."""

import argparse
import os
import shlex
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path

from stiction.command import explain, launch, output_streams
from stiction.command.at_once import estimate
from stiction.command.last_lines import PRINTED, Status, fault, last_lines, status
from stiction.command.output_streams import say
from stiction.command.run_state import RUN
from stiction.config import reading
from stiction.config.kinds import PULL_OFF, kind_of
from stiction.config.messages import ConfigError
from stiction.models import SIDES
from stiction.run import stale_results
from stiction.run.atomic import save_text
from stiction.run.provenance import RecordError, understood

_PURPOSE = "From the statistics of two rough surfaces to the probability that MEMS devices stick, and what to build."
#: Questions about devices that are not what to build, in words.
_ASKED = {PULL_OFF: "Asked for the pull-off force, not for what to build:"}
_STATUS = """
exit status: 0 done, 1 a job or stiction itself failed, 2 refused (wrong input, or another run uses
the folder), 3 checks of the results failed, 130 stopped by Ctrl-C or SIGTERM. Results are in results/,
below the current folder or --directory. Everything after -- is passed to Snakemake.
"""


def main(words: Sequence[str] | None = None) -> int:
    """Run a command, and return its exit status."""
    output_streams.open_closed()
    words, log = list(sys.argv[1:] if words is None else words), PRINTED
    try:
        arguments = _parsed(words)
        log = Path(arguments.directory) / PRINTED
        return arguments.run(arguments)
    except (launch.RefusedError, ConfigError) as error:
        say(str(error), sys.stderr)
        return Status.REFUSED
    except KeyboardInterrupt:
        say("stopped; run the same command to continue", sys.stderr)
        return Status.STOPPED
    except (OSError, MemoryError) as error:
        say(str(error) or "the memory is full", sys.stderr)
        return Status.FAILED
    except Exception as error:
        with launch.opened(log) as file:
            traceback.print_exc(file=file)
        for line in (f"{type(error).__name__}: {error}", *fault(log)):
            say(line, sys.stderr)
        return Status.FAILED


def _parsed(words):
    """Arguments of the command, and those of Snakemake."""
    cut = words.index("--") if "--" in words else len(words)
    try:
        arguments = _parser().parse_args(words[:cut])
    except SystemExit:
        say("", end="")  # the help that was asked for
        raise
    arguments.more = words[cut + 1 :]
    return arguments


def _parser():
    """Commands and their options."""
    shape = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("stiction", description=_PURPOSE, epilog=_STATUS, formatter_class=shape)
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add(commands, "init", _init, "write study.yaml, a commented study to start from", files=None)
    _add(commands, "check", _check, "check files without computing anything", files="+")
    _add(commands, "run", _run, "compute your own surfaces, pairs, beams and devices", files="+")
    _add(commands, "paper", _run, "compute every table and figure of the paper", files=None)
    _add(commands, "devices", _devices, "compute only what a design of devices needs (default: the example)", files="*")
    _add(commands, "scans", _scans, "evaluate scans alone: sheets, statistics and warnings", files="+")
    _add(commands, "published", _published, "write published scans into files, and a study that names them", files=1)
    _add(commands, "figures", _figures, "draw the figures", files="*")
    _add(commands, "report", _report, "put the results into one file, results/report.html", files="*")
    _add(commands, "show", _show, "open the index of the results, results/index.html", files=None)
    _add(commands, "explain", _explain, "say what would be computed, and why", files="*")
    words = "estimate the length or force to build at once, in a tenth of a second"
    added = commands.add_parser("estimate", help=words, description=estimate.PURPOSE)
    estimate.add_options(added)
    added.set_defaults(run=estimate.run, directory=".")
    return parser


class _Version(argparse.Action):
    """Shows the version. This takes an import of its own."""

    def __call__(self, parser, *_):
        from importlib import metadata

        say(f"stiction {metadata.version('stiction')}")
        parser.exit()


def _add(commands, name: str, run: Callable, purpose: str, files: str | None):
    """Add one command."""
    added = commands.add_parser(name, help=purpose, description=f"{purpose[0].upper()}{purpose[1:]}.", epilog=_STATUS)
    added.formatter_class = argparse.RawDescriptionHelpFormatter
    added.set_defaults(run=run, files=[])
    if run is _published:
        added.add_argument("files", nargs=1, metavar="SOURCE", help="container file, DOI, or address of its page")
    elif files:
        added.add_argument(
            "files", nargs=files, metavar="FILE", help="changes single keys of the paper's configuration"
        )
    added.add_argument("--directory", "-d", default=".", metavar="DIR", help="results go to DIR/results (default: .)")
    if run is _init:
        added.add_argument(
            "--test-beams", action="store_true", help="write test_beams.csv, a table of single test beams"
        )
    if run not in (_init, _check, _show, _published):
        added.add_argument("--cores", "-c", metavar="N", help="number of jobs at the same time (default: all cores)")
        added.add_argument("--dry-run", "-n", action="store_true", help="only say what would be computed")
        added.add_argument("--verbose", "-v", action="store_true", help="show everything that Snakemake prints")


def _init(arguments):
    """Write a study, or a table of test beams."""
    if arguments.test_beams:
        return _init_test_beams(Path(arguments.directory) / "test_beams.csv")
    from stiction.command import editor_schema  # imports the physics

    target = Path(arguments.directory) / "study.yaml"
    schema = editor_schema.text()
    _write({target: Path(__file__).with_name("study.yaml"), target.with_name("stiction.schema.json"): schema})
    say(f"{target} describes a surface, a pair and a beam: change them into yours. Then")
    word = shlex.quote(str(target))
    say(f"  stiction check {word}     says whether it can run")
    say(f"  stiction run {word}       computes it: tables and figures in results/")
    return Status.DONE


def _init_test_beams(target):
    """Write a table of test beams."""
    from stiction.config.test_beams import TEMPLATE

    _write({target: TEMPLATE})
    say(f"{target} has a row for every test beam: put yours there, and name the file in test_beams.NAME.file.")
    return Status.DONE


def _write(contents):
    """Write new files from texts, or from files with them. A file of the same content remains."""
    texts = {target: _text(content) for target, content in contents.items()}
    missing = {target: text for target, text in texts.items() if not (target.is_file() and _text(target) == text)}
    if existing := [target for target in missing or texts if os.path.lexists(target)]:
        raise launch.RefusedError(f"{existing[0]} exists already: nothing was written")
    for target, text in missing.items():
        launch.require_folder(target.parent)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            with target.open("x", encoding="utf-8") as file:
                file.write(text)
        except OSError as error:
            raise launch.RefusedError(f"{target} cannot be written: {error.strerror}") from error


def _text(content):
    """Text itself, or a file's."""
    return content if isinstance(content, str) else content.read_text(encoding="utf-8", errors="replace")


def _check(arguments):
    """Check files."""
    from stiction.command.prepared import prepared
    from stiction.config.files import joined
    from stiction.run.disk_cache import caches_below

    launch.require_folder(directory := Path(arguments.directory))
    with caches_below(directory) as caches:
        ready = prepared(joined(*arguments.files), caches, with_samples=True)
        cost = _cost(ready, caches)
    config = ready.config
    pairs, devices = config["run"]["pairs"], config.get("devices", {})
    scanned = [name for name, entry in config["surfaces"].items() if "scans" in entry]
    by_kind = {f"pair{'s' * (len(pairs) > 1)}": pairs, "devices": devices, "scans of": scanned}
    texts = [f"{kind} {', '.join(names)}" for kind, names in by_kind.items() if names]
    say(f"{' '.join(arguments.files)} can run: {' and '.join(texts) or 'nothing'}.")
    if ready.numbers:
        say(str(ready.numbers))
    for question, words in _ASKED.items():
        if probes := [name for name, device in devices.items() if kind_of(device).question(device) == question]:
            say(f"{words} {', '.join(probes)}.")
    say(f"It takes {cost}, less for results that are already there.")
    for line in estimate.in_short(arguments.files):
        say(line)
    of_pairs = {name: {pair[side] for side in SIDES} for name, pair in config["pairs"].items()}
    if long := [name for name, device in devices.items() if of_pairs[device["pair"]] & {*scanned}]:
        say(
            f"The budget of {', '.join(long)} draws the measured surfaces again with every quantity changed, which "
            "takes most of the time. Without it: stiction run FILE -- results/tables/safe_lengths.md (or stoppers.md)"
        )
    return Status.DONE


def _cost(ready, caches):
    """CPU time and memory of the whole run of a configuration, in words."""
    from stiction.plan import cost
    from stiction.plan.planner import Planner

    with caches.cache("cost.json") as remember:
        return cost.in_words(*Planner(ready.config, ready.estimates, caches.code, remember).cost)


def _run(arguments, *targets):
    """Run the workflow, or a part of it."""
    launch.require_snakemake()
    directory = Path(arguments.directory)
    options = ["--cores", arguments.cores] * bool(arguments.cores) + ["--dry-run"] * arguments.dry_run
    if problems := list(reading.problems(arguments.files, [*options, *arguments.more])):
        raise launch.RefusedError("\n".join(problems))
    launch.require_folder(directory)
    words = launch.words(arguments.files, arguments.directory, [*options, *targets, *arguments.more])
    verbose = arguments.verbose or "--verbose" in arguments.more
    dry = arguments.dry_run or bool({"-n", "--dry-run", "--dryrun"} & set(arguments.more))
    code, stopped = launch.snakemake(words, directory, quiet=not verbose, progress=not dry)
    ended = status(RUN, code, stopped)
    if ended == Status.CHECKS:
        from stiction.command import index  # takes longer than all other imports

        index.write_for_last_run(directory / "results")
        RUN.unlike = index.unlike_last_run(directory / "results")
    printed = "" if verbose else launch.printed_last(directory)
    stems = ["compared_*"] * any("compare" in reading.read(file) for file in arguments.files)
    stems += [Path(word).stem for word in (*targets, *arguments.more)]
    lines = explain.explained(RUN) if dry and not ended else last_lines(RUN, ended, directory, printed, stems)
    for line in lines:
        say(line, sys.stderr if ended else None)
    return ended


def _devices(arguments):
    """Run the jobs of devices."""
    arguments.files = arguments.files or [str(launch.WORKFLOW / "examples" / "devices.yaml")]
    if not any(content.get("devices") for content in reading.contents(arguments.files, arguments.more)):
        raise launch.RefusedError(f"{' '.join(arguments.files)} describes no devices: add a section devices")
    return _run(arguments, "devices")


def _scans(arguments):
    """Evaluate scans and lines without the pairs of their surfaces."""
    from stiction.config import scans  # takes longer than all other imports
    from stiction.config.surfaces import process

    contents = reading.contents(arguments.files, arguments.more)
    if not any(scans.has_scans(content) or process.has_scans(content) for content in contents):
        add = "add surfaces.NAME.scans or surfaces.NAME.profiles, or scans to the settings of process.NAME"
        raise launch.RefusedError(f"{' '.join(arguments.files)} describes no surface by scans: {add}")
    if any(word.startswith("--configfile") for word in arguments.more):
        return _run(arguments, "scans")  # files that Snakemake reads
    from stiction.command import scans_alone

    launch.require_folder(directory := Path(arguments.directory))
    surfaces = scans_alone.alone(arguments.files, directory)
    for words in surfaces.lines:
        say(f"{words}.")
    arguments.files, ended = [surfaces.write(directory)], Status.DONE
    if surfaces.overlay["surfaces"]:
        arguments.more = ["--keep-going", *arguments.more]
        ended = _run(arguments, "scans")
    for name, (entry, reasons) in surfaces.refused.items():
        say(f"{name} cannot be estimated: {'; '.join(reasons)}")
        if not arguments.dry_run:
            say(f"  sheet: {scans_alone.draw_refused(name, entry, reasons, directory / 'results')}")
    return ended


def _published(arguments):
    """Write published scans into files, and a study that names them."""
    from stiction.command import published  # imports the library for files of scans

    launch.require_folder(directory := Path(arguments.directory))
    study = published.written(*arguments.files, directory)
    say(f"{study} names the scans: stiction scans {shlex.quote(str(study))} evaluates them.")
    return Status.DONE


def _figures(arguments):
    """Draw the figures."""
    return _run(arguments, "figures")


def _results(find, folder, purpose="", note=""):
    """Find something in a folder of results, and refuse a folder without results or with damaged ones."""
    if not (results := _of_record(find, folder)):
        run = "run stiction paper or stiction run FILE first"
        raise launch.RefusedError(f"there are no results{purpose} in {folder}: {run}{note}")
    return results


def _of_record(find, folder):
    """Find something by the record of runs in a folder of results, and refuse a damaged one."""
    record = folder / "provenance.json"
    try:
        with understood(record):
            return find(folder)
    except RecordError as damaged:
        raise launch.RefusedError(str(damaged)) from None


def _report(arguments):
    """Write the report of finished results."""
    from stiction.command import front_page, index  # imports the libraries for numbers

    results = Path(arguments.directory) / "results"
    _results(front_page.is_finished, results, " for a report", " (stiction devices is not enough)")
    if unlike := _of_record(index.unlike_last_run, results):
        raise launch.RefusedError(f"{stale_results.in_words(unlike)}: run stiction run FILE before the report")
    page = Path(arguments.directory) / front_page.FRONT
    save_text(_of_record(front_page.front_page, results), page)
    files = launch.WORKFLOW / "workflow" / "report"
    options = ("--report-stylesheet", str(files / "style.css"), "--report-metadata", str(files / "guide.yaml"))
    ended = _run(arguments, "--report", "results/report.html", *options)
    if ended == Status.DONE and not arguments.dry_run:
        say(f"The report is one file: {results / 'report.html'}.")
    return ended


def _show(arguments):
    """Write the index of the present results, name it, and open it if there is a display."""
    import webbrowser

    from stiction.command import index  # imports the libraries for numbers

    results = Path(arguments.directory) / "results"
    page = _results(index.write_for_last_run, results)
    say(str(page))
    if sys.platform != "linux" or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        webbrowser.open(page.resolve().as_uri())
    return Status.DONE


def _explain(arguments):
    """Say the jobs of a run and their reasons."""
    arguments.dry_run = True
    return _run(arguments)


if __name__ == "__main__":
    sys.exit(main())
