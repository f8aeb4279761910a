"""Sentences on the life of a device beside its estimate, and the size to use that obeys them."""

import pytest

from stiction.command.at_once import estimate
from stiction.command.main import main
from stiction.estimate.promise import promise

FILE = """
run: {pairs: [b], studies: []}
liquids: {water: {surface_tension_mN_per_m: 72}, Hexane: {surface_tension_mN_per_m: 18}}
devices:
  C1: {kind: cantilever, pair: b, thickness_um: 2.6, gap_um: 20, width_um: 30, humidities: [0.67]}
"""
NO_LIQUIDS = FILE.replace(FILE.splitlines()[2], "")
SPRING = "S1: {kind: stopper, pair: b, contact_um: [3, 3], restoring_force_uN: 20, mass_ng: 50, humidities: [0.67]}"
WITHOUT = FILE.partition("  C1")[0]
#: Beginnings of sentences on flat surfaces: `tests/estimate/test_flats_at_once.py`.
FLAT = "Flat", "Without its voltage, flat"
#: Promises about the size to use.
OF_LENGTHS, OF_FORCES = (promise("90", is_force) for is_force in (False, True))


def printed(tmp_path, capsys, text):
    """Sentences after the table, without that on flat surfaces and the last one."""
    (tmp_path / "mine.yaml").write_text(text)
    assert estimate.main([str(tmp_path / "mine.yaml")]) == 0
    *lines, _ = capsys.readouterr().out.splitlines()
    return [line.strip() for line in lines[8:] if not line.strip().startswith(FLAT)]


def with_keys(keys, text=FILE):
    """File with more keys of its device."""
    return text.replace("humidities: [0.67]}", f"humidities: [0.67], {keys}}}")


def test_drying_decides_the_length_to_use_and_has_a_sentence_for_each_liquid(tmp_path, capsys):
    first, *lines = printed(tmp_path, capsys, FILE)
    assert first.startswith("1 in 1000 sticks between 221 and ")
    assert first.endswith(" µm (90 %): use at most 199, or it can collapse while water dries.")
    assert lines == [
        OF_LENGTHS,
        "While water dries, beams stand up to 199 µm and collapse beyond 246 µm; "
        "after a collapse they stay down if they are longer than 234 µm.",
        "While Hexane dries, beams stand up to 282 µm and collapse beyond 348 µm; "
        "after a collapse they stay down if they are longer than 331 µm.",
        "At 199 µm it does not touch below a half-sine shock of 225 000 g.",
    ]
    assert printed(tmp_path, capsys, NO_LIQUIDS) == [
        first.partition(": use")[0] + ": use at most 221.",
        OF_LENGTHS,
        "At 221 µm it does not touch below a half-sine shock of 146 000 g.",
    ]


@pytest.mark.parametrize(
    ("length", "fate"),
    [
        (190, "stands while water or Hexane dries"),
        (219, "may collapse while water dries, and stands while Hexane dries"),
        (260.5, "collapses while water dries, and stands while Hexane dries"),
    ],
)
def test_a_stated_length_has_its_fate(tmp_path, capsys, length, fate):
    lines = printed(tmp_path, capsys, with_keys(f"length_um: {length}"))
    assert f"At {length:g} µm it {fate}." in lines
    assert any(line.startswith(f"At {length:g} µm it does not touch below a half-sine shock of ") for line in lines)
    assert any(line.startswith(f"{length:g} µm is longer than 199: not safe.") for line in lines) == (length > 199)


def test_a_liquid_that_does_not_wet_has_no_length(tmp_path, capsys):
    text = FILE.replace("surface_tension_mN_per_m: 72", "surface_tension_mN_per_m: 72, contact_angle_deg: 100")
    lines = printed(tmp_path, capsys, text)
    assert lines[2] == "Beams of any length stand while water dries."
    assert "use at most 221." in lines[0]


def test_a_shock_does_not_bring_it_down_or_does_and_a_run_says_what_to_use(tmp_path, capsys):
    lengths = "length_um: 219.352"
    for shock, effect in ((153e3, "does not bring"), (154e3, "can bring"), (280e3, "brings")):
        lines = printed(tmp_path, capsys, with_keys(f"{lengths}, shock_g: {shock:g}"))
        assert "At 219.352 µm it does not touch below a half-sine shock of 153 000 g." in lines
        assert f"Its own shock of {shock:g} g {effect} it down." in lines
        assert lines[1].endswith(
            "(90 %) if it separates slowly: menisci hold more in a shock, and a run says what to use."
        )
    dry = with_keys("shock_g: 3000", NO_LIQUIDS).replace("[0.67]", "[dry]")
    assert ": use at most " in printed(tmp_path, capsys, dry)[0]
    assert OF_LENGTHS not in lines, "a run says what to use"
    assert OF_LENGTHS in printed(tmp_path, capsys, dry), "control"


def test_a_bridge_may_be_brought_down_and_never_is_for_certain(tmp_path, capsys):
    text = FILE.replace("cantilever", "bridge").replace("2.6, gap_um: 20", "2, gap_um: 2")
    lines = printed(tmp_path, capsys, with_keys("residual_stress_MPa: 50, length_um: 164.696, shock_g: 9000000", text))
    assert "At 164.696 µm it may collapse while water dries, and stands while Hexane dries." in lines
    assert lines[2].endswith("after a collapse they stay down if they are longer than 181 µm; shorter ones may, too.")
    assert lines[-1] == "Its own shock of 9e+06 g can bring it down."


def test_a_voltage_below_which_it_does_not_touch_and_its_own_one(tmp_path, capsys):
    oxide = "dielectric: {thickness_nm: 100, permittivity: 3.9}, length_um: 219.352"
    lines = printed(tmp_path, capsys, with_keys(f"voltage_V: 5, {oxide}", NO_LIQUIDS))
    assert lines[-1] == "At 219.352 µm it does not touch below 420 V or a half-sine shock of 153 000 g."
    at_rest = printed(tmp_path, capsys, with_keys(f"voltage_V: 0, {oxide.replace('219.352', '600')}", NO_LIQUIDS))
    (limit,) = [line for line in at_rest if "does not touch" in line]
    volts = float(limit.partition("below ")[2].split()[0])
    driven = printed(
        tmp_path,
        capsys,
        with_keys(f"voltage_V: {volts - 1:g}, offset_V: 3, {oxide.replace('219.352', '600')}", NO_LIQUIDS),
    )
    assert driven[-1] == f"Its own voltage of {volts + 2:g} V can pull it in."


def test_a_stopper_has_a_shock_by_its_mass_and_a_voltage_by_its_electrode(tmp_path, capsys):
    assert printed(tmp_path, capsys, f"{WITHOUT}  {SPRING}\n")[-2:] == [
        OF_FORCES,
        "At 20 µN it does not touch below a half-sine shock of 23 000 g.",
    ]
    electrode = "stiffness_N_per_m: 75, gap_um: 1, electrode: {area_um2: 10000, gap_um: 2}"
    pulled = SPRING.replace("restoring_force_uN: 20, mass_ng: 50", electrode)
    assert printed(tmp_path, capsys, f"{WITHOUT}  {pulled}\n")[-1] == "At 75 µN it does not touch below 40.4 V."
    light = SPRING.replace(", mass_ng: 50", ", shock_g: 3000")
    assert printed(tmp_path, capsys, f"{WITHOUT}  {light}\n")[-1].startswith("1 in 1000 sticks")


def test_a_check_ends_with_the_length_that_stands(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text(FILE)
    assert main(["check", str(tmp_path / "mine.yaml"), "-d", str(tmp_path)]) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert "(90 %): use at most 199, or it can collapse while water dries; stiction estimate" in last
