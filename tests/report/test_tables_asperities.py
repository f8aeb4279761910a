import numpy as np
import pandas as pd
import pytest
import xarray as xr

from stiction.report import style
from stiction.report.contact import asperities
from stiction.stages.contact import full_contact
from stiction.stages.contact.asperities import READINGS, layout

HUMIDITIES = [0.5, 0.7, 0.9]
PUBLISHED = pd.DataFrame(
    {
        "pair": "a",
        "relative_humidity": HUMIDITIES,
        "experiment": [690.0, 470.0, 360.0],
        "experiment_std": 20.0,
        "ng": [700.0, 480.0, 350.0],
        "ng_std": 5.0,
    }
)


def study(strips=6, shapes=3):
    """Energies of readings: islands adhere less than summits by 20 %, without attraction by 30 % less."""
    base = np.random.default_rng(1).uniform(1e-4, 2e-4, strips)[:, None] * [1.0, 10.0, 100.0]
    found = np.full((2, 4, strips, 2, 3), np.nan)
    for i, j, k in np.ndindex(2, 4, 2):
        if j < 3 or i == 0:
            found[i, j, :, k] = base * (1, 0.8, 0.9, 0.6)[j] * (1, 0.7)[k] * (1, 0.9)[i]
    found[:, 3, shapes:] = np.nan
    seconds = np.where(np.isnan(found[..., 0]), np.nan, 0.01 * np.arange(1, 5)[None, :, None, None])
    return layout(found, seconds, [1e-8, 5e-9], ["water", "none"], HUMIDITIES), base


STUDY, BASE = study()
_FULL = np.zeros((4, 2, 9))
_FULL[:, :, 0], _FULL[:, :, 2] = 0.6 * BASE[:4, [0, 2]], BASE[:4, [0, 2]]
FULL = full_contact.layout(_FULL, [0.5, 0.9], 1e-8)
BEAMS = {
    ("a", humidity): xr.Dataset({"crack_length": ("beam", [length] * 3), "state": ("beam", np.zeros(3, np.int8))})
    for humidity, length in zip(HUMIDITIES, (6e-4, 4.5e-4, 3.5e-4), strict=True)
}
DATA = {"a": STUDY}, {"a": FULL}, BEAMS


def row(frame, reading, vdw="water", spacing=10.0, humidity=0.5):
    chosen = frame[(frame.reading == reading) & (frame.vdw == vdw) & np.isclose(frame.spacing_nm, spacing)]
    return chosen[chosen.relative_humidity == humidity].iloc[0]


def test_numbers_of_each_reading():
    frame = asperities.table(*DATA, PUBLISHED).frame
    assert len(frame) == 3 * (3 * 2 * 2 + 2)
    island = row(frame, "island")
    assert island.change_percent == pytest.approx(100 * (0.8**-0.25 - 1))
    assert island.crack_length_um == pytest.approx(600 * 0.8**-0.25)
    assert island.deviation_percent == pytest.approx(100 * (island.crack_length_um / 700 - 1))
    assert island.time_over_summits == pytest.approx(2)
    assert (island.strips, row(frame, "shape").strips) == (6, 3)
    lengths = np.array([600, 450, 350]) * 0.8**-0.25 / [700, 480, 350]
    assert island.rms_published_percent == pytest.approx(100 * np.sqrt(np.mean((lengths - 1) ** 2)))
    assert island.rms_full_contact_percent == pytest.approx(100 * ((0.6 / 0.8) ** 0.25 - 1) * -1)
    assert row(frame, "shape").rms_full_contact_percent == pytest.approx(0, abs=1e-9)
    least = row(frame, "island", "none", 5.0)
    assert least.change_percent == pytest.approx(100 * ((0.8 * 0.7 * 0.9) ** -0.25 - 1))


def test_the_base_does_not_change_and_every_reading_has_a_line():
    table = asperities.table(*DATA, PUBLISHED)
    assert row(table.frame, "summit").change_percent == 0
    assert list(table.cells.asperity) == [*np.repeat(READINGS, 2)[:-1]] * 2
    assert list(table.cells["grid [nm]"]) == ["10", "5", "10", "5", "10", "5", "10"] * 2
    assert list(table.cells["time / summits"]) == ["1", "1", "2", "2", "3", "3", "4"] * 2


def test_a_line_shows_the_changes_at_both_ends_of_the_humidities():
    rising = STUDY.assign(adhesion_energy=STUDY.adhesion_energy.copy())
    rising.adhesion_energy.loc[{"reading": "island"}] *= xr.DataArray([0.5**4, 0.7, 0.25**4], dims="humidity") / 0.8
    line = asperities.table({"a": rising}, *DATA[1:], PUBLISHED).cells.iloc[2]
    shown = [float(line[f"Δl_s [%], {end}"].split(" ± ")[0]) for end in ("low RH", "high RH")]
    assert shown == pytest.approx([100, 300])


def test_pairs_that_were_not_published_have_no_deviation_from_print():
    table = asperities.table(*DATA, PUBLISHED[:0])
    assert table.frame.rms_published_percent.isna().all()
    assert table.frame.rms_full_contact_percent.notna().all()
    assert set(table.cells["rms dev. from published [%]"]) == {"–"}


def test_parts_of_the_error_multiply_to_the_error_itself():
    """Full contact has 0.6 of the energy of summits, islands of true shape as well: nothing is left for interaction."""
    frame = asperities.parts(*DATA[:2]).frame
    assert frame.relative_humidity.tolist() == [0.5, 0.9]
    assert set(frame.strips) == {3}
    factors = {part: 1 + frame[f"{part}_percent"] / 100 for part in ("shape", "interaction", "together", "grid")}
    np.testing.assert_allclose(factors["shape"] * factors["interaction"], factors["together"])
    np.testing.assert_allclose(factors["together"], 0.6**-0.25)
    np.testing.assert_allclose(factors["interaction"], 1)
    np.testing.assert_allclose(factors["grid"], 0.9**-0.25)
    assert list(asperities.parts(*DATA[:2]).cells.columns[:3]) == ["pair", "RH", "strips"]


@pytest.mark.parametrize("published", [PUBLISHED, PUBLISHED[:0]])
def test_the_figure_has_a_row_for_each_reading_at_the_lowest_humidity_and_equal_bytes(published):
    figure = asperities.figure(*DATA, published)
    (panel,) = figure.axes
    readings = [f"{reading}, {spacing} nm" for reading in ("summit", "island", "fitted") for spacing in (10, 5)]
    rows = [label.get_text() for label in panel.get_yticklabels()]
    assert sorted(rows) == sorted([*readings, "shape, 10 nm", "full contact"])
    at = rows.index("island, 10 nm")
    dots = [line.get_xdata()[0] for line in panel.lines if line.get_marker() == "o" and line.get_ydata()[0] == at]
    np.testing.assert_allclose(dots, [100 * (factor**-0.25 - 1) for factor in (0.8, 0.8 * 0.7)])
    (full,) = (line for line in panel.lines if line.get_marker() == "o" and line.get_color() == "black")
    np.testing.assert_allclose(list(full.get_xdata()), 100 * (0.6**-0.25 - 1))
    for label, length in (("published", 700), ("measured ± standard deviation", 690)):
        stated = [line.get_xdata()[0] for line in panel.lines if line.get_label() == label]
        np.testing.assert_allclose(stated, [100 * (length / 600 - 1)] if len(published) else [])
    assert style.png(figure) == style.png(asperities.figure(*DATA, published))


def test_text_of_the_figure_of_three_pairs_can_be_read_on_a_phone():
    frame, full = asperities.table(*DATA, PUBLISHED).frame, {pair: (1.0, 0.1) for pair in "abc"}
    frames = [frame.assign(pair=pair) for pair in "abc"]
    with style.on_a_page(style.SINGLE):
        figure = asperities.changes_drawn(pd.concat(frames), full, PUBLISHED)
    sizes = [text.get_fontsize() for panel in figure.axes for text in (*panel.texts, *panel.get_xticklabels())]
    assert min(sizes) / 72 * 390 / figure.get_figwidth() > 10  # pixels if the figure is 390 pixels wide
    assert [text.get_text() for text in figure.legends[0].get_texts()][-1] == "bars: ± standard error"
    numbers = [text for text in figure.axes[0].texts if text.get_text()]
    assert {text.xy[0] for text in numbers} == {1}, "numbers are in a column"
    assert numbers[-1].get_text() == "in water [%]", "the column says whose numbers it has"
    assert len({panel.get_xlim() for panel in figure.axes}) == 1
