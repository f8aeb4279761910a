"""What curves over a roughness or a process say in the picture itself: labels, clear of the curves, and bands."""

import numpy as np
import pytest
import xarray as xr
from drawn_curves import etched, rough
from legends import covering
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.text import Text

from stiction.report.axes import figures
from stiction.report.axes.labels import Label, put
from stiction.report.axes.roughness import (
    crossings_of,
    flats_suffice,
    ranges_of,
    smoother_than_known,
    sure_in_short,
)
from stiction.report.style import BUILD, panels, png
from stiction.run.stored_limits import as_text
from stiction.stages.axes.requirement import SMOOTHER
from stiction.stages.devices.opening import EITHER, S_SHAPE


def texts(figure):
    """Texts inside of panels."""
    return [text.get_text() for panel in figure.axes for text in panel.texts]


def names(figure):
    """Names in the legend."""
    return [text.get_text() for text in figure.legends[0].get_texts()]


def placed(y, *labels, level=1.0):
    """Texts beside a line in a panel from 0 to 10 on both axes, with a curve of heights at 0, 5 and 10."""
    figure, ((panel,),) = panels(1, 1, (3.4, 2.8))
    panel.plot([0, 5, 10], y)
    panel.set(xlim=(0, 10), ylim=(0, 10))
    put(panel, level, list(labels))
    png(figure)
    return panel.texts


@pytest.mark.parametrize(
    ("y", "place"),
    [
        ([6, 6, 6], ("left", "top")),
        ([4, 4, 4], ("left", "bottom")),
        ([5.5, 1, 4], ("right", "bottom")),
        ([4.5, 9, 6], ("right", "top")),
    ],
)
def test_a_label_is_where_the_curve_is_far(y, place):
    (text,) = placed(y, Label("required", "black"), level=5.0)
    assert (text.get_ha(), text.get_va()) == place
    box = text.get_window_extent().transformed(text.axes.transData.inverted())
    height = np.interp(np.linspace(box.x0, box.x1), [0, 5, 10], y)
    assert np.all((height < box.y0) | (height > box.y1))


def test_labels_do_not_cover_each_other_and_one_of_a_place_is_beside_it():
    labels = [Label("RH 0.6: 4.0 nm", "red", 4.0), Label("RH 0.9: not here", "blue"), Label("required", "black")]
    found = placed([9, 9, 9], *labels, level=5.0)
    boxes = [text.get_window_extent().transformed(found[0].axes.transData.inverted()) for text in found]
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])
    assert 0 < min(abs(boxes[0].x0 - 4), abs(boxes[0].x1 - 4)) < 0.5
    assert [box.y0 >= 5 or box.y1 <= 5 for box in boxes] == [True] * 3
    assert all(0 <= box.x0 < box.x1 <= 10 for box in boxes)


def test_a_label_stays_inside_its_panel_at_a_place_near_its_side():
    for place in (0.3, 9.7):
        (text,) = placed([9, 9, 9], Label("RH 0.6: 4.00 ± 0.33 nm", "red", place), level=5.0)
        box = text.get_window_extent().transformed(text.axes.transData.inverted())
        assert 0 <= box.x0 < box.x1 <= 10


def test_crossings_have_their_values_and_humidities_without_one_are_named():
    found = rough()
    figure = figures.roughness(found)
    at_lower = "RH 0.6: sure from 4.57 nm\nestimate 4, 95 %: 3.35 to 4.65 nm"
    at_upper = "RH 0.8: sure from 4.69 nm\nestimate 4, 95 %: 3.22 to 4.78 nm"
    assert {at_lower, at_upper} == set(texts(figure))
    weak = figures.roughness(found.assign(required=found.required / 10).isel(crossing=[]))
    assert not texts(weak)
    assert [entry.endswith(": nowhere enough") for entry in entries(weak)[:2]] == [True, True]
    whole = found.assign(range_low=found.range_low * 0 + 1e-9, required=found.required * 10)
    strong = figures.roughness(whole.isel(crossing=[]))
    assert set(texts(strong)) == {"RH 0.6, RH 0.8: sure everywhere"}
    unsure = figures.roughness(whole.isel(crossing=[], range=[]))
    assert set(texts(unsure)) == {"RH 0.6, RH 0.8: nowhere sure"}
    assert covering(figure) == covering(weak) == covering(strong) == []


def test_the_thick_line_and_the_words_begin_where_the_simulated_limit_meets_the_requirement():
    found = rough()
    panel = figures.roughness(found).axes[0]
    thick = [line for line in panel.collections if isinstance(line, LineCollection) and line.get_linewidth()[0] > 3]
    for humidity, line in zip((0.6, 0.8), thick, strict=True):
        (segment,) = line.get_segments()
        ((low, high),) = 1e9 * ranges_of(found, humidity, "force")
        np.testing.assert_allclose(segment, [[low, 28], [high, 28]])
        (said,) = (text for text in texts(panel.figure) if text.startswith(f"RH {humidity}"))
        assert said.startswith(f"RH {humidity}: sure from {low:.3g} nm\n")
        (crossed,) = crossings_of(found, humidity, "force").crossing_place.values
        assert low > 1e9 * crossed, "what is sure is not the place of the estimate"


def entries(figure):
    """Entries of the legend of a figure."""
    return [text.get_text() for text in figure.legends[0].get_texts()]


@pytest.mark.parametrize(("is_beam", "side"), [(False, "below"), (True, "above")])
def test_the_required_line_says_on_which_side_the_device_releases(is_beam, side):
    found = rough(is_beam)
    panel = figures.roughness(found).axes[0]
    assert [
        entry
        for entry in entries(panel.figure)
        if entry.endswith(f" µ{'m' if is_beam else 'N'}: dashes {side} it release")
    ]
    roughest = float(found.estimate.sel(roughness=8e-9, humidity=0.6).squeeze())
    assert (roughest > float(found.required)) == is_beam
    assert float(found.stuck.sel(roughness=8e-9, humidity=0.6, end="estimate").squeeze()) < float(found.share)


def end_state(shape, factor):
    """Curve of a beam in an end state, with its limits this much longer than where the tip holds it."""
    one = rough(True).assign_coords(shape=[shape])
    places = {f"{name}_shape": (name, [shape] * one.sizes[name]) for name in ("crossing", "range")}
    return one.assign(places).assign({name: factor * one[name] for name in ("estimate", "error", "safe")})


def of_cantilever():
    """Curve of a beam that its tip can hold. The beam alone is long enough everywhere."""
    tip, alone = end_state(EITHER, 1.0), end_state(S_SHAPE, 8.0).isel(crossing=[])
    ends = [alone.assign(range_low=alone.range_low * 0 + 1e-9), tip]
    along = {name: next((dim for dim in ("shape", "crossing", "range") if dim in tip[name].dims), "") for name in tip}
    joined = {name: xr.concat([end[name] for end in ends], dim) for name, dim in along.items() if dim}
    rest = tip.drop_vars([*joined, "shape"]).drop_dims(["crossing", "range"], errors="ignore")
    return rest.assign(joined).assign_attrs(tip.attrs)


def test_the_end_state_that_decides_is_first_and_nothing_is_sure_where_it_does_not_decide():
    figure = figures.roughness(of_cantilever())
    decides, alone = figure.axes
    assert decides.get_title(loc="left") == "(a) beam or tip"
    assert alone.get_title(loc="left") == "(b) beam, only if its tip cannot touch"
    said = [[text.get_text().replace("\n", " ") for text in panel.texts] for panel in (decides, alone)]
    assert [sum("sure from" in text for text in one) for one in said] == [2, 0]
    assert "RH 0.6, RH 0.8: enough everywhere, only if its tip cannot touch" in said[1]
    thick = [
        [line for line in panel.collections if isinstance(line, LineCollection) and line.get_linewidth()[0] > 3]
        for panel in (decides, alone)
    ]
    assert [len(lines) for lines in thick] == [2, 0]
    assert covering(figure) == []


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        (1e-9, 8e-9, "sure everywhere"),
        (2e-9, 8e-9, "sure from 2 nm"),
        (1e-9, 5e-9, "sure up to 5 nm"),
        (2e-9, 5e-9, "sure from 2 to 5 nm"),
    ],
)
def test_an_end_of_what_is_sure_is_named_unless_the_computed_values_end_there(low, high, words):
    found = rough()
    ranges = found.assign(range_low=found.range_low * 0 + low, range_high=found.range_high * 0 + high)
    assert sure_in_short(ranges, 0.6, "force") == words


@pytest.mark.parametrize("is_beam", [False, True])
def test_bands_of_a_process_are_named_and_do_not_overlap(is_beam):
    figure = figures.devices(*etched(is_beam), "D")
    assert names(figure)[-2:] == ["inner band: mean process, 95 %", "outer band: next run, 95 %"]
    inner, below, above = (band.get_paths()[0].get_extents() for band in figure.axes[0].collections[:3])
    assert below.y0 < inner.y0 < inner.y1 < above.y1
    assert covering(figure) == []


def test_the_best_setting_is_at_the_bottom_in_the_colour_of_what_to_build():
    curve, settings = etched()
    panel = figures.devices(curve, settings, "D").axes[0]
    (bar,) = (one for one in panel.containers if to_hex(one[0].get_color()) == BUILD.lower())
    (segment,) = bar[2][0].get_segments()
    np.testing.assert_allclose(segment[:, 0], settings.best_interval.sel(who="D"))
    ends = panel.transAxes.inverted().transform(bar[2][0].get_transform().transform(segment))
    assert np.all((ends[:, 1] > 0) & (ends[:, 1] < 0.1)), "at the bottom axis"
    (said,) = (text for text in texts(panel.figure) if text.startswith("best "))
    assert said == "best 80.1 s, 95 %: 78.9 to 81 s"
    bands = min(band.get_paths()[0].get_extents().y0 for band in panel.collections[:3])
    above = panel.texts[[text.get_text() for text in panel.texts].index(said)]
    png(panel.figure)
    assert above.get_window_extent().y1 < panel.transData.transform((0, bands))[1], "clear of the bands"


def test_that_no_setting_suffices_is_said_and_only_then():
    curve, settings = etched()
    said = "no setting is sure to suffice in the next run"
    assert said not in texts(figures.devices(curve, settings, "D"))
    none = settings.assign(sufficient=settings.sufficient * np.nan)
    figure = figures.devices(curve, none, "D")
    assert said in texts(figure)
    assert "best, but not sufficient: 80.1 s, 95 %: 78.9 to 81 s" in texts(figure)
    (best,) = (line for line in figure.axes[0].lines if line.get_marker() == "D")
    assert (to_hex(best.get_color()), best.get_markerfacecolor()) == ("#666666", "white"), "grey and open"
    assert not any(to_hex(text.get_color()) == BUILD.lower() for text in figure.axes[0].texts)
    assert "next run suffices, 95 %" not in names(figure)
    unknown = none.assign(best=none.best * np.nan)
    assert not {text for text in texts(figures.devices(curve, unknown, "D")) if "best" in text or text == said}


@pytest.mark.parametrize("draw", [lambda: figures.roughness(rough(True)), lambda: figures.devices(*etched(), "D")])
def test_text_of_curves_can_be_read_on_a_phone(draw):
    figure = draw()
    shown = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text()]
    assert min(text.get_fontsize() for text in shown) / 72 * 390 / figure.get_figwidth() >= 11  # pixels


def hatched(safe_by):
    """Panel at RH 0.6 of a map over rms and skewness, and its hatching, with limits this factor above the estimate."""
    found = rough(others=(0.0, -0.5, 0.5))
    panel = figures.roughness_map(found.assign(safe=found.estimate * safe_by)).axes[1]
    return panel, [one for one in panel.collections if getattr(one, "hatches", None) and any(one.hatches)]


def test_what_a_map_meets_without_confidence_is_hatched():
    panel, (hatching,) = hatched(1.3)
    clip = hatching.get_clip_path().get_fully_transformed_path()
    for rms, expected in ((3.0, (True, False)), (4.5, (True, True)), (7.5, (False, True))):  # estimate: 4, limit: 6.2
        place = (rms, 0.0)
        unsure = hatching.get_paths()[0].contains_point(place)
        assert (unsure, clip.contains_point(panel.transData.transform(place))) == expected, rms
    assert "met without 95 % confidence" in panel.get_legend_handles_labels()[1]
    panel, none = hatched(0.1)
    assert (none, "met without 95 % confidence" in panel.get_legend_handles_labels()[1]) == ([], False)


def test_an_unknown_bound_of_a_map_is_no_confidence():
    _, (hatching,) = hatched(np.nan)
    assert hatching.get_paths()[0].contains_point((6.0, 0.0))


@pytest.mark.parametrize("flagged", [(), (0,), (0, 1), (-1,)])
def test_surfaces_smoother_than_those_with_full_contact_are_veiled(flagged):
    found = rough()
    places = 1e9 * found.roughness.values
    flags = found.flagged.astype(object)
    for k in flagged:
        flags[{"roughness": k}] = as_text([SMOOTHER])
    found = found.assign(flagged=flags, given=6e-9)
    ends = sorted((places[flagged[0]], 6.0)) if flagged else None
    assert smoother_than_known(found) == (ends and pytest.approx(tuple(ends)))
    shown = "full contact unknown: more stick than drawn" in entries(figures.roughness(found))
    assert shown == bool(flagged)


@pytest.mark.parametrize(
    ("flagged", "words"), [((), "sure from 4.57 nm"), ((0,), "sure from 6 nm"), ((-1,), "sure from")]
)
def test_nothing_is_sure_beyond_the_given_surface_where_full_contact_is_unknown(flagged, words):
    found = rough()
    flags = found.flagged.astype(object)
    for k in flagged:
        flags[{"roughness": k}] = as_text([SMOOTHER])
    shown = texts(figures.roughness(found.assign(flagged=flags, given=6e-9)))
    said = next(text for text in shown if text.startswith("RH 0.6"))
    assert words in said
    assert ("to 6 nm" in said) == (flagged == (-1,)), "flags are at the other side"
    assert ("estimate 4" in said) == (flagged != (0,)), "the place of the estimate is known"
    crossings = crossings_of(found.assign(flagged=flags, given=6e-9), 0.6, "force")
    assert crossings.sizes["crossing"] == (flagged != (0,))


@pytest.mark.parametrize("bound", [np.nan, 0.9, 1.1])
def test_everything_is_enough_where_even_flat_surfaces_suffice_unless_a_tip_holds(bound):
    found, flags = of_cantilever(), of_cantilever().flagged.astype(object)
    flags[{"roughness": 0}] = flags[{"roughness": 1}] = as_text([SMOOTHER])
    found = found.assign(
        flagged=flags, given=found.roughness[2].item(), bound=found.estimate * 0 + bound * found.required
    )
    suffice = {shape: flats_suffice(found, shape) for shape in (S_SHAPE, EITHER)}
    assert suffice == {S_SHAPE: bound > 1, EITHER: False}
    decides, alone = figures.roughness(found).axes
    said = " ".join(text.get_text().replace("\n", " ") for text in alone.texts)
    assert ("enough everywhere" in said) == (bound > 1)
    assert ("enough from 2 nm" in said) == (not bound > 1)
    veils = [[one for one in panel.patches if one.get_label().startswith("full contact")] for panel in (decides, alone)]
    assert [len(veil) for veil in veils] == [1, not bound > 1]
    (start,) = {text.xy[0] for text in alone.texts}
    given = alone.transAxes.inverted().transform(alone.transData.transform((2, 1)))[0]
    assert start == pytest.approx(given, abs=0.03), "clear of the veil"


def mapped(smoothest):
    """Panel of a map at RH 0.6, in which full contact is unknown below some rms [nm], and its given rms [nm]."""
    found = rough(others=(0.0, -0.5, 0.5))
    flags, places = found.flagged.astype(object), 1e9 * found.roughness.values
    for k in np.flatnonzero(places < smoothest):
        flags[{"roughness": k}] = as_text([SMOOTHER])
    given = places[places >= smoothest][0]
    return figures.roughness_map(found.assign(flagged=flags, given=1e-9 * given)).axes[1], given


def test_a_map_hides_what_the_estimate_alone_meets_where_full_contact_is_unknown():
    panel, given = mapped(4.6)
    label = "full contact unknown: can stick"
    (area,) = [one for one in panel.collections if one.get_zorder() == pytest.approx(2.1)]
    clip = area.get_clip_path().get_fully_transformed_path()
    for rms, hidden in ((3.0, False), (given - 0.2, True), (given + 0.2, False)):  # the estimate meets it from 4 on
        inside = any(path.contains_point((rms, 0.0)) for path in area.get_paths())
        assert (inside and clip.contains_point(panel.transData.transform((rms, 0.0)))) == hidden, rms
    dashed = max((one for one in panel.collections if one.get_linestyle()[0][1]), key=lambda one: one.get_zorder())
    assert min(path.vertices[:, 0].min() for path in dashed.get_paths()) >= given - 1e-6, "nothing hidden is sure"
    assert "unknown" in [text.get_text() for text in panel.texts]
    assert label in panel.get_legend_handles_labels()[1]
    known, _ = mapped(0.5)
    assert label not in known.get_legend_handles_labels()[1], "a control"
    assert "unknown" not in [text.get_text() for text in known.texts]
