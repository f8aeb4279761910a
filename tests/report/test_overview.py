"""The overview shows the numbers of its datasets, and published values for the paper's own pairs only."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.container import ErrorbarContainer

from stiction.contact import forcelaw
from stiction.report.beams.overview import _FOLLOWED, overview
from stiction.report.style import save
from stiction.stages.laws import forces as stage_forces
from stiction.streams import stream

HUMIDITIES = (0.5, 0.7)
LIMIT = 3e6
LENGTHS = 1e-6 * np.array([600, 650, 700, 1500])
PUBLISHED = pd.DataFrame(
    {
        "pair": ["b", "b"],
        "relative_humidity": HUMIDITIES,
        "experiment": [700.0, 600.0],
        "experiment_std": [50.0, 40.0],
        "geo": [720.0, 610.0],
        "geo_std": [30.0, 20.0],
    }
)


def character():
    """Heights of 40 x 30 points, 0.1 µm apart."""
    axes = {name: (name, 1e-7 * np.arange(n)) for name, n in (("x", 40), ("y", 30))}
    return xr.Dataset({"elevation": (("x", "y"), 3e-9 * stream(4, "heights").standard_normal((40, 30)))}, axes)


def forces(n=21):
    vectors = np.array([7e-3, 2e6, 8e-9, 6.5e-9]) * (1 + 0.05 * stream(4, "vectors").standard_normal((n, 4)))
    distance = np.linspace(4e-9, 30e-9, 400)
    law = forcelaw.coefficients(vectors, LIMIT)
    return stage_forces.layout(vectors, LIMIT, distance, forcelaw.pressure(law[:, None], distance))


def beams():
    nodes = np.linspace(0, 1.5e-3, 21)
    return xr.Dataset(
        {
            "state": ("beam", [0, 0, 0, 2]),
            "crack_length": ("beam", LENGTHS),
            "deflection": (("shape", "node"), 2e-5 * np.minimum(nodes / LENGTHS[:3, None], 1)),
        },
        {"node": nodes},
    )


def draw(models=("NG", "GEO"), published=PUBLISHED):
    released = {(humidity, model): beams() for humidity in HUMIDITIES[::-1] for model in models}
    return overview("b", character(), forces(), beams(), released, published)


def bars(panel):
    """Error bars of a panel by their label."""
    return {c.get_label(): c for c in panel.containers if isinstance(c, ErrorbarContainer)}


def curves(panel):
    """Label to the points (2, n) of the error bars of a panel."""
    return {label: np.array(found[0].get_data(orig=False), float) for label, found in bars(panel).items()}


def test_humid_air_is_on_its_side_of_the_line_beside_dry_air():
    released = {(humidity, "NG"): beams() for humidity in (0.0, 0.67)}
    panel = overview("b", character(), forces(), beams(), released, PUBLISHED[:0]).axes[3]
    (line,) = [one for one in panel.lines if one.get_linestyle() == ":"]
    assert panel.get_xticks()[0] < line.get_xdata()[0] < curves(panel)["computed here"][0][0]
    assert curves(panel)["computed here"][0][0] == pytest.approx(0.67)


def test_overview_is_written_without_a_warning_and_no_panel_covers_another(tmp_path):
    figure = draw()
    save(figure, tmp_path / "overview.png", tmp_path / "overview.pdf")
    assert (tmp_path / "overview.png").read_bytes().startswith(b"\x89PNG")
    boxes = [axes.get_tightbbox() for axes in figure.axes if axes.get_label() != "<colorbar>"]
    for left, right in zip(boxes, boxes[1:], strict=False):
        assert left.x1 < right.x0
    assert tuple(figure.get_size_inches()) == (7.2, 2.4)


def test_equal_data_give_equal_files(tmp_path):
    save(figure := draw(), tmp_path / "a.png")
    save(figure, tmp_path / "b.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_surface_is_a_square_piece_of_the_simulated_one():
    one = character()
    released = {(0.5, "NG"): beams()}
    (image,) = overview("b", one, forces(), beams(), released, PUBLISHED).axes[0].images
    np.testing.assert_allclose(image.get_array(), 1e9 * one.elevation.values[:30, :30].T)
    np.testing.assert_allclose(image.get_extent(), [0, 3, 0, 3])  # µm


def test_the_law_is_that_of_the_sample_of_median_energy():
    dataset = forces()
    vectors, limit = stage_forces.vectors(dataset)
    median = vectors[np.argsort(vectors[:, 0])[len(vectors) // 2]]
    panel = overview("b", character(), dataset, beams(), {(0.5, "NG"): beams()}, PUBLISHED).axes[1]
    distance, force = next(line for line in panel.lines if line.get_label() == "a fitted law").get_data()
    law = forcelaw.coefficients(median[None], limit)[0]
    np.testing.assert_allclose(force, 1e-6 * forcelaw.pressure(law, 1e-9 * distance), rtol=1e-6)


def test_the_first_s_shaped_beam_is_highlighted():
    released = beams()
    lines = draw().axes[2].lines
    (highlighted,) = (line for line in lines if line.get_linewidth() > 1)
    np.testing.assert_allclose(highlighted.get_ydata(), 1e6 * released.deflection.values[0])


def test_bars_are_the_standard_deviations_over_the_beams_and_those_published():
    halves = {
        label: [np.ptp(segment[:, 1]) / 2 for segment in found[2][0].get_segments()]
        for label, found in bars(draw().axes[3]).items()
    }
    np.testing.assert_allclose(halves["computed here"], [50, 50])  # of 600, 650 and 700 µm
    np.testing.assert_allclose(halves["published"], PUBLISHED.geo_std)
    np.testing.assert_allclose(halves["measured"], PUBLISHED.experiment_std)


def test_law_of_the_typical_curve_lies_on_it():
    panel = draw().axes[1]
    law = next(line for line in panel.lines if line.get_label() == "a fitted law").get_xydata()
    curves_drawn = [segment for segment in panel.collections[0].get_segments() if len(segment)]
    inside = [law[law[:, 0] > curve[0, 0]] for curve in curves_drawn]
    off = [np.abs(np.interp(x, *c.T) - f).max() for c, (x, f) in zip(curves_drawn, (i.T for i in inside), strict=True)]
    assert min(off) < 0.02
    assert len(panel.collections[1].get_segments()) == 8


def test_all_points_of_the_force_curves_within_the_panel_are_drawn():
    panel = draw().axes[1]
    within = 1e-6 * forces().force.values < panel.get_ylim()[1]  # MPa
    assert [len(curve) for curve in panel.collections[0].get_segments()] == list(within.sum(axis=1))
    (law,) = (line for line in panel.lines if line.get_linestyle() == "--")
    assert law.get_ydata().max() < panel.get_ylim()[1]


def test_the_panel_of_the_forces_begins_a_tenth_before_they_attract():
    distance, force = stage_forces.curves(forces())
    attracting = 1e9 * distance[(force < _FOLLOWED * force.min()).any(axis=0)]
    width = np.ptp(attracting)
    np.testing.assert_allclose(draw().axes[1].get_xlim(), [attracting[0] - 0.1 * width, attracting[-1]])


@pytest.mark.parametrize("models", [("NG", "GEO"), ("NG",)])
def test_crack_lengths_are_those_of_s_shaped_beams_at_every_humidity(models):
    found = curves(draw(models).axes[3])
    assert set(found) == {"measured", "published", "computed here"}
    np.testing.assert_allclose(found["computed here"][0], HUMIDITIES, atol=0.02)
    np.testing.assert_allclose(found["computed here"][1], [650, 650])
    np.testing.assert_allclose(found["measured"], [HUMIDITIES, [700, 600]])
    np.testing.assert_allclose(found["published"][1], [720, 610])


def test_a_pair_of_the_user_shows_no_published_values():
    assert set(curves(draw(published=PUBLISHED[:0]).axes[3])) == {"computed here"}
