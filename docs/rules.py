"""Rules of the workflow as text, from the declarations: files of ``workflow/rules``, a table and a picture.

``python docs/rules.py`` writes them, as ``make numbers`` does.
"""

import re
import sys
import textwrap
from collections.abc import Iterable
from functools import cache
from html import escape
from pathlib import Path
from typing import NamedTuple

from stiction.plan.graph import Graph, stages
from stiction.plan.planner import path_of
from stiction.plan.stage import Stage

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))
import every_stage  # noqa: E402

FOLDER = ROOT / "workflow" / "rules"
#: Rules of the chain of the paper, in the order of its sections, and what each computes, for the picture.
CHAIN = {
    "heights": "density of heights",
    "identification": "spectrum from summits",
    "spectrum": "power spectral density",
    "contact_chunk": "pairs of strips in contact",
    "contact": "all samples of a pair",
    "forces": "force curves with water",
    "chaos": "stochastic force law",
    "beams": "crack lengths of beams",
}
#: Files of all other rules: subject, and folders of the modules that declare their stages.
ROOMS = {
    "surfaces": ("Surfaces beside the chain: scans, statistics, comparisons (Sec. II).", ["stages.surfaces"]),
    "contact": (
        "Contact beside the chain: patches and tips of devices, changed inputs, variants, full elastic contact.",
        ["stages.contact"],
    ),
    "laws": ("Force laws beside the chain: fits, sensitivity, convergence (Sec. III-B, App. B).", ["stages.laws"]),
    "beams": ("Beams beside the chain: mesh, resampling, variants (Apps. B and C).", ["stages.beams"]),
    "devices": (
        "Devices: safe lengths, stoppers, budgets, life, test beams.",
        ["stages.devices", "stages.life", "stages.test_beams", "stages.answer", "stages.at_once"],
    ),
    "process": ("Devices against roughness and process.", ["stages.axes"]),
    "report": ("Tables, figures and pages, and the checks of a run.", ["report"]),
}
READING = "A comment says what each rule does, whose results it reads -> which files it writes."
NOTE = "Written by docs/rules.py from the declarations of the stages: change these, then run make numbers."


# What the jobs of each stage read


class Read(NamedTuple):
    """What the jobs of a stage read as one input."""

    stages: set[str]  #: names of the rules that write it, of which a job reads one or several
    several: bool  #: whether a job reads several files


@cache
def reads() -> dict[str, dict[str, Read]]:
    """What each stage reads, by the name of the input, over the jobs of configurations with all stages."""
    found = {name: {} for name in stages()}
    for plan in (every_stage.of_paper_and_devices(), every_stage.of_scans(), *every_stage.of_others()):
        graph = Graph(plan)
        for job in every_stage.behind(graph):
            for key, names in job.inputs.items():
                _add(found[job.stage.name], key, [graph.job(name).stage.name for name in every_stage.results(names)])
    return found


def _add(inputs, key, written_by):
    """Add the stages of the results of an input of one job."""
    if written_by:
        known = inputs.get(key, Read(set(), several=False))
        inputs[key] = Read(known.stages | {*written_by}, known.several or len(written_by) > 1)


def patterns(stage: Stage) -> list[str]:
    """Paths of the files of a stage with wildcards; ``{each}`` stands for what the configuration lists."""
    return [path_of(stage, name) for name in stage.files.values()]


def read_by(name: str) -> list[str]:
    """Stages whose results a stage reads, in the order of its inputs; those of scans under the name of the others."""
    return list(dict.fromkeys(label for read in reads()[name].values() for label in _labels(read)))


def _labels(read):
    """Names of the stages of an input, in the order of their declarations."""
    return [name.removesuffix("_of_scans") for name in stages() if name in read.stages]


# Files of rules


def texts() -> dict[Path, str]:
    """Text of every file of rules that is written from the declarations.

    Raises
    ------
    ValueError
        If no file has the rule of a stage.
    """
    placed = {*CHAIN}.union(*map(_names_in, ROOMS))
    if left_out := [f"{name} ({module})" for name, (_, module) in stages().items() if name not in placed]:
        raise ValueError(f"no file of rules has {', '.join(left_out)}: add the folder of the module to ROOMS")
    return {FOLDER / "chain.smk": chain()} | {FOLDER / f"{room}.smk": _room(room) for room in ROOMS}


RULE = """
rule {name}:
    input:
{reads}        unpack(inputs_of("{name}")),
    output:
        dataset={output},
    log:
        "results/logs/{log}.log",
{more}    resources:
        **resources_of("{name}"),
    params:
        **params_of("{name}"),
    message:
        "{message}"
    script:
        "../scripts/stage.py"
"""


def chain() -> str:
    """Text of the rules of the chain."""
    text = f'''"""From two rough surfaces to crack lengths: the rules of the paper, each after the rules that it reads.

surface: a rough surface, such as B2 · pair: two surfaces, such as b · case: a pair at one relative humidity, such as
b_rh067 · model: the model of the surfaces, or of the beams · chunk, number: a part of the samples, and the number of
parts.

{NOTE}
"""
'''
    return "\n".join([text, *map(_rule, CHAIN)])


def _rule(name):
    """Text of one rule."""
    stage = stages()[name][0]
    (output,) = (f'"{path}"' for path in patterns(stage))
    more = '    wildcard_constraints:\n        **DECLARED["{name}"]["constraints"],\n' if stage.surfaces else ""
    more += f"    priority: {stage.running.priority}\n" if stage.running.priority else ""
    more += "    localrule: True\n" if stage.running.minutes is None else ""
    return RULE.format(
        name=name,
        reads="".join(f"        # {key}: {paths}\n" for key, paths in _read_paths(name).items()),
        output=f"temp({output})" if stage.running.temporary else output,
        log=stage.log,
        more=more.format(name=name),
        message=re.sub(r"{(\w+)}", r"{wildcards.\1}", stage.message),
    )


def _read_paths(name):
    """Paths of the results that a stage reads, with wildcards, by the name of the input; dots if there are several."""
    paths = {}
    for key, (names, several) in reads()[name].items():
        alternatives = sorted({path for name in names for path in patterns(stages()[name][0])})
        paths[key] = " or ".join(alternatives) + ", …" * several
    return paths


def _room(room):
    """Text of the file of a room."""
    about, _ = ROOMS[room]
    return "\n".join([f'"""{about}\n\n{READING}\n\n{NOTE}\n"""\n', *map(_definition, _names_in(room))])


def _names_in(room):
    """Names of the rules in the file of a room."""
    _, folders = ROOMS[room]
    return [
        name
        for folder in folders
        for name, (_, module) in stages().items()
        if module.startswith(f"stiction.{folder}.") and name not in CHAIN
    ]


def _definition(name):
    """Text that defines one rule, after what it does, reads and writes."""
    stage = stages()[name][0]
    files = f"{', '.join(read_by(name)) or 'no results'} -> {_in_short(patterns(stage))}"
    lines = textwrap.wrap(files, 110, initial_indent="#   ", subsequent_indent="#     ", break_on_hyphens=False)
    return "\n".join([f"# {stage.message}", *lines, f'define("{name}")', ""])


def _in_short(paths):
    """Paths of equal name with their endings in braces.

    >>> _in_short(["results/tables/table_1.csv", "results/tables/table_1.md"])
    'results/tables/table_1.{csv,md}'
    """
    stems, ends = zip(*(path.rsplit(".", 1) for path in paths), strict=True)
    if len(set(stems)) > 1:
        return ", ".join(paths)
    return f"{stems[0]}.{ends[0]}" if len(ends) == 1 else f"{stems[0]}.{{{','.join(ends)}}}"


# Tables and picture for the docs

DOCS = ROOT / "docs"
_SECTION = re.compile(r"\((?:Secs?|App|Fig|Table)[^)]*\)")


def table(names: Iterable[str]) -> str:
    """Table of rules in Markdown."""
    head = ["| rule | reads | writes | wildcards | module | paper |", "|---|---|---|---|---|---|"]
    return "\n".join([*head, *map(_row, names)]) + "\n"


def _row(name):
    """Row of a rule."""
    stage, module = stages()[name]
    paths = patterns(stage)
    wildcards = dict.fromkeys(wildcard for path in paths for wildcard in re.findall(r"{(\w+)}", path))
    section = _SECTION.search(stage.message)
    cells = (
        f"`{name}`",
        ", ".join(f"`{read}`" for read in read_by(name)),
        f"`{_in_short(paths)}`",
        ", ".join(wildcard for wildcard in wildcards if wildcard != "each"),
        f"`{module.removeprefix('stiction.')}`",
        section[0][1:-1] if section else "",
    )
    return f"| {' | '.join(cells)} |"


def chain_table() -> str:
    """Table of the rules of the chain."""
    return table(CHAIN).rstrip()


def all_rules() -> str:
    """Tables of all rules, by the file in which they are."""
    parts = [f"## chain.smk\n\n{table(CHAIN)}"]
    parts += [f"## {room}.smk\n\n{table(_names_in(room))}" for room in ROOMS]
    return "\n".join(parts)


#: Size of a box of the picture, distances between boxes, and columns and rows of the boxes.
_BOX, _GAP = (168, 54), (20, 26)
_PLACES = {
    "heights": (0, 0),
    "identification": (1, 0),
    "spectrum": (1, 1),
    "contact_chunk": (0, 1),
    "contact": (0, 2),
    "forces": (1, 2),
    "chaos": (1, 3),
    "beams": (0, 3),
}


def links() -> list[tuple[str, str]]:
    """Rules of the chain, each with a rule that reads its results. Links along which others lead are left out."""
    direct = [(read, name) for name in CHAIN for read in read_by(name) if read in CHAIN]
    implied = {(a, c) for a, b in direct for b2, c in direct if b == b2}
    return [link for link in direct if link not in implied]


def picture() -> str:
    """Chain of the paper as SVG, in colours that are readable on any ground."""
    width, height = (n * (_BOX[k] + _GAP[k]) + _GAP[k] for k, n in enumerate((2, 4)))
    parts = [_arrow(*link) for link in links()] + [_box(name) for name in CHAIN]
    about = "; ".join(f"{name} reads {', '.join(read_by(name)) or 'no results'}" for name in CHAIN)
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" font-size="15"',
            '  font-family="system-ui, sans-serif" text-anchor="middle">',
            f"<title>Rules of the chain of the paper</title><desc>{escape(about)}</desc>",
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
            *parts,
            "</svg>\n",
        ]
    )


def _corner(name):
    """Upper left corner of a box [px]."""
    return tuple(_GAP[k] + _PLACES[name][k] * (_BOX[k] + _GAP[k]) for k in (0, 1))


def _box(name):
    """Box of a rule: its name, and what it computes."""
    (x, y), (across, down) = _corner(name), _BOX
    middle = x + across / 2
    return (
        f'<rect x="{x}" y="{y}" width="{across}" height="{down}" rx="6" fill="#e6eef6" stroke="#1f2328"/>\n'
        f'<text x="{middle}" y="{y + 23}" fill="#1f2328" font-weight="600">{name}</text>\n'
        f'<text x="{middle}" y="{y + 43}" fill="#57606a" font-size="13">{CHAIN[name]}</text>'
    )


def _arrow(read, name):
    """Arrow between the edges of the boxes of two rules that are beside, or below, each other."""
    (x0, y0), (x1, y1) = ((x + _BOX[0] / 2, y + _BOX[1] / 2) for x, y in (_corner(read), _corner(name)))
    along, down = (x1 > x0) - (x1 < x0), (y1 > y0) - (y1 < y0)
    x0, x1 = x0 + along * _BOX[0] / 2, x1 - along * _BOX[0] / 2
    y0, y1 = y0 + down * _BOX[1] / 2, y1 - down * _BOX[1] / 2
    left, right = (f"{x1 - 9 * along + side * down:g},{y1 - 9 * down + side * along:g}" for side in (-5, 5))
    return (
        f'<path d="M{x0:g},{y0:g} L{x1:g},{y1:g}" stroke="#1f2328" stroke-width="2"/>'
        f'<path d="M{x1:g},{y1:g} L{left} L{right} Z" fill="#1f2328"/>'
    )


def written() -> dict[Path, str]:
    """Text of every file that is written from the declarations."""
    return texts() | {DOCS / "tables" / "rules.md": all_rules(), DOCS / "pictures" / "chain.svg": picture()}


if __name__ == "__main__":
    for path, text in written().items():
        path.write_text(text, encoding="utf-8")
