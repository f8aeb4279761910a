"""Figures of one to twelve pairs, surfaces or numbers of samples show every curve, and no texts overlap."""

import numpy as np
import pandas as pd
import pytest

from stiction.analysis.mesh import Arrest
from stiction.report import figures_studies
from stiction.report.style import save
from stiction.streams import stream
from stiction.studies import correlation as study_correlation
from stiction.studies import mesh as study_mesh
from stiction.studies import plasticity as study_plasticity
from stiction.studies import sample_sizes as study_sample_sizes
from stiction.variants import beams as study_variant

FAST = (1, 4, 12)
COUNTS = [pytest.param(n, marks=[pytest.mark.slow] * (n not in FAST)) for n in (1, 2, 3, 4, 5, 7, 9, 12)]
HUMIDITIES = (0.5, 0.7)
RNG = stream(11)
PUBLISHED = pd.DataFrame(
    {
        "pair": ["p0", "p0"],
        "relative_humidity": HUMIDITIES,
        "ng": [800.0, 500.0],
        "experiment": [820.0, 490.0],
        "experiment_std": [30.0, 20.0],
    }
)


def names(count, letter="p"):
    return [f"{letter}{k}" for k in range(count)]


def stresses():
    columns = {"interference": 1e-9 * RNG.random(99), "radius": 1e-7 * RNG.random(99), "stress": 1e10 * RNG.random(99)}
    return study_plasticity.layout(columns | {"strip": np.arange(99) // 33}, (0.052, 0.0117), 2.25e-9)


def sizes(count):
    distances = np.column_stack([0.5 / np.arange(1, count + 1), np.full(count, 0.01)])
    energy = np.linspace(0, 1e-2, 50)
    densities = 500 * np.exp(-(((energy - 5e-3) / 2e-3) ** 2)) * np.linspace(0.8, 1, count)[:, None]
    return study_sample_sizes.layout(energy, densities, 50 * (1 + np.arange(count)), distances)


def variant():
    beams = [
        {"crack_length": length * (1 + 0.01 * RNG.standard_normal(20)), "state": np.zeros(20, int)}
        for length in (8e-4, 5e-4)
    ]
    return study_variant.layout(HUMIDITIES, [1e-2 * RNG.lognormal(0, 0.2, 40) for _ in beams], beams)


def mesh():
    curve = np.linspace(0, 2e-8, 60), RNG.random(60)
    arrests = [Arrest(7e-4, 3.6e-3), Arrest(7.1e-4, 3.7e-3)]
    return study_mesh.layout([(1.5e-5, 1.5e-6), (7.5e-6, 1.5e-6)], arrests, [2e6, 7e-9, 6e8, 1e9], curve)


def correlation(count):
    lag = np.linspace(0, 1e-6, 30)
    decay = 1e-7 * (1 + np.arange(count))
    return study_correlation.layout(names(count, "S"), lag, np.exp(-lag / decay[:, None]), 3 * decay)


def errors(count):
    return {(pair, rh): [0.1, 0.02, 2e-3, 0.0] for pair in names(count) for rh in HUMIDITIES}


def stress_figure(count):
    return figures_studies.summit_stresses({pair: stresses() for pair in names(count)})


def convergence_figure(count):
    return figures_studies.sample_convergence(sizes(max(2, count)), errors(count), 1e-3)


def mesh_figure(count):
    return figures_studies.mesh_convergence(mesh(), correlation(count))


def variants_figure(count):
    keys = [(pair, name) for pair in names(count) for name in ("base", "psd_identified", "every_2")]
    return figures_studies.variants({key: variant() for key in keys}, PUBLISHED)


FIGURES = {"16": stress_figure, "17": convergence_figure, "19": mesh_figure, "variants": variants_figure}


def texts(figure):
    """Boxes of all titles, labels of axes and legends of a figure [pixels]."""
    boxes = []
    for axes in figure.axes:
        titles = [axes.title, axes._left_title, axes._right_title]
        boxes += [t.get_window_extent() for t in (*titles, axes.xaxis.label, axes.yaxis.label) if t.get_text()]
    return boxes + [legend.get_window_extent() for legend in figure.legends]


@pytest.mark.parametrize("name", FIGURES)
@pytest.mark.parametrize("count", COUNTS)
def test_no_text_covers_another_or_leaves_the_figure(name, count, tmp_path):
    figure = FIGURES[name](count)
    save(figure, tmp_path / "figure.png")
    boxes = texts(figure)
    width, height = figure.get_size_inches() * figure.dpi
    for k, box in enumerate(boxes):
        assert box.x0 > -2
        assert box.x1 < width + 2
        assert box.y0 > -2
        assert box.y1 < height + 2
        assert not any(box.shrunk(0.98, 0.9).overlaps(other) for other in boxes[:k])


@pytest.mark.parametrize("count", COUNTS)
def test_every_pair_surface_and_number_of_samples_has_its_curve_or_panel(count):
    densities, lost, _ = convergence_figure(count).axes
    assert len(densities.lines) == max(2, count)
    assert len(lost.lines) == 2 * count + 1
    styles = [(line.get_color(), line.get_linestyle(), line.get_marker()) for line in lost.lines[:-1:2]]
    assert len(set(styles)) == count
    assert len(mesh_figure(count).axes[2].lines) == count
    assert len(stress_figure(count).axes) == count + 1
    assert len(variants_figure(count).axes) == 2 * count
