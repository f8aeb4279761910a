"""Figures of many pairs, surfaces, samples, humidities or choices show all data, and none of their texts overlap."""

from collections import defaultdict
from functools import cache

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stiction.analysis.mesh import Arrest
from stiction.beam.cantilever import Beam
from stiction.beam.energy import apparent_adhesion_energy
from stiction.contact import forcelaw
from stiction.report.beams.figures import adhesion_energies
from stiction.report.beams.overview import overview
from stiction.report.laws.figures import force_curves
from stiction.report.studies import figures as figures_studies
from stiction.report.style import styled
from stiction.stages.beams import beams as stage_beams
from stiction.stages.beams import mesh as study_mesh
from stiction.stages.beams import variant_beams as study_variant
from stiction.stages.contact import plasticity as study_plasticity
from stiction.stages.laws import forces as stage_forces
from stiction.stages.laws import humidity as study_humidity
from stiction.stages.laws import sample_sizes as study_sample_sizes
from stiction.stages.laws import sensitivity as study_sensitivity
from stiction.stages.surfaces import correlation as study_correlation
from stiction.streams import stream

RNG = stream(11)
START = RNG.bit_generator.state
#: Pair to the energy of its flats in saturated air [J m⁻²].
EVERY = defaultdict(lambda: 0.144)
BEAM = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 200)
LIMIT = 3e6
#: Markers of points; others are the caps of error bars.
MARKERS = tuple("os^vDPX<>p*")
#: Fourteen choices, those of one key next to each other; the first eight are about those of the paper's study.
CHOICES = (
    *("van_der_waals_dry", "van_der_waals_none", "psd_identified", "asperity_island", "every_2", "every_3", "every_4"),
    *("spacing_nm_5", "spacing_nm_20", "poisson_ratio_0.1", "poisson_ratio_0.18", "poisson_ratio_0.28"),
    *("poisson_ratio_0.35", "strips_per_element_2", "strips_per_element_4"),
)


def names(count, letter="p"):
    return [f"{letter}{k}" for k in range(count)]


def humidities(count):
    return [0.5] if count == 1 else np.linspace(0.44, 0.92, count).round(4).tolist()


def published(count):
    """Published values of the first pair, at no more than six humidities."""
    shown = np.array(humidities(count))[:: max(1, count // 6)]
    columns = {"pair": "p0", "relative_humidity": shown, "ng": 1100 - 800 * shown, "geo": 1110 - 800 * shown}
    return pd.DataFrame(columns | {"geo_std": 30.0, "experiment": 1150 - 800 * shown, "experiment_std": 30.0})


def stresses():
    columns = {"interference": 1e-9 * RNG.random(99), "radius": 1e-7 * RNG.random(99), "stress": 1e10 * RNG.random(99)}
    return study_plasticity.layout(columns | {"strip": np.arange(99) // 33}, (0.052, 0.0117), 2.25e-9, 5e7)


def sizes(count):
    distances = np.column_stack([0.5 / np.arange(1, count + 1), np.full(count, 0.01)])
    energy = np.linspace(0, 1e-2, 50)
    densities = 500 * np.exp(-(((energy - 5e-3) / 2e-3) ** 2)) * np.linspace(0.8, 1, count)[:, None]
    return study_sample_sizes.layout(energy, densities, 50 * (1 + np.arange(count)), distances)


def variant(count, shift):
    """Crack lengths at all humidities, changed by ``shift`` against the base [-]."""
    at = humidities(count)
    lengths = [1e-6 * (1100 - 800 * h) * (1 + shift + 0.01 * RNG.standard_normal(20)) for h in at]
    beams = [{"crack_length": length, "state": np.zeros(20, int)} for length in lengths]
    return study_variant.layout(at, [1e-2 * RNG.lognormal(0, 0.2, 40) for _ in beams], beams)


def mesh():
    curve = np.linspace(0, 2e-8, 60), RNG.random(60)
    arrests = [Arrest(7e-4, 3.6e-3), Arrest(7.1e-4, 3.7e-3)]
    return study_mesh.layout([(1.5e-5, 1.5e-6), (7.5e-6, 1.5e-6)], arrests, [2e6, 7e-9, 6e8, 1e9], curve)


def correlation(count):
    lag = np.linspace(0, 1e-6, 30)
    decay = 1e-7 * (1 + np.arange(count))
    return study_correlation.layout(names(count, "S"), lag, np.exp(-lag / decay[:, None]), 3 * decay)


def forces():
    vectors = np.array([7e-3, 2e6, 8e-9, 6.5e-9]) * (1 + 0.05 * RNG.standard_normal((21, 4)))
    distance = np.linspace(4e-9, 30e-9, 100)
    law = forcelaw.coefficients(vectors, LIMIT)
    return stage_forces.layout(vectors, LIMIT, distance, forcelaw.pressure(law[:, None], distance))


def released(humidity, share):
    """Twenty beams, a share of which is S-shaped, with cracks that are shorter in humid air."""
    stuck = np.arange(20) < round(20 * share)
    lengths = np.where(stuck, 1e-6 * (1100 - 800 * humidity) * RNG.uniform(0.95, 1.05, 20), BEAM.length)
    nodes = np.linspace(0, BEAM.length, 21)
    columns = {"sample": np.arange(20), "state": np.where(stuck, 0, 2), "crack_length": lengths}
    columns |= {"energy": apparent_adhesion_energy(lengths, BEAM), "imbalance": 0 * lengths, "iterations": stuck}
    return stage_beams.layout(columns | {"deflection": BEAM.gap * np.minimum(nodes / lengths[:3, None], 1)}, nodes)


def share(humidity, model):
    """Share of S-shaped beams: all in humid air, none of model G in dry air."""
    start = {"G": 0.45, "NG": 0.3, "GEO": 0.2}[model]
    return min(1, max(0, 2 * (humidity - start)))


def beams(count, models):
    return {(h, model): released(h, share(h, model)) for h in humidities(count) for model in models}


def bands():
    energies = np.linspace(2e-3, 5e-2, 9)[:, None] * RNG.lognormal(0, 0.3, (9, 50))
    axis = study_humidity.layout(np.linspace(0.44, 0.92, 9), np.array([0.05, 0.5, 0.95]), energies)
    return {"G": axis.assign(energy_quantile=0.2 * axis.energy_quantile), "NG": axis}


def figure_12(pairs, _count):
    laws = forcelaw.coefficients(stage_forces.vectors(forces())[0], LIMIT)
    return force_curves({pair: (forces(), forces(), laws) for pair in names(pairs)})


def figure_13(moments, count):
    at, known = humidities(count), ("rms", "skewness", "kurtosis")[:moments]
    slopes = {m: (np.full((2, len(at)), k + 1.0), np.full((2, len(at)), 0.1)) for k, m in enumerate(known)}
    energies = RNG.random((2, len(at), 5))
    found = {("b", m): study_sensitivity.layout(energies, (0.95, 1.05), slopes[m], slopes[m], at) for m in known}
    return figures_studies.sensitivities(found, {("b", m, at[-1]): -float(k) for k, m in enumerate(known)})


def figure_15(pairs, count):
    shown = {pair: (BEAM, beams(count, ("G", "NG", "GEO")), bands()) for pair in names(pairs)}
    return adhesion_energies(shown, published(count), EVERY)


def figure_16(pairs, _count):
    return figures_studies.summit_stresses({pair: stresses() for pair in names(pairs)})


def figure_17(pairs, count):
    errors = {(pair, rh): [0.1, 0.02, 2e-3, 0.0] for pair in names(pairs) for rh in humidities(count)}
    return figures_studies.sample_convergence(sizes(max(2, pairs)), errors, 1e-3)


def figure_19(surfaces, _count):
    return figures_studies.mesh_convergence(mesh(), correlation(surfaces))


def figure_overview(_pairs, count):
    axes = {name: (name, 1e-7 * np.arange(30)) for name in ("x", "y")}
    character = xr.Dataset({"elevation": (("x", "y"), 3e-9 * RNG.standard_normal((30, 30)))}, axes)
    return overview("p0", character, forces(), released(0.6, 1), beams(count, ("GEO",)), published(count))


def figure_variants(pairs, count, choices=3):
    some = ("base", *CHOICES[:choices])
    datasets = {(pair, name): variant(count, 0.03 * k) for pair in names(pairs) for k, name in enumerate(some)}
    return figures_studies.variants(datasets, published(count))


DRAW = {
    "12": figure_12,
    "13": figure_13,
    "15": figure_15,
    "16": figure_16,
    "17": figure_17,
    "19": figure_19,
    "overview": figure_overview,
    "variants": figure_variants,
}


def rows(cases):
    """Parameters of a test, by the names of the cases; those that take longer are slow tests."""
    return [
        pytest.param(case, marks=[pytest.mark.slow] * (case not in FAST), id="-".join(map(str, case))) for case in cases
    ]


#: Numbers of pairs or surfaces at two humidities; of humidities; of humidities and choices for some numbers of pairs.
OF_PAIRS = [(name, n, 2) for name in ("12", "15", "16", "17", "19", "variants") for n in (1, 2, 4, 7, 12)]
OF_HUMIDITIES = [("13", 3), ("15", 1), ("17", 2), ("overview", 1)]
OF_HUMIDITIES = [(name, pairs, n) for name, pairs in OF_HUMIDITIES for n in (1, 4, 25)]
OF_CHOICES = [("variants", pairs, n, choices) for pairs in (1, 5) for n in (1, 25) for choices in (9, 15)]
FAST = {("12", 1, 2), ("13", 3, 25), ("15", 1, 25), ("16", 1, 2), ("17", 4, 2), ("19", 4, 2), ("overview", 1, 25)}
FAST |= {("variants", 1, 25, 15)}
each_case = pytest.mark.parametrize("case", rows([*OF_PAIRS, *OF_HUMIDITIES, *OF_CHOICES]))


@cache
def drawn(case):
    """Figure of a case with the layout that it has in its files."""
    RNG.bit_generator.state = START
    name, *numbers = case
    figure = DRAW[name](*numbers)
    styled(figure.draw_without_rendering)()
    return figure


def panels(figure):
    """Panels of a figure with their insets."""
    return [panel for axes in figure.axes for panel in (axes, *axes.child_axes)]


@styled  # which holds for ticks that are made only when they are asked for
def texts(figure):
    """Boxes (n, 4) of all titles, labels, notes and legends of a figure: left, bottom, right, top [pixels]."""
    found = [legend for part in (figure, *figure.subfigs) for legend in part.legends]
    for axes in panels(figure):
        ticks = [tick.label1 for axis in (axes.xaxis, axes.yaxis) for tick in axis._update_ticks()]
        ticks += [tick.label2 for axis in (axes.xaxis, axes.yaxis) for tick in axis._update_ticks()]
        found += [axes.title, axes._left_title, axes._right_title, axes.xaxis.label, axes.yaxis.label, *axes.texts]
        found += [*ticks, *filter(None, [axes.get_legend()])]
    shown = [one for one in found if one.get_visible() and (not hasattr(one, "get_text") or one.get_text())]
    return np.array([one.get_window_extent().extents for one in shown])


def faults(figure):
    """Texts that leave a figure, and pairs of texts that cover each other by more than their margins."""
    left, bottom, right, top = boxes = texts(figure).T
    width, height = figure.get_size_inches() * figure.dpi
    outside = (left < -2) | (bottom < -2) | (right > width + 2) | (top > height + 2)
    # Boxes are higher than digits, which reach neither as high as b nor as low as g.
    wide, high = 0.01 * (right - left), 0.15 * (top - bottom)
    a, b = boxes[:, :, None], boxes[:, None]
    covered = (a[0] + wide[:, None] < b[2]) & (b[0] < a[2] - wide[:, None])
    covered &= (a[1] + high[:, None] < b[3]) & (b[1] < a[3] - high[:, None])
    return [*np.flatnonzero(outside), *np.argwhere(np.triu(covered | covered.T, 1))]


def curves(panel):
    """Label and line of each curve of a panel that a legend names."""
    for curve, label in zip(*panel.get_legend_handles_labels(), strict=True):
        line = curve[0] if isinstance(curve, ErrorbarContainer) else curve
        if isinstance(line, Line2D):
            yield label, line


def alike(panel):
    """Sets of labels of a panel whose curves look alike."""
    looks = {}
    for label, line in curves(panel):
        look = line.get_color(), line.get_marker(), line.get_fillstyle(), line._unscaled_dash_pattern
        looks.setdefault(str(look), set()).add(label)
    return [labels for labels in looks.values() if len(labels) > 1]


def hidden(panel):
    """Points with a marker that are outside the limits of a panel or below its legend [pixels]."""
    lines = [line for line in panel.lines if line.get_marker() in MARKERS]
    found = [line.get_transform().transform(np.array(line.get_xydata(), float)) for line in lines]
    points = np.concatenate([np.empty((0, 2)), *found])
    points = points[np.isfinite(points).all(axis=1)]
    legends = [legend.get_window_extent() for legend in filter(None, [panel.get_legend()])]
    inside = panel.bbox.padded(1)
    return [p for p in points if not inside.contains(*p) or any(legend.contains(*p) for legend in legends)]


@each_case
def test_no_text_covers_another_or_leaves_the_figure(case):
    assert not faults(drawn(case))


@each_case
def test_no_two_curves_of_a_panel_look_alike_and_all_points_are_within_it(case):
    assert not any(map(alike, panels(drawn(case))))
    assert not any(map(hidden, drawn(case).axes))


def is_in_column(note, panel):
    """Whether a note is in the column of numbers to the right of a panel, and inside the figure."""
    box = note.get_window_extent()
    return note.xy[0] == 1 and panel.bbox.x1 < box.x0 and box.x1 < panel.figure.bbox.x1


@each_case
def test_notes_stay_within_their_panel(case):
    for panel in panels(drawn(case)):
        for note in panel.texts:
            box = note.get_window_extent()
            assert panel.bbox.x0 < box.x0
            assert box.x1 < panel.bbox.x1 or is_in_column(note, panel)


def shown(figure, label):
    """Numbers of points of the curves of a label, panel by panel."""
    return [len(line.get_xdata()) for panel in figure.axes for name, line in curves(panel) if name == label]


@pytest.mark.parametrize("case", rows(OF_HUMIDITIES))
def test_every_humidity_of_every_curve_is_shown(case):
    name, pairs, count = case
    label = {"13": "skewness, ± standard error", "15": "GEO: beams, mean ± std", "overview": "computed here"}
    if name == "17":
        assert len(drawn(case).axes[1].lines) == pairs + 1
        assert {len(line.get_xdata()) for line in drawn(case).axes[1].lines[:-1]} == {count}
    else:
        assert shown(drawn(case), label[name]) == [count] * (1 + (name == "13"))


@pytest.mark.parametrize("case", rows(case for case in OF_HUMIDITIES if case[0] == "15"))
def test_figure_15_shows_the_share_of_every_model_at_every_humidity(case):
    at = humidities(case[2])
    below = [panel for panel in drawn(case).axes if "share" in panel.get_title("left")]
    for panel, models in zip(below, (("G", "NG"), ("GEO",)), strict=True):
        for line, model in zip(panel.lines, models, strict=True):
            np.testing.assert_allclose(line.get_data(), [at, [100 * round(20 * share(h, model)) / 20 for h in at]])
    assert not any(panel.texts for panel in drawn(case).axes)


@pytest.mark.parametrize(("dry", "apart"), [((0.5, 0.6), True), ((0.5, 0.54), False)])
def test_shares_are_labels_where_these_are_apart_and_panels_elsewhere(dry, apart):
    found = {(h, "G"): released(h, 0.5 if h < 0.9 else 1) for h in (*dry, 0.9)}
    figure = adhesion_energies({"p1": (BEAM, found, bands())}, published(2), EVERY)
    assert [text.get_text() for text in figure.axes[0].texts] == (["50 %", "50 %"] if apart else [])
    assert len(figure.axes) == (2 if apart else 4)


def test_the_share_of_nearly_all_beams_is_not_stated_as_all():
    nearly = released(0.5, 1).isel(beam=np.arange(1000) % 20)
    nearly.state[0] = 2
    figure = adhesion_energies({"p1": (BEAM, {(0.5, "G"): nearly}, bands())}, published(1), EVERY)
    assert [text.get_text() for text in figure.axes[0].texts] == ["> 99 %"]


@pytest.mark.parametrize("case", rows(OF_CHOICES))
def test_every_choice_is_a_row_of_every_pair(case):
    _, pairs, _, choices = case
    panels_of = drawn(case).axes
    labels = [figures_studies.variant_label(name) for name in CHOICES[:choices]]
    assert [text.get_text() for text in panels_of[0].get_yticklabels()] == labels
    assert [len(panel.containers) for panel in panels_of] == [choices] * pairs


@pytest.mark.parametrize("case", rows(OF_PAIRS))
def test_every_pair_surface_and_number_of_samples_has_its_curve_or_panel(case):
    name, count, _ = case
    axes = drawn(case).axes
    panels_of = {"12": 3 * count, "15": 4 * count, "16": count + 1, "17": 3, "19": 3, "variants": count}
    assert len(axes) == panels_of[name]
    if name == "17":
        assert len(axes[0].lines) == max(2, count)
        assert len(axes[1].lines) == count + 1
        looks = [(line.get_color(), line.get_linestyle(), line.get_marker()) for line in axes[1].lines[:count]]
        assert len(set(looks)) == count
    if name == "19":
        assert len(axes[2].lines) == count


def test_the_checks_find_texts_that_meet_or_leave_curves_that_look_alike_and_hidden_points():
    figure = Figure(figsize=(4, 4), dpi=100)
    panel = figure.subplots()
    for label in ("a", "b"):
        panel.plot([0.2, 0.8], [0.5, 0.5], "o-", color="black", label=label)
    panel.legend(loc="upper right")
    panel.set(xlim=(0, 0.5), ylim=(0, 1))
    panel.text(0.2, 0.3, "one")
    assert not faults(figure)
    panel.text(0.22, 0.32, "two")
    assert len(faults(figure)) == 1
    panel.text(0.5, 0.1, "beyond the right edge")
    assert len(faults(figure)) == 2
    assert alike(panel) == [{"a", "b"}]
    assert len(hidden(panel)) == 2
    panel.set(xlim=(0, 1), ylim=(0, 0.55))
    panel.legend(loc="upper right", bbox_to_anchor=(0.9, 1.0))
    assert len(hidden(panel)) == 2
