"""Whether legends cover panels, texts or each other, or leave their figure."""

from stiction.report.style import save


def covering(figure):
    """Labels of the first entries of legends that lie on a panel, on a text or another legend, or beyond the figure."""
    save(figure)  # lays it out
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()] + figure.legends
    boxes = [axes.bbox for axes in figure.axes] + [text.get_window_extent() for text in _texts(figure)]
    drawn = [(legend, legend.get_window_extent().shrunk(0.98, 0.9)) for legend in legends]
    return [
        legend.get_texts()[0].get_text()
        for legend, box in drawn
        if any(box.overlaps(other) for other in boxes + [other for rival, other in drawn if rival is not legend])
        or not (box.x0 >= 0 and box.x1 <= figure.bbox.width)
    ]


def _texts(figure):
    """Titles, labels of the axes, labels of ticks and the text below a figure."""
    for axes in figure.axes:
        yield from (axes.title, axes._left_title, axes.xaxis.label, axes.yaxis.label, *axes.get_xticklabels())
    if figure._supxlabel is not None:
        yield figure._supxlabel
