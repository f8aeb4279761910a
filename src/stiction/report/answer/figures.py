"""Picture of an answer: the steps from the estimate to the size to build."""

import numpy as np
from matplotlib.figure import Figure

from stiction.answer.data import Answer
from stiction.report.answer import words
from stiction.report.format import UM, UN
from stiction.report.style import OUTLINED, SINGLE, panels, styled

#: Colours of steps that are inside the answer, of those beside it, and of the answer [Okabe and Ito].
_INSIDE, _BESIDE, _ANSWER = "#0072B2", "0.6", "#D55E00"
#: Height of a row, and of the rest [in].
_ROW, _AROUND = 0.42, 0.6


@styled
def ladder(answer: Answer) -> Figure:
    """Draw the steps from the estimate to the size to build, one row each, with its size and change."""
    scale, unit = (UN, "µN") if answer.more_is_better else (UM, "µm")
    figure, grid = panels(1, 1, (SINGLE, _AROUND + _ROW * len(answer.steps)))
    panel, before = grid[0, 0], answer.steps[0].size / scale
    for row, step in enumerate(answer.steps):
        size, colour = step.size / scale, _INSIDE if step.stated else _BESIDE
        panel.plot([before, size], [row, row], color=colour, linewidth=5, solid_capstyle="butt")
        panel.plot(size, row, "|", color=colour, markersize=11)
        change = f" ({100 * (step.factor - 1):+.1f} %)" if row else ""
        said = f"{words.CAUSES[step.cause][0]}: {words.size_in_words(answer, step.size)}{change}"
        panel.annotate(said, (0.02, row - 0.2), **_LABEL)
        before = size if step.stated else before
    _answer_and_stated(panel, answer, scale)
    what = "restoring force" if answer.more_is_better else "length"
    panel.set(xlabel=f"{what} [{unit}]", yticks=[], ylim=(len(answer.steps) - 0.6, -0.75))
    panel.margins(x=0.1)
    return figure


#: Place of the label of a step.
_LABEL = {"xycoords": ("axes fraction", "data"), "va": "bottom", "fontsize": 7, "path_effects": OUTLINED}


def _answer_and_stated(panel, answer, scale):
    """Lines at the size to build, and at the stated size unless it is far away."""
    ends = [step.size for step in answer.steps]
    if np.isfinite(answer.build):
        panel.axvline(answer.build / scale, color=_ANSWER, linewidth=1.2, zorder=0)
    if 0.5 * min(ends) < answer.size < 2 * max(ends):
        panel.axvline(answer.size / scale, color="0.3", linestyle=":", linewidth=1, zorder=0)
