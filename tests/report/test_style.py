"""Figures show the numbers of their datasets, in the units of their axes, and are equal byte for byte."""

import re
from collections import defaultdict
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from legends import covering
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.container import ErrorbarContainer
from plans import job_settings
from published import SURFACES

from stiction.beam.cantilever import Beam
from stiction.config.files import load
from stiction.contact import forcelaw
from stiction.plan.plan import Plan
from stiction.report.beams.figures import adhesion_energies, beam_shapes, energies_with_bars
from stiction.report.laws.figures import fitted_curve, force_curves, typical
from stiction.report.style import humidity_axis, humidity_colours, letter, panels, save
from stiction.report.surfaces.figures import elevation_maps, height_densities, profiles, spectra, summits
from stiction.stages.beams import beams as stage_beams
from stiction.stages.laws import fit as study_fit
from stiction.stages.laws import forces as stage_forces
from stiction.stages.laws import humidity as study_humidity
from stiction.stages.surfaces import character as stage_character
from stiction.stages.surfaces import heights as stage_heights
from stiction.stages.surfaces import iteration as study_iteration
from stiction.stages.surfaces import spectrum as stage_spectrum
from stiction.streams import stream

BEAM = Beam(1500e-6, 30e-6, 2.6e-6, 164e9, 20e-6, 200)
HUMIDITIES = (0.5, 0.7)
LIMIT = 3e6

#: 2γ of water at 300 K, of flats in saturated air [J m⁻²].
FLAT = 0.144
EVERY = defaultdict(lambda: FLAT)  #: pair to it


@pytest.fixture(scope="module")
def heights():
    moments = {name: stage_heights.Settings(s.rms, s.skewness, s.kurtosis) for name, s in SURFACES.items()}
    return {name: stage_heights.layout(s.density, moments[name]) for name, s in SURFACES.items()}


@pytest.fixture(scope="module")
def spectrum():
    s = SURFACES["B2"]
    return stage_spectrum.layout(s.spectrum, s.underlying, s.underlying, s.defect)


def character(rms, seed=0):
    """Statistics of a surface, from random numbers."""
    rng = stream(seed)
    zeta = 2 * np.pi / 10.24e-6 * np.arange(1, 300)
    return stage_character.layout(
        {"power": np.ones((3, 4)), "summit_density": np.ones(3), "mean_curvature": np.ones(3)},
        (zeta, rms**2 * 1e-15 * rng.uniform(1, 2, (4, len(zeta)))),
        (rms * rng.standard_normal(500), 1e6 * np.exp(rng.standard_normal(500))),
        (10e-9, rms * rng.standard_normal((12, 8))),
    )


@pytest.fixture(scope="module")
def characters():
    return {name: character(s.rms, seed) for seed, (name, s) in enumerate(SURFACES.items())}


@pytest.fixture(scope="module")
def iteration(spectrum):
    zeta, target = spectrum.wavenumber.values[1:-1], spectrum.target.values[1:-1]
    periodograms = target * stream(1).uniform(0.8, 1.2, (3, 5, len(zeta)))
    misfits = {"misfit": [0.3, 0.2, 0.1], "sampling_misfit": [0.02, 0.02, 0.02], "closed_form_misfit": 0.001}
    return study_iteration.layout((zeta, target), (np.tile(target, (3, 1)), periodograms), misfits)


def population(n, seed=2):
    """Force curves that follow Eq. (12) up to a ripple; samples of stage forces."""
    vectors = np.array([7e-3, 2e6, 8e-9, 6.5e-9]) * (1 + 0.05 * stream(seed).standard_normal((n, 4)))
    distance = np.linspace(4e-9, 30e-9, 600)
    law = forcelaw.coefficients(vectors, LIMIT)
    ripple = 1 + 0.1 * np.linspace(0, 1, n)[:, None] * np.sin(distance / 1e-9)
    return stage_forces.layout(vectors, LIMIT, distance, forcelaw.pressure(law[:, None], distance) * ripple)


@pytest.fixture(scope="module")
def forces():
    return population(30)


@pytest.fixture(scope="module")
def fit(forces):
    curves = forces.force.values.astype(float)
    errors = forcelaw.fit_errors(
        forces.distance.values, lambda k: curves[k], range(30), stage_forces.vectors(forces)[0], LIMIT
    )
    return study_fit.layout(np.arange(30), errors, 30)


def released(lengths, states=None):
    """Beams with given crack lengths [m]; S-shaped by default."""
    lengths = np.asarray(lengths, float)
    nodes = np.linspace(0, BEAM.length, 21)
    columns = {
        "sample": np.arange(len(lengths)),
        "state": np.zeros(len(lengths), int) if states is None else states,
        "crack_length": lengths,
        "energy": energies_with_bars(lengths, 0 * lengths, BEAM)[0],
        "imbalance": 0 * lengths,
        "iterations": np.ones(len(lengths), int),
        "deflection": BEAM.gap * np.minimum(nodes / lengths[:3, None], 1),
    }
    return stage_beams.layout(columns, nodes)


@pytest.fixture(scope="module")
def pairs():
    def cases():
        for humidity in HUMIDITIES:
            for model in ("G", "NG", "GEO"):
                states = [0, 0, 0, 2] if (model, humidity) == ("G", 0.7) else 4 * [2 * (model == "G")]
                yield (humidity, model), released([600e-6, 650e-6, 700e-6, 800e-6], states)

    energies = stream(3).lognormal(-5, 0.3, (5, 400))
    axes = {
        model: study_humidity.layout(np.linspace(0.5, 0.7, 5), np.array([0.05, 0.5, 0.95]), scale * energies)
        for model, scale in (("G", 0.2), ("NG", 1))
    }
    return {name: (BEAM, dict(cases()), axes) for name in ("b", "mine")}


@pytest.fixture(scope="module")
def published():
    row = {"pair": "b", "relative_humidity": 0.5, "experiment": 700.0, "experiment_std": 50.0, "ng": 710, "geo": 720}
    return pd.DataFrame([row, row | {"relative_humidity": 0.7, "experiment": 600.0}])


@pytest.fixture(scope="module")
def drawn(heights, spectrum, characters, iteration, forces, fit, pairs, published):
    """All figures by name; a warning of matplotlib is an error."""
    both = {"G": characters["B1"], "NG": characters["B2"]}
    laws = forcelaw.coefficients(stage_forces.vectors(forces)[0][:7], LIMIT)
    return {
        "05": fitted_curve(forces, fit),
        "07": height_densities(heights),
        "08": elevation_maps(characters),
        "09": profiles("B2", both),
        "10": spectra({name: (heights["B2"], spectrum, characters["B2"], iteration) for name in SURFACES}),
        "11": summits({"B2": both}),
        "12": force_curves({"a": (forces, population(30, 5), laws), "b": (forces, forces, laws)}),
        "14": beam_shapes(released(np.linspace(600e-6, 700e-6, 40))),
        "15": adhesion_energies(pairs, published, EVERY),
    }


def axes_of(figure):
    """Panels of a figure, without colour bars."""
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def curve(axes, label):
    """Points (2, n) of the curve with a label."""
    return np.array(next(line for line in axes.lines if line.get_label() == label).get_data())


PANELS = {"05": 1, "07": 8, "08": 4, "09": 1, "10": 3, "11": 2, "12": 6, "14": 2, "15": 4}


@pytest.mark.parametrize("name", PANELS)
def test_figure_has_its_panels_with_marks_and_every_axis_a_unit(drawn, name):
    panels_drawn = axes_of(drawn[name])
    assert len(panels_drawn) == PANELS[name]
    titles = [axes.get_title(loc="left") for axes in panels_drawn]
    assert len(titles) == 1 or [title[:3] for title in titles] == [
        f"({mark})" for mark in "abcdefghijkl"[: len(titles)]
    ]
    labels = [axis.get_label_text() for axes in panels_drawn for axis in (axes.xaxis, axes.yaxis)]
    named = set(filter(None, labels)) - {"iteration", "number of beams"}
    assert named
    assert all(re.search(r"\[[^\]]+\]$", label) for label in named), named


@pytest.mark.parametrize("name", PANELS)
def test_first_column_and_last_row_are_labelled(drawn, name):
    for axes in axes_of(drawn[name]):
        place = axes.get_subplotspec()
        assert axes.yaxis.get_label_text() or not place.is_first_col()
        assert axes.xaxis.get_label_text() or not place.is_last_row()


@pytest.mark.parametrize("name", PANELS)
def test_figure_is_written_without_a_warning(drawn, name, tmp_path):
    save(drawn[name], tmp_path / "figure.png")
    assert (tmp_path / "figure.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_figures_of_equal_data_are_equal_byte_for_byte(forces, fit, characters, tmp_path):
    laws = forcelaw.coefficients(stage_forces.vectors(forces)[0], LIMIT)
    draw = {
        "lines": lambda: fitted_curve(forces, fit),
        "mesh": lambda: summits({"B1": {"G": characters["B1"], "NG": characters["B2"]}}),
        "pixels in a drawing": lambda: force_curves({"b": (forces, forces, laws)}),
    }
    for name, figure in draw.items():
        copies = [[tmp_path / f"{name} {copy}.{kind}" for kind in ("pdf", "png")] for copy in "ab"]
        for paths in copies:
            save(figure(), *paths)
        for first, second in zip(*copies, strict=True):
            assert first.read_bytes() == second.read_bytes(), name
        assert b"CreationDate" not in copies[0][0].read_bytes()


def test_other_figures_give_other_bytes(drawn, tmp_path):
    save(drawn["07"], tmp_path / "a.pdf")
    save(drawn["14"], tmp_path / "b.pdf")
    assert (tmp_path / "a.pdf").read_bytes() != (tmp_path / "b.pdf").read_bytes()


def test_style_of_the_study_is_independent_of_that_of_the_user(heights):
    with mpl.rc_context({"font.size": 30, "axes.grid": True}):
        before = dict(mpl.rcParams)
        axes = height_densities(heights).axes[0]
        assert dict(mpl.rcParams) == before
    assert axes.title.get_fontsize() == 8
    assert not axes.xaxis.get_gridlines()[0].get_visible()


def test_panels_beyond_the_alphabet_have_marks():
    _, axes = panels(1, 28, (20, 1))
    letter(axes)
    assert [axes[0, k].get_title(loc="left") for k in (0, 25, 26, 27)] == ["(a)", "(z)", "(aa)", "(ab)"]


def test_a_single_panel_has_no_mark():
    _, axes = panels(1, 1, (2, 1))
    letter(axes, ["C1"])
    assert axes[0, 0].get_title(loc="left") == "C1"


def test_a_humidity_has_its_colour_in_any_order_and_once():
    colours = humidity_colours([0.67, 0.44, 0.67])
    assert list(colours) == [0.44, 0.67]
    np.testing.assert_array_equal(colours[0.44], humidity_colours([0.44, 0.67])[0.44])
    assert not np.array_equal(colours[0.44], colours[0.67])


@pytest.mark.parametrize("count", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in (5, 12))])
def test_more_surfaces_than_fit_side_by_side_continue_below(heights, count, tmp_path):
    names = [f"S{k}" for k in range(count)]
    densities = height_densities({name: heights["B2"] for name in names})
    save(densities, tmp_path / "figure.png")
    assert densities.get_figwidth() < 7.5
    titles = [axes.get_title(loc="left").partition(" ")[2] for axes in axes_of(densities)]
    assert sorted(titles) == sorted(names * 2)
    assert all(axes.lines for axes in axes_of(densities))


def test_densities_are_those_of_the_dataset_per_nanometre(drawn, heights):
    z, density = curve(drawn["07"].axes[1], "maximum entropy")
    np.testing.assert_allclose(z, 3.4 * heights["B2"].height)  # nm, Table I
    np.testing.assert_allclose(density, heights["B2"].density / 3.4)
    for label in ("maximum entropy", "Gaussian"):
        assert abs(np.trapezoid(*curve(drawn["07"].axes[0], label)[::-1]) - 1) < 1e-3


def test_map_shows_the_heights_with_the_first_axis_to_the_right(drawn, characters):
    (image,) = axes_of(drawn["08"])[1].images
    np.testing.assert_allclose(image.get_array(), 1e9 * characters["B2"].elevation.T)
    np.testing.assert_allclose(image.get_extent(), [0, 0.12, 0, 0.08])  # µm: 12 x 8 points, 10 nm apart


def test_three_surfaces_leave_no_empty_panel(characters):
    three = dict(list(characters.items())[:3])
    assert len(axes_of(elevation_maps(three))) == 3


def test_maps_of_surfaces_lie_two_abreast(characters):
    places = [axes.get_subplotspec() for axes in axes_of(elevation_maps(characters | {"more": characters["B2"]}))]
    assert [(one.rowspan.start, one.colspan.start) for one in places] == [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0)]


def test_profiles_run_along_the_middle_of_the_patch(drawn, characters):
    x, z = curve(drawn["09"].axes[0], "non-Gaussian")
    np.testing.assert_allclose(x, 0.01 * np.arange(12))  # µm
    np.testing.assert_allclose(z, 1e9 * characters["B2"].elevation[:, 4])


def test_spectra_are_scaled_to_the_rms_of_the_heights(drawn, characters):
    density = drawn["10"].axes[0]
    target = density.lines[2]  # below the drawn spectrum of the second surface
    assert np.interp(5, *target.get_data()) == pytest.approx(14380 * (3.4 / 3.39) ** 2, rel=0.01)  # nm⁴, Table II
    _, shown = curve(density, "B2")
    expected = 1e36 * characters["B2"].periodogram.mean("field").values
    np.testing.assert_allclose(shown[np.isfinite(shown)], expected[np.isfinite(shown)])
    assert np.isfinite(shown).sum() > len(shown) / 2


def test_the_closed_form_is_compared_with_the_target(drawn, spectrum):
    zeta, relation = curve(drawn["10"].axes[1], "B2")
    target = np.interp(1e6 * zeta, spectrum.wavenumber, spectrum.target)
    np.testing.assert_allclose(relation, np.interp(1e6 * zeta, spectrum.wavenumber, spectrum.achieved) / target)


def test_errors_of_the_iterations_are_beside_that_of_the_closed_form(drawn):
    panel = drawn["10"].axes[2]
    np.testing.assert_allclose(curve(panel, "B2")[1], [30, 20, 10])  # %
    closed = [line.get_ydata()[0] for line in panel.lines if len(line.get_xdata()) == 2]
    np.testing.assert_allclose(closed, 0.1)


def test_joint_density_of_summits_integrates_to_one(drawn):
    mesh = drawn["11"].axes[1].collections[0]
    corners = mesh.get_coordinates()
    area = np.diff(corners[0, :, 0])[None] * np.diff(np.log10(corners[:, 0, 1]))[:, None]
    assert np.sum(mesh.get_array() * area) == pytest.approx(1)


def test_mean_radius_is_one_over_the_mean_curvature(drawn, characters):
    (radius,) = {*drawn["11"].axes[1].lines[0].get_ydata()}
    assert radius == pytest.approx(1e6 / float(characters["B2"].summit_curvature.mean()), rel=1e-5)


def test_typical_curve_has_the_median_error(fit):
    k = typical(fit, 21)
    errors = fit.curve_error.values[:21]
    assert np.sum(errors < errors[k]) == np.sum(errors > errors[k]) == 10


def test_law_in_figure_5_passes_through_the_marked_parameters(drawn, forces, fit):
    axes = drawn["05"].axes[0]
    k = typical(fit, 30)
    energy, f_max, d_max, d_limit = stage_forces.vectors(forces)[0][k]
    law = curve(axes, "Eq. (12)")
    assert np.interp(1e9 * d_limit, *law) == pytest.approx(1e-6 * LIMIT, rel=1e-3)
    assert law[1].min() == pytest.approx(-1e-6 * f_max, rel=1e-3)
    np.testing.assert_allclose(curve(axes, "contact")[1], 1e-6 * forces.force[k], rtol=1e-6)
    shown = " ".join(text.get_text() for text in axes.texts)
    for value, unit in ((1e3 * energy, "mJ/m²"), (1e-6 * f_max, "MPa"), (1e9 * d_max, "nm"), (1e9 * d_limit, "nm")):
        assert f"{value:.3g} {unit}" in shown


def test_figure_5_marks_both_ends_of_the_law_states_its_error_and_follows_it_to_a_hundredth_of_its_depth(
    drawn, forces, fit
):
    axes = drawn["05"].axes[0]
    k = typical(fit, 30)
    _, f_max, d_max, d_limit = stage_forces.vectors(forces)[0][k]
    (marked,) = (line.get_xydata() for line in axes.lines if line.get_marker() == "o")
    np.testing.assert_allclose(marked, [[1e9 * d_limit, 1e-6 * LIMIT], [1e9 * d_max, -1e-6 * f_max]])
    error = 100 * float(fit.curve_error.sel(strip=k))
    assert axes.get_legend().get_title().get_text() == f"sample {k}, error {error:.2g} %"
    assert curve(axes, "Eq. (12)")[1][-1] == pytest.approx(-1e-8 * f_max, rel=0.01)


def test_force_curves_end_at_twice_the_largest_attraction_in_repulsion(drawn, forces):
    for panel in drawn["12"].axes[3:6]:
        highest = max(segment[:, 1].max() for segment in panel.collections[0].get_segments() if len(segment))
        assert 1 < highest / (-1e-6 * float(forces.force.min())) < 2


def test_force_curves_are_those_kept_and_those_of_the_generated_laws(drawn, forces):
    crowd, highlighted = (c for c in drawn["12"].axes[0].collections if isinstance(c, LineCollection))
    assert len(crowd.get_segments()) == 30
    assert len(highlighted.get_segments()) == 20
    d, f = crowd.get_segments()[3].T
    np.testing.assert_allclose(f, 1e-6 * np.interp(d / 1e9, forces.distance, forces.force[3]), rtol=1e-6)
    generated = drawn["12"].axes[2].collections[0].get_segments()
    assert len(generated) == 7
    law = forcelaw.coefficients(stage_forces.vectors(forces)[0][:7], LIMIT)[3]
    d, f = generated[3].T
    np.testing.assert_allclose(f, 1e-6 * forcelaw.pressure(law, d / 1e9), rtol=1e-6)


def test_shallow_curves_are_enlarged_until_their_attraction_fills_the_inset(forces):
    laws = forcelaw.coefficients(stage_forces.vectors(forces)[0], LIMIT)
    weak = forces.assign(force=0.05 * forces.force)
    shallow, deep = force_curves({"b": (weak, forces, laws)}).axes[:2]
    (inset,) = shallow.child_axes
    assert inset.get_ylim()[0] == pytest.approx(1.1e-6 * float(weak.force.min()))
    drawn = inset.collections[0].get_segments()[3][:, 1]
    assert drawn.min() == pytest.approx(1e-6 * float(weak.force[3].min()))
    assert not deep.child_axes
    shallow.figure.draw_without_rendering()
    _, top = shallow.transData.inverted().transform(inset.bbox.max)
    assert shallow.get_ylim()[0] < top < 1e-6 * float(weak.force.min())  # below what it enlarges


def test_curves_at_larger_distances_have_a_window_of_the_same_width(forces):
    laws = forcelaw.coefficients(stage_forces.vectors(forces)[0], LIMIT)
    moved = forces.assign(limit_distance=forces.limit_distance + 1e-7)
    moved = moved.assign(distance=forces.distance + 1e-7)
    windows = [force_curves({"b": (each, each, laws)}).axes[0].get_xlim() for each in (forces, moved)]
    np.testing.assert_allclose(np.diff(windows, axis=0), 100, rtol=1e-6)


def test_one_pair_fills_one_row_of_force_curves(forces):
    laws = forcelaw.coefficients(stage_forces.vectors(forces)[0], LIMIT)
    assert len(axes_of(force_curves({"b": (forces, forces, laws)}))) == 3


def test_histogram_counts_only_beams_that_ended_s_shaped():
    beams = released(np.linspace(600e-6, 1500e-6, 40), [0] * 25 + [1] * 10 + [2] * 5)
    shapes, histogram = beam_shapes(beams).axes
    assert sum(bar.get_height() for bar in histogram.patches) == 25
    said = histogram.texts[0].get_text()
    assert said.startswith("25 of 40 beams S-shaped\nmean ± std: 877 ± ")  # mean of the first 25 of 40
    assert len(shapes.lines) == 3 + 1 + 1, "one is the entry of the legend"
    assert [text.get_text() for text in shapes.get_legend().get_texts()] == [
        "each beam",
        "one S-shaped beam",
        "substrate",
    ]
    np.testing.assert_allclose(shapes.lines[-1].get_xydata().T, 1e6 * np.array([beams.node, beams.deflection[0]]))  # µm
    assert shapes.yaxis_inverted()


def test_figure_of_beams_that_are_all_free_states_their_number(tmp_path):
    figure = beam_shapes(released([1500e-6] * 5, [2] * 5))
    save(figure, tmp_path / "free.png")
    assert figure.axes[1].texts[0].get_text() == "0 of 5 beams S-shaped"


def test_crack_length_710_um_is_6_81_mJ_per_m2_and_longer_cracks_are_weaker():
    energy, (below, above) = energies_with_bars(np.array([710e-6]), np.array([71e-6]), BEAM)
    assert energy[0] == pytest.approx(6.81e-3, rel=1e-3)
    assert below[0] == pytest.approx(energy[0] * (1 - 1.1**-4))
    assert above[0] == pytest.approx(energy[0] * (0.9**-4 - 1))
    assert above[0] > below[0]


def bars(axes, label):
    """Centres (2, n) and ends (n, 2) of the error bars with a label."""
    (container,) = (c for c in axes.containers if isinstance(c, ErrorbarContainer) and c.get_label() == label)
    segments = container[2][0].get_segments()
    return np.array(container[0].get_data()), np.array([segment[:, 1] for segment in segments])


def test_experiment_is_converted_by_eq_13_with_unequal_bars(drawn):
    centres, ends = bars(drawn["15"].axes[1], "measured, mean ± std")
    lengths = np.array([700, 600])
    scale = 1.5 * 164e9 * 20e-6**2 * 2.6e-6**3 * 1e3  # mJ/m² · m⁴
    np.testing.assert_allclose(centres, [HUMIDITIES, scale / (lengths * 1e-6) ** 4])
    for sign, end in ((1, ends[:, 0]), (-1, ends[:, 1])):
        np.testing.assert_allclose(end, scale / ((lengths + sign * 50) * 1e-6) ** 4)


def test_beams_show_mean_and_standard_deviation_of_the_s_shapes_alone(drawn, pairs):
    (humidity, mean), ((low, high),) = bars(drawn["15"].axes[0], "G: beams, mean ± std")
    energies = 1e3 * pairs["b"][1][0.7, "G"].apparent_energy.values[:3]
    assert humidity == 0.7
    assert mean == pytest.approx(energies.mean())
    assert (high - low) / 2 == pytest.approx(energies.std(ddof=1))


def test_share_of_s_shapes_is_shown_if_below_one(drawn):
    left, right = drawn["15"].axes[:2]
    assert {(text.xy[0], text.get_text()) for text in left.texts} == {(0.5, "0 %"), (0.7, "75 %")}
    assert not right.texts


def test_beams_without_an_s_shape_get_a_marker_on_the_line_of_the_longest_crack(drawn):
    left = drawn["15"].axes[0]
    none = next(text for text in left.texts if text.get_text() == "0 %")
    at_label = [line for line in left.lines if line.get_marker() == "s" and list(line.get_xdata()) == [none.xy[0]]]
    (longest,) = {line.get_ydata()[0] for line in left.lines if line.get_label() == "crack as long as the beam"}
    assert [line.get_ydata()[0] for line in at_label] == [longest]


def test_band_is_that_of_the_fine_humidity_axis(drawn, pairs):
    left, right = drawn["15"].axes[:2]
    for axes, model, place in ((left, "G", 0), (left, "NG", 1), (right, "NG", 0)):
        axis = pairs["b"][2][model]
        humidity, median = curve(axes, rf"{model}: median and 5–95 % of $\bar e$")
        np.testing.assert_allclose(humidity, axis.humidity)
        np.testing.assert_allclose(median, 1e3 * axis.energy_quantile.sel(probability=0.5))
        corners = [c for c in axes.collections if isinstance(c, PolyCollection)][place].get_paths()[0].vertices[:, 1]
        assert corners.min() == pytest.approx(1e3 * float(axis.energy_quantile.min()))
        assert corners.max() == pytest.approx(1e3 * float(axis.energy_quantile.max()))


def test_humidity_axis_takes_quantiles_over_the_samples_of_each_humidity():
    energies = np.outer([1.0, 3.0], np.arange(101.0))
    axis = study_humidity.layout(np.array([0.5, 0.6]), np.array([0.05, 0.95]), energies)
    np.testing.assert_allclose(axis.energy_quantile.sel(humidity=0.6), [15, 285])
    np.testing.assert_allclose(axis.energy_quantile.sel(humidity=0.5), [5, 95])


def test_every_pair_has_the_energy_of_its_own_flat_surfaces(pairs, published):
    flat = {pair: FLAT / k for k, pair in enumerate(pairs, 1)}
    figure = adhesion_energies(pairs, published, flat)
    shown = [curve(axes, "flat surfaces in saturated air")[1] for axes in figure.axes]
    np.testing.assert_allclose(np.mean(shown, axis=1), np.repeat([1e3 * flat[pair] for pair in pairs], 2))  # mJ/m²
    assert len(set(flat.values())) > 1


def test_surfaces_in_dry_air_alone_have_no_flats_in_saturated_air(pairs, published):
    panel = adhesion_energies(pairs, published, {}).axes[0]
    assert {line.get_label() for line in panel.lines} & {
        "crack as long as the beam",
        "flat surfaces in saturated air",
    } == {"crack as long as the beam"}
    dry = {"humidities": ["dry"], "beam": "B2", "substrate": "Sub1", "gap_um": 20}
    plan = Plan(load({"attraction": {"reach": "all"}, "pairs": {"mine": dry}, "run": {"pairs": ["b", "mine"]}}))
    assert list(job_settings(plan, "figures/figure_15.pdf")["water"]) == ["b"]


def test_markers_of_models_do_not_cover_the_measured_values(drawn):
    for axes in drawn["15"].axes[:2]:
        containers = [c for c in axes.containers if isinstance(c, ErrorbarContainer)]
        offsets = {c.get_label(): c[0].get_transform().transform((0.6, 10))[0] for c in containers}
        offsets = {label: place - offsets["measured, mean ± std"] for label, place in offsets.items()}
        assert {label for label, offset in offsets.items() if offset < 0} == {c for c in offsets if "beams" in c}
        assert {label for label, offset in offsets.items() if offset > 0} == {c for c in offsets if "published" in c}
        assert max(containers, key=lambda c: c[0].get_zorder()).get_label() == "measured, mean ± std"


def test_published_results_of_two_models_have_two_names_and_two_markers(drawn):
    markers = [
        (c.get_label(), c[0].get_marker())
        for axes in drawn["15"].axes[:2]
        for c in axes.containers
        if "published" in c.get_label()
    ]
    assert [label for label, _ in markers] == ["NG: published", "GEO: published"]
    assert markers[0][1] != markers[1][1]


def test_medians_of_weak_adhesion_stay_within_the_axes(pairs, published):
    beam, beams, axes = pairs["b"]
    weak = axes | {"G": axes["G"].assign(energy_quantile=1e-6 * axes["G"].energy_quantile)}
    for panel in adhesion_energies({"b": (beam, beams, weak)}, published, EVERY).axes:
        assert panel.get_ylim()[0] < 1e3 * float(weak["G"].energy_quantile.sel(probability=0.5).min())


def test_pair_of_the_user_has_no_measured_values(drawn, pairs, published):
    known, own = (drawn["15"].axes[k].get_legend_handles_labels()[1] for k in (0, 2))
    assert set(known) - set(own) == {"measured, mean ± std", "NG: published"}
    assert len(axes_of(adhesion_energies({"mine": pairs["mine"]}, published, EVERY))) == 2


def test_the_legend_lists_the_curves_of_all_pairs(pairs, published):
    figure = adhesion_energies({name: pairs[name] for name in ("mine", "b")}, published, EVERY)
    named = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {"measured, mean ± std", "NG: published", "GEO: published", "GEO: beams, mean ± std"} <= named


def test_a_single_humidity_shows_its_median_and_quantiles(pairs, published):
    beam, beams, axes = pairs["b"]
    single = {model: axis.isel(humidity=[2]) for model, axis in axes.items()}
    panel = adhesion_energies({"b": (beam, beams, single)}, published, EVERY).axes[0]
    centres, ends = bars(panel, r"NG: median and 5–95 % of $\bar e$")
    low, median, high = 1e3 * single["NG"].energy_quantile.values.ravel()
    np.testing.assert_allclose([*map(float, centres.ravel())], [0.6, median])
    np.testing.assert_allclose(ends, [[low, high]])


def test_a_pair_of_one_humidity_shows_its_median_and_stays_within_all_humidities(pairs, published):
    beam, beams, axes = pairs["b"]
    humid = {(0.99, model): found for (humidity, model), found in beams.items() if humidity == 0.5}
    repeated = {model: axis.assign_coords(humidity=np.full(5, 0.99)) for model, axis in axes.items()}
    panel = adhesion_energies({"mine": (beam, humid, repeated)}, published, EVERY).axes[0]
    centres, _ = bars(panel, r"NG: median and 5–95 % of $\bar e$")
    np.testing.assert_allclose([*map(float, centres.ravel())][0], 0.99)
    assert panel.get_xlim()[0] < 0.99 < panel.get_xlim()[1] <= 1


def test_the_legend_of_figure_15_is_inside_it_after_surfaces_that_no_water_wets_too(pairs, published):
    beam, beams, axes = pairs["b"]
    repeated = {model: axis.assign_coords(humidity=np.full(5, 0.5)) for model, axis in axes.items()}
    for shown in ({"wax": (beam, beams, {}), "mine": (beam, beams, repeated)}, pairs):
        assert covering(adhesion_energies(shown, published, {"mine": FLAT, "b": FLAT})) == []


def test_beams_in_dry_air_are_shown_whole_beside_the_axis(pairs, published):
    beam, beams, axes = pairs["b"]
    dry = {(0.0, model): found for (humidity, model), found in beams.items() if humidity == 0.5}
    panel = adhesion_energies({"b": (beam, beams | dry, axes)}, published, EVERY).axes[0]
    place = panel.get_xticks()[0]
    assert panel.get_xticklabels()[0].get_text() == "dry"
    left, right = panel.get_xlim()
    assert place - left > 0.04 * (right - left)


def test_energies_above_that_of_flat_surfaces_are_shown_with_their_deviation(pairs, published):
    beam, beams, axes = pairs["b"]
    strong = {key: found.assign(apparent_energy=100 * found.apparent_energy) for key, found in beams.items()}
    panel = adhesion_energies({"b": (beam, strong, axes)}, published, EVERY).axes[0]
    energies = 1e3 * strong[0.5, "GEO"].apparent_energy.values
    assert panel.get_ylim()[1] > energies.mean() + energies.std(ddof=1) > 288


def test_the_axis_of_a_single_humidity_is_a_tenth_long_and_ends_at_one():
    for humidity, limits in ((0.5, (0.45, 0.55)), (0.99, (0.94, 1)), (0.02, (0, 0.07))):
        _, ((panel,),) = panels(1, 1, (3, 2))
        panel.plot(humidity, 1, "o")
        panel.set_xlim(humidity - 1e-3, humidity + 1e-3)
        humidity_axis(panel)
        np.testing.assert_allclose(panel.get_xlim(), limits, atol=1e-9)
    panel.set_xlim(0.4, 0.9)
    humidity_axis(panel)
    assert panel.get_xlim() == (0.4, 0.9)


def test_the_energy_of_the_longest_crack_is_always_shown(pairs, published):
    _, beams, axes = pairs["b"]
    stiff = replace(BEAM, thickness=10 * BEAM.thickness)
    for panel in adhesion_energies({"b": (stiff, beams, axes)}, published, EVERY).axes:
        weakest = curve(panel, "crack as long as the beam")[1][0]
        assert 144 < weakest < panel.get_ylim()[1]
