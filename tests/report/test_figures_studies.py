"""Figures and tables of the studies show the numbers of their datasets; equal data give equal files."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

from stiction.analysis.convergence import KOLMOGOROV_MEAN, sampling_distance
from stiction.analysis.mesh import Arrest
from stiction.config.files import load
from stiction.plan.graph import Graph
from stiction.plan.plan import Plan
from stiction.plan.stage import At
from stiction.report import published
from stiction.report.studies import figures as figures_studies
from stiction.report.studies import tables as tables_studies
from stiction.report.style import save
from stiction.stages.beams import mesh as study_mesh
from stiction.stages.beams import variant_beams as study_variant
from stiction.stages.contact import plasticity as study_plasticity
from stiction.stages.laws import orders as study_orders
from stiction.stages.laws import sample_sizes as study_sample_sizes
from stiction.stages.laws import sensitivity as study_sensitivity
from stiction.stages.surfaces import correlation as study_correlation

SKEWED = {"surfaces.B2.skewness": [-0.5, -0.76], "surfaces.B2.kurtosis": [3.4, 3.9]}
ENDS = ["Kurtosis3p4Skewnessm0p5", "Kurtosis3p9Skewnessm0p76"]
STATISTICS = ("mean", "standard deviation")
HUMIDITIES = (0.5, 0.8)
RNG = np.random.default_rng(0)
PUBLISHED = pd.DataFrame(
    {
        "pair": ["a"] * 3 + ["b"] * 3,
        "relative_humidity": [0.5, 0.7, 0.8] * 2,
        "ng": [800.0, 600.0, 400.0] * 2,
        "experiment": [820.0, 590.0, 410.0] * 2,
        "experiment_std": [30.0, 20.0, 10.0] * 2,
    }
)


def sensitivity(slope):
    errors = np.full((2, 2), 0.1)
    energies = RNG.random((2, 2, 5))
    sides = slope * np.array([[1.5, 1.2], [0.7, 0.9]]), errors
    return study_sensitivity.layout(energies, (0.95, 1.05), (np.full((2, 2), slope), errors), sides, HUMIDITIES)


def variant(length_um, energy=1.0, free=0):
    """Dataset of two humidities with 40 samples and 20 beams, ``free`` of which are free."""
    rng = np.random.default_rng(1)
    beams = [
        {
            "crack_length": length * 1e-6 * (1 + 0.01 * rng.standard_normal(20)),
            "state": np.where(np.arange(20) < free, 2, 0),
        }
        for length in length_um
    ]
    energies = [energy * 1e-2 * np.exp(0.2 * rng.standard_normal(40)) for _ in beams]
    return study_variant.layout(HUMIDITIES, energies, beams)


def test_the_axis_of_fig_13_ends_at_saturated_air():
    humid = {("b", "rms"): sensitivity(0.5).assign_coords(humidity=[0.8, 0.99])}
    for panel in figures_studies.sensitivities(humid, {}).axes:
        assert 0.99 < panel.get_xlim()[1] <= 1


VARIANTS = {
    ("a", "base"): variant((800, 440)),
    ("a", "van_der_waals_none"): variant((880, 400), 0.8),
    ("b", "base"): variant((700, 500)),
    ("b", "van_der_waals_none"): variant((800, 400), 0.8),
}


def plasticity(share):
    columns = {name: RNG.random(300) * 1e-9 for name in ("interference", "radius")}
    columns |= {"stress": RNG.random(300) * 1e10, "strip": np.arange(300) // 100}
    return study_plasticity.layout(columns, (share, 0.1 * share), 2e-9, 5e7)


def sizes():
    return study_sample_sizes.layout(np.linspace(0, 1e-2, 50), RNG.random((3, 50)), (5, 10, 20), RNG.random((3, 2)))


def orders(dimension, last):
    shape = (last, dimension, 16)
    return study_orders.layout(
        np.linspace(-4, 4, 17),
        RNG.random(shape[1:]),
        RNG.random(shape),
        RNG.random((2, *shape[:2])),
        (50, 400),
        [0] * dimension,
    )


def mesh(*arrests):
    law, distance = [2e6, 7e-9, 6e8, 1e9], np.linspace(0, 2e-8, 60)
    return study_mesh.layout([(1.5e-5, 1.5e-6), (7.5e-6, 1.5e-6)], arrests or ARRESTS, law, (distance, RNG.random(60)))


ARRESTS, NONE = [Arrest(7e-4, 6e-3), Arrest(7.1e-4, 5.9e-3)], Arrest(np.nan, np.nan)


def correlation():
    return study_correlation.layout(["B1"], np.linspace(0, 1e-6, 9), RNG.random((1, 9)), [3e-7])


DRAWN = {
    "13": lambda: figures_studies.sensitivities({("b", "rms"): sensitivity(-6.0)}, {("b", "rms", 0.5): -6.5}),
    "16": lambda: figures_studies.summit_stresses({"a": plasticity(0.0), "c": plasticity(0.5)}),
    "16 of one pair": lambda: figures_studies.summit_stresses({"c": plasticity(0.5)}),
    "17": lambda: figures_studies.sample_convergence(sizes(), {("a", 0.5): [0.1, 0.01, 1e-3, 0.0]}, 1e-3),
    "18": lambda: figures_studies.order_convergence(orders(4, 12)),
    "18 of few coordinates": lambda: figures_studies.order_convergence(orders(1, 2)),
    "19": lambda: figures_studies.mesh_convergence(mesh(), correlation()),
    "19 of a beam that does not stick": lambda: figures_studies.mesh_convergence(mesh(NONE, NONE), correlation()),
    "variants": lambda: figures_studies.variants(VARIANTS, PUBLISHED),
    "variants without published values": lambda: figures_studies.variants(VARIANTS, PUBLISHED[:0]),
}


@pytest.mark.parametrize("name", DRAWN)
def test_every_figure_can_be_drawn(name, tmp_path):
    save(DRAWN[name](), tmp_path / "figure.pdf", tmp_path / "figure.png")
    assert (tmp_path / "figure.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "figure.png").read_bytes().startswith(b"\x89PNG")


def test_equal_data_give_equal_files(tmp_path):
    paths = [tmp_path / f"{k}.pdf" for k in range(2)]
    for path in paths:
        save(figures_studies.variants(VARIANTS, PUBLISHED), path)
    assert paths[0].read_bytes() == paths[1].read_bytes()


def heights(panel):
    """Ordinates of the curves of a panel that have a marker of a moment."""
    return [line.get_ydata() for line in panel.get_lines() if line.get_marker() not in ("None", "_", "|", ".")]


def test_figure_13_shows_slopes_and_published_values():
    panel = figures_studies.sensitivities({("b", "rms"): sensitivity(-6.0)}, {("b", "rms", 0.5): -6.5}).axes[0]
    assert [list(np.atleast_1d(y)) for y in heights(panel)] == [[-6.0, -6.0], [-6.5]]
    names = [text.get_text() for text in panel.figure.legends[0].get_texts()]
    assert names == ["rms, ± standard error", "one-sided slopes of the mean: moment down to moment up (dot)"]


def test_a_line_of_figure_13_leads_through_its_point_from_less_to_more_of_the_moment():
    moments = {("b", name): sensitivity(slope) for name, slope in (("rms", -6.0), ("skewness", -3.0))}
    panel = figures_studies.sensitivities(moments, {}).axes[0]
    lines = [line for line in panel.get_lines() if line.get_marker() == "."]
    expected = np.concatenate([slope * np.array([[1.5, 0.7], [1.2, 0.9]]) for slope in (-6, -3)])
    np.testing.assert_allclose([line.get_ydata() for line in lines], expected)
    assert [list(line.get_xdata()) for line in lines] == [[humidity] * 2 for humidity in HUMIDITIES] * 2
    assert {tuple(line.get_markevery()) for line in lines} == {(1,)}, "a dot at more of the moment alone"
    curves = [line for line in panel.get_lines() if line.get_marker() in ("o", "s")]
    shifts = [line.get_transform().transform((0.5, -6)) - panel.transData.transform((0.5, -6)) for line in lines]
    np.testing.assert_allclose(shifts[0], -shifts[2], atol=1e-9)
    for curve, line in zip(curves, lines[::2], strict=True):
        np.testing.assert_allclose(*(one.get_transform().transform((0.5, -6)) for one in (curve, line)))
    assert shifts[0][0] < 0 == shifts[0][1]
    low, high = panel.get_ylim()
    assert low < expected.min() < expected.max() < high


def bars(panel):
    """Half lengths of the error bars of a panel."""
    (container,) = panel.containers[:1]
    return [np.ptp(segment[:, 1]) / 2 for segment in container[2][0].get_segments()]


@pytest.mark.parametrize("pair", ["a", "b"])
def test_only_the_pair_of_published_sensitivities_is_compared_with_them(pair):
    job = Graph(Plan(load({"figures": {"pair": pair}}))).job("figures/figure_13.png")
    found = {moment: sensitivity(-6.0) for moment in job.inputs["studies"]}
    panel = job.compute({"studies": found, "published": job.inputs["published"]}).axes[0]
    assert [note.get_text() for note in panel.texts] == (["paper, kurtosis", "paper, skewness"] if pair == "b" else [])


def test_error_bars_of_figure_13_are_standard_errors():
    assert_allclose(bars(figures_studies.sensitivities({("b", "rms"): sensitivity(-6.0)}, {}).axes[0]), 0.1)


def test_figure_16_shows_the_onset_of_the_hardest_pair():
    hard = plasticity(0.0).assign(hardness=40e9)
    panel, *_ = figures_studies.summit_stresses({"a": plasticity(0.0), "b": hard}).axes
    assert panel.get_ylim()[1] == pytest.approx(1.15 * 0.6 * 40)


def test_figure_17_shows_the_law_of_a_part_of_all_samples_and_the_tolerance():
    tolerance = 1e-6
    figure = figures_studies.sample_convergence(sizes(), {("a", 0.5): [0.1, 0.01, 1e-3, 1e-4]}, tolerance)
    _, errors, distances = figure.axes
    assert errors.get_ylim()[0] <= tolerance / 2
    law, own = (line.get_xydata().T for line in distances.get_lines() if line.get_linestyle() in ("--", ":"))
    assert_allclose(law[1], KOLMOGOROV_MEAN * np.sqrt(1 / law[0] - 1 / 20))
    assert_allclose(own[1], sampling_distance(20))


def test_figure_16_shows_the_onset_of_yield_and_the_share_beyond():
    for found, label in ((plasticity(0.0), "none yields"), (plasticity(0.5), "yielding: 50.0 ± 5.0 %")):
        panel = figures_studies.summit_stresses({"c": found}).axes[0]
        assert label in [text.get_text() for text in panel.texts]
        assert_allclose(panel.get_lines()[0].get_ydata(), 0.6 * 12.8)


def test_figure_16_labels_pairs_without_contact():
    empty = plasticity(0.0).isel(summit=slice(0)).assign(plastic_share=np.nan, plastic_share_error=np.nan)
    panels = figures_studies.summit_stresses({"a": empty, "c": plasticity(0.5)}).axes
    assert "hardly any contact" in [text.get_text() for text in panels[0].texts]
    assert figures_studies.summit_stresses({"a": empty})


def test_figure_18_shows_the_error_of_the_samples():
    panel = figures_studies.order_convergence(orders(2, 4)).axes[-1]
    assert any(np.allclose(line.get_ydata(), sampling_distance(50, 400)) for line in panel.get_lines())


def test_figure_18_shows_the_distance_of_every_coordinate_at_every_order():
    found = orders(2, 4)
    *shown, _ = (line.get_xydata().T for line in figures_studies.order_convergence(found).axes[-1].get_lines())
    for eta, points in zip(found.eta, shown, strict=True):
        assert_allclose(points, [found.order, found.distance.sel(target="kernels", eta=eta)])


@pytest.mark.parametrize(("dimension", "marginals"), [(1, 1), (2, 2), (3, 3), (4, 3)])
def test_figure_18_has_a_panel_for_each_coordinate_and_one_for_the_distances(dimension, marginals):
    figure = figures_studies.order_convergence(orders(dimension, 2))
    assert [panel.get_title(loc="left") for panel in figure.axes] == [
        *(rf"({'abc'[k]}) marginal of $\eta_{k + 1}$" for k in range(marginals)),
        f"({'abcd'[marginals]}) distance from the kernel density",
    ]
    assert all(panel.get_lines() or panel.patches for panel in figure.axes)
    assert figure.get_figheight() == (4.4 if dimension > 1 else 2.2)


def test_figure_16_has_one_scale_of_stress_and_of_number_for_all_pairs():
    *panels, bar = figures_studies.summit_stresses({"a": plasticity(0.0), "c": plasticity(0.5)}).axes
    assert panels[0].get_ylim() == panels[1].get_ylim()
    cells = [panel.collections[0] for panel in panels]
    assert [found.get_array().sum() for found in cells] == [300, 300]
    assert cells[0].norm is cells[1].norm
    assert_allclose(bar.get_ylim(), (1, max(found.get_array().max() for found in cells)))


def test_figure_17_always_shows_the_tolerance():
    for tolerance in (1e-6, 1.0):
        panel = figures_studies.sample_convergence(sizes(), {("a", 0.5): [0.1, 0.01, 0.0]}, tolerance).axes[1]
        low, high = panel.get_ylim()
        assert low < min(tolerance, 0.01)
        assert high > max(tolerance, 0.1)


def test_figure_19_shows_gamma_over_the_energy_of_the_law_beside_the_difference_of_the_paper():
    panel = figures_studies.mesh_convergence(mesh(), correlation()).axes[1]
    energy = 2e6 * (1.5 / 1e9 + 0.5 / 6e8)
    assert_allclose(heights(panel)[0], 100 * (np.array([6e-3, 5.9e-3]) / energy - 1))
    (shaded,) = panel.patches
    assert_allclose([shaded.get_y(), shaded.get_y() + shaded.get_height()], [-2.5, 2.5])  # %, stated in the paper
    low, high = panel.get_ylim()
    assert low < min(heights(panel)[0])
    assert high > max(heights(panel)[0])
    of_panels = figures_studies.mesh_convergence(mesh(), correlation()).axes
    named = [[text.get_text() for text in each.get_legend().get_texts()] for each in of_panels[1:]]
    assert {"paper's 2.5 %", "axis linear below 2.5 %"} <= set(named[0])
    assert "all beyond $l^m$: ± 0.01" in named[1]


def lines_of(panel):
    """Places of the vertical lines of a panel by their label."""
    return {line.get_label(): line.get_xdata()[0] for line in panel.lines if len(set(line.get_xdata())) == 1}


def test_published_and_measured_crack_lengths_are_lines_relative_to_the_base():
    base = VARIANTS["a", "base"].isel(humidity=0).crack_length.values.mean() * 1e6
    found = lines_of(figures_studies.variants(VARIANTS, PUBLISHED).axes[0])
    of_base = f"base: beams on {VARIANTS['a', 'base'].sizes['strip']} samples"
    known = {of_base: 0, "published": 100 * (800 / base - 1), "measured ± standard deviation": 100 * (820 / base - 1)}
    assert {label: found[label] for label in known} == pytest.approx(known)
    without = lines_of(figures_studies.variants(VARIANTS, PUBLISHED[:0]).axes[0])
    assert not {"published", "measured ± standard deviation"} & without.keys()


def test_variants_are_compared_with_base_published_and_measured_values():
    table = tables_studies.variants(VARIANTS, PUBLISHED).frame
    row = table[(table.pair == "a") & (table.variant == "van_der_waals_none")].iloc[0]
    assert_allclose(row.shift_percent, 10, rtol=1e-9)
    assert_allclose(row.meso_energy_shift_percent, -20, rtol=1e-9)
    mean = VARIANTS["a", "van_der_waals_none"].crack_length[0].values.mean() * 1e6
    assert_allclose(row.crack_length_um, mean)
    assert_allclose(row.published_deviation_percent, 100 * (mean / 800 - 1))
    assert_allclose(row.experiment_deviation_percent, 100 * (mean / 820 - 1))
    assert row.share_s_shape == 1


def test_dots_of_the_variants_are_the_numbers_of_the_table_at_the_lowest_humidity():
    table = tables_studies.variants(VARIANTS, PUBLISHED).frame.set_index(["pair", "variant"])
    panel = figures_studies.variants(VARIANTS, PUBLISHED).axes[1]
    row = table.loc["b", "van_der_waals_none"].iloc[0]
    (dot,) = (line for line in panel.lines if line.get_marker() == "o")
    assert_allclose(list(dot.get_xdata()), row.shift_percent)
    (segment,) = panel.containers[0][2][0].get_segments()
    assert_allclose(np.ptp(segment[:, 0]) / 2, row.shift_se_percent)
    assert [label.get_text() for label in figures_studies.variants(VARIANTS, PUBLISHED).axes[0].get_yticklabels()] == [
        figures_studies.variant_label("van_der_waals_none")
    ]


def test_variants_of_pairs_of_the_paper_are_compared_with_what_was_published():
    job = Graph(Plan(load())).job("figures/variants.png")
    found = {(*key, k): each.isel(humidity=k) for key, each in VARIANTS.items() for k in range(len(HUMIDITIES))}
    found = {(pair, HUMIDITIES[k], name): each for (pair, name, k), each in found.items()}
    figure = job.compute({"studies": found, "published": job.inputs["published"]})
    assert len(figure.axes) == 2


def test_free_beams_are_counted_and_not_averaged():
    datasets = {("a", "base"): variant((800, 440), free=5)}
    first = tables_studies.variants(datasets, PUBLISHED).frame.iloc[0]
    assert first.share_s_shape == 0.75
    assert_allclose(first.crack_length_um, datasets["a", "base"].crack_length[0].values[5:].mean() * 1e6)


def test_the_summary_states_the_share_of_the_published_deviation_that_a_variant_removes():
    table = tables_studies.variants(VARIANTS, PUBLISHED)
    lines = table.markdown.splitlines()
    table = table.frame
    (line,) = (line for line in lines if line.replace(" ", "").startswith("|a|") and "van der Waals: none" in line)
    base, other = (
        np.mean(table[(table.pair == "a") & (table.variant == name)].published_deviation_percent ** 2)
        for name in ("base", "van_der_waals_none")
    )
    shown, error = map(float, line.split("|")[-2].split(" ± "))
    assert abs(shown - 100 * (1 - other / base)) < error
    rms = float(line.split("|")[-4].split(" ± ")[0])
    assert rms == pytest.approx(np.sqrt(other), rel=0.1)


def test_a_summary_without_published_values_leaves_them_out():
    lines = tables_studies.variants(VARIANTS, PUBLISHED[:0]).markdown.splitlines()
    assert all(line.split("|")[-2].strip() == "–" for line in lines[4:])


def test_published_sensitivities_are_in_the_row_of_their_moment_and_humidity():
    published = pd.DataFrame({"pair": ["b"], "relative_humidity": [0.5], "moment": ["rms"], "slope": [-6.5]})
    table = tables_studies.sensitivity(
        {("b", "rms"): sensitivity(-6.0), ("b", "kurtosis"): sensitivity(-5.0)}, published
    )
    known = table.frame[table.frame.published.notna()]
    assert len(table.frame) == 16
    assert known[["relative_humidity", "statistic", "moment", "published"]].to_numpy().tolist() == [
        [0.5, name, "rms", -6.5] for name in ("mean", "mean, -5 %", "mean, +5 %")
    ]
    for slope in ("-6.00", "-9.00", "-4.20"):
        assert f"{slope} ± 0.10 (-6.5)" in table.markdown


def test_the_table_of_fig_13_is_of_the_pair_of_its_plan_and_has_the_slopes_of_its_studies():
    data = {
        "studies": {("b", "rms"): sensitivity(-6.0)},
        "published": Path(published.__file__).with_name("resources") / "sensitivity.csv",
    }
    stage = tables_studies.STAGES[0]
    table = stage.result(data, At(), {"of_paper": ["b"]})
    assert set(table.frame.pair) == {"b"}
    central = table.frame.statistic.isin(STATISTICS)
    assert set(table.frame.slope[central]) == {-6.0}


def test_copies_of_a_pair_are_side_by_side_in_figure_13_and_its_table():
    compare = {"compare": SKEWED, "run": {"pairs": ["b", "c"]}}
    graph, copies = Graph(Plan(load(compare))), [*(f"b{end}" for end in ENDS)]
    figure, table = (graph.job(name) for name in ("figures/figure_13.png", "tables/sensitivity.csv"))
    moments = ("rms", "skewness", "kurtosis")
    assert list(figure.inputs["studies"]) == [(pair, moment) for pair in copies for moment in moments]
    slopes = {at: sensitivity(-6.0 if at[0] == copies[0] else -4.0) for at in figure.inputs["studies"]}
    data = {"studies": slopes, "published": figure.inputs["published"]}
    axes = figure.compute(data).axes
    shown = [f"{what} of $\\bar e$, pair {pair}" for pair in copies for what in STATISTICS]
    titles = [f"({mark}) {text}" for mark, text in zip("abcd", shown, strict=True)]
    assert [panel.get_title(loc="left") for panel in axes] == titles
    assert {tuple(panel.containers[0].lines[0].get_ydata()) for panel in axes[:2]} == {(-6.0, -6.0)}
    assert {tuple(panel.containers[0].lines[0].get_ydata()) for panel in axes[2:]} == {(-4.0, -4.0)}
    cells = table.compute(data).cells
    assert list(dict.fromkeys(cells.pair)) == copies
    assert set(graph.job("tables/table_2.csv").inputs["identifications"]) >= {f"B2{end}" for end in ENDS}


def test_the_figure_of_one_pair_shows_it_alone_whatever_else_is_compared():
    compare = {"compare": {"surfaces.B1.rms_nm": [1.5, 2]}, "run": {"pairs": ["a", "b"]}, "figures": {"pair": "b"}}
    assert {pair for pair, _ in Plan(load(compare)).sensitivities} == {"b"}
    dry = {"pairs": {"b": {"humidities": [0, 0.5]}}, "run": {"pairs": ["b"]}}
    assert {pair for pair, _ in Plan(load(dry)).sensitivities} == {"b"}


def test_figure_17_shows_the_variance_lost_without_the_last_coordinate_at_every_humidity():
    errors = {(pair, rh): [0.1, 0.01, 1e-3 * rh, 1e-4] for pair in "ab" for rh in (0.9, 0.5)}
    panel = figures_studies.sample_convergence(sizes(), errors, 1e-6).axes[1]
    for line in panel.lines[:2]:
        assert_allclose(line.get_xydata(), [[0.5, 5e-4], [0.9, 9e-4]])
    assert "$N_g$ = 3" in panel.get_title("left")
    assert panel.get_legend_handles_labels()[1][-1] == "tolerance,\nabove: 4 kept"


def test_figure_18_shows_the_cumulative_probabilities_of_samples_and_orders():
    found = orders(3, 12)
    panel = figures_studies.order_convergence(found).axes[0]
    width = float(found.position[1] - found.position[0])
    of_eta = found.sel(eta=found.eta[0])
    known = [of_eta.input_density, *(of_eta.density.sel(order=order) for order in (2, 4, 8, 12))]
    for line, density in zip(panel.lines, known, strict=True):
        assert_allclose(line.get_ydata(), width * np.cumsum(density.values))
