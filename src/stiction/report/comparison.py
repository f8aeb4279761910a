"""Values of a key, or of several together, side by side (section ``compare``): numbers of all copies of an entry."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import pandas as pd
from matplotlib.figure import Figure

from stiction.config.merging import values
from stiction.contact.air import Air
from stiction.plan.stage import File
from stiction.report.format import fraction_with_band, with_error
from stiction.report.style import DOUBLE, SINGLE, dashes, figure_stage, letter, marker, panels, styled
from stiction.report.table import HUMIDITY, Columns, Table, table_stage
from stiction.rounding import lower_to


class ComparedPart(NamedTuple):
    """Compared part of a table of the results."""

    table: str
    subject: str  #: column with the names of pairs or devices
    panels: str  #: column whose values have panels of their own in the figure
    words: str  #: the compared number
    numbers: tuple[str, str]  #: its column, and that of its standard error
    more: Columns  #: further columns for reading
    target: str  #: that wants the comparison


SOURCES = (
    ComparedPart(
        *("table_3", "pair", "model", "mean crack length [µm]", ("crack_length_um", "crack_length_se_um")),
        more={"model": (str, "model")},
        target="tables",
    ),
    ComparedPart(
        *("safe_lengths", "device", "held_by", "length that a share p holds [µm]", ("estimate_um", "estimate_se_um")),
        more={
            "held by": (str, "held_by"),
            "p": ("g", "share"),
            "simulated limit [µm]": (lower_to(1), "safe_length_um"),
        },
        target="devices",
    ),
    ComparedPart(
        *("stoppers", "device", "device", "pull-off force [µN]", ("pull_off_uN", "pull_off_se_uN")),
        more={"P(stuck) [%]": (fraction_with_band, "share_stuck", "share_stuck_low", "share_stuck_high")},
        target="devices",
    ),
)


def rows(table: pd.DataFrame, source: ComparedPart, ends: Mapping[str, Sequence[float]]) -> pd.DataFrame:
    """Rows of all copies under the names of their originals, with the compared values in increasing order.

    ``ends`` maps the end of the names of copies to their values, see `stiction.config.merging.values`.
    """
    table = table.dropna(subset="relative_humidity")  # a stopper also has its worst values in any air
    if "estimate_se_beams_um" in table:
        errors = table[["estimate_se_beams_um", "estimate_se_surfaces_um"]].fillna(0)
        table = table.assign(estimate_se_um=(errors**2).sum(axis=1) ** 0.5)
    names = table[source.subject].astype(str)
    copies = {end: table[names.str.endswith(end)] for end in ends}
    of_values = _columns(next(iter(ends.values()), ()))
    parts = [
        copy.assign(
            **{source.subject: names[copy.index].str.removesuffix(end)} | dict(zip(of_values, ends[end], strict=True))
        )
        for end, copy in copies.items()
    ]
    order = [source.subject, "relative_humidity", source.panels, *(["share"] if "share" in table else []), *of_values]
    return pd.concat(parts).sort_values(list(dict.fromkeys(order)))


def _columns(keys):
    """Columns with the values of some keys."""
    return [f"value_{k}" if k > 1 else "value" for k in range(1, len(keys) + 1)]


def comparison_table(
    table: pd.DataFrame, source: ComparedPart, keys: Sequence[str], ends: Mapping[str, Sequence[float]]
) -> Table:
    """Numbers of all copies, those of different values below each other."""
    caption = (
        f"The {source.words.partition(' [')[0]} for values of {' and '.join(keys)}, ± standard error. The copies have "
        "random numbers of their own: the standard error of a difference is the root of the sum of the squares."
    )
    columns = {source.subject: (str, source.subject)} | HUMIDITY | source.more
    columns |= {key: ("g", column) for key, column in zip(keys, _columns(keys), strict=True)}
    columns |= {source.words: (with_error, *source.numbers)}
    return Table.from_rows(rows(table, source, ends).to_dict("records"), caption, columns)


@styled
def comparison_figure(
    table: pd.DataFrame, source: ComparedPart, keys: Sequence[str], ends: Mapping[str, Sequence[float]]
) -> Figure:
    """Compared number against the values of a key: a line for each humidity, for the middle fraction.

    Copies whose keys change together are one beside the other.
    """
    frame = rows(table, source, ends)
    copies = sorted(map(tuple, ends.values()))
    if len(keys) > 1:
        places = frame[_columns(keys)].apply(tuple, axis=1).map(copies.index)
        frame = frame.assign(value=places)
    if "share" in frame:
        shares = sorted(set(frame.share))
        frame = frame[frame.share == shares[len(shares) // 2]]
    parts = dict(list(frame.groupby(list(dict.fromkeys([source.subject, source.panels])), sort=False)))
    figure, axes = panels(1, len(parts), (min(DOUBLE, SINGLE * len(parts)), 3.0))
    for panel, table_of_panel in zip(axes[0], parts.values(), strict=True):
        for k, (humidity, line) in enumerate(table_of_panel.groupby("relative_humidity")):
            at, error = line.sort_values("value"), source.numbers[1]
            style = {"color": f"C{k}", "linestyle": dashes(k), "marker": marker(k), "capsize": 2}
            panel.errorbar(at.value, at[source.numbers[0]], at[error], label=Air(humidity).words, **style)
        panel.set_xlabel(", ".join(keys))
        if len(keys) > 1:
            panel.set_xticks(range(len(copies)), [", ".join(f"{value:g}" for value in copy) for copy in copies])
        panel.legend()
    axes[0, 0].set_ylabel(source.words if "share" not in frame else f"{source.words}, p = {frame.share.iloc[0]:g}")
    letter(axes, [", ".join(name) for name in parts])
    return figure


def _stages(source):
    """Table and figure of one comparison."""
    name = f"compared_{source.table}"

    def jobs(plan):
        """One job if copies of a subject are compared."""
        devices = plan.devices.stoppers if source.table == "stoppers" else plan.devices.beams
        subjects = plan.pairs if source.subject == "pair" else devices
        return [{}] if any(subject.endswith(tuple(values(plan.config))) for subject in subjects) else []

    def settings(plan, _at):
        """Compared keys and their values by suffix of the copies."""
        ends = {end: list(numbers) for end, numbers in values(plan.config).items()}
        return {"keys": sorted(plan.config.get("compare", {})), "ends": ends}

    declared = {
        "inputs": lambda plan, at: {"table": File(f"results/tables/{source.table}.csv")},
        "settings": settings,
        "jobs": jobs,
        "targets": (source.target,),
    }
    shows = f"{source.words.partition(' [')[0]} for values of one key"

    def showing(show):
        """Function of a stage to show its table."""
        return lambda data, settings: show(pd.read_csv(data["table"]), source, settings["keys"], settings["ends"])

    return (
        table_stage(name, shows, compute=showing(comparison_table), **declared),
        figure_stage(name, shows, "Comparison", caption="compared", compute=showing(comparison_figure), **declared),
    )


STAGES = tuple(stage for source in SOURCES for stage in _stages(source))
