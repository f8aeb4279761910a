"""The page of the estimate in a browser: from a file, on a phone, with every slider at both ends."""

import json
import math

import pytest
from browser import Browser, missing

from stiction.command.at_once import estimate
from stiction.command.main import main
from stiction.estimate.page import page

pytestmark = [pytest.mark.slow, pytest.mark.browser, pytest.mark.skipif(bool(missing()), reason=missing())]
#: Sliders of solids and water.
OF_POLYSILICON = {"modulus_GPa": 164, "temperature_K": 300, "angle_deg": 0, "opposite_deg": 0, "water_zJ": 97.5}
OTHERS = {"modulus_GPa": 130, "temperature_K": 310, "angle_deg": 30, "opposite_deg": 10, "water_zJ": 75}
SAID = "return document.getElementById('said').textContent"


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "estimate.html"
    path.write_text(page(), encoding="utf-8")
    with Browser() as browser:
        browser.open(path)
        yield browser


def test_every_slider_moves_without_an_error_and_each_state_has_a_sentence(opened):
    moved = """
    const said = [];
    for (const slider of document.querySelectorAll('input[type=range]')) {
      const start = slider.value;
      for (const end of [slider.min, slider.max, start]) {
        slider.value = end;
        slider.dispatchEvent(new Event('input', {bubbles: true}));
        said.push(document.getElementById('said').textContent);
      }
    }
    return said;
    """
    said = opened.run(moved)
    assert all(line.startswith(("1 in 1000 sticks", "Not known at once")) for line in said)
    assert sum(line.startswith("1 in 1000 sticks") for line in said) > len(said) / 2
    assert opened.errors() == []


def test_the_page_fits_a_phone(opened):
    opened.resize(390, 844)
    assert opened.run("return document.documentElement.scrollWidth") <= 390
    assert opened.run("const pre = document.getElementById('yaml'); return pre.scrollWidth - pre.clientWidth") == 0
    assert opened.run("return document.getElementById('said').offsetHeight") <= 844 / 10
    opened.resize(1500, 1000)


def test_the_page_asks_nothing_of_a_network(opened):
    assert opened.run("return performance.getEntriesByType('resource').length") == 0
    assert "http" not in page().replace("http-equiv", "")


def test_the_page_has_no_barrier(opened):
    pytest.importorskip("axe_core_python")
    assert opened.violations() == []


def test_the_file_of_the_page_is_that_of_its_sliders(opened):
    text = opened.run("return document.getElementById('yaml').textContent")
    assert "like: B2" in text
    opened.run("const box = document.getElementById('known_skewness'); box.click(); return 1")
    text = opened.run("return document.getElementById('yaml').textContent")
    assert "skewness:" in text
    assert "kurtosis:" in text, "a run refuses one without the other"
    assert math.isfinite(float(opened.run("return document.getElementById('of_skewness').textContent")))


@pytest.mark.parametrize("kind", ["cantilever", "bridge", "stopper"])
@pytest.mark.parametrize(
    ("known", "tension"), [("[]", 0), ("['hurst', 'corner_rad_per_um', 'kurtosis']", 21.7), ("[]", 72)]
)
@pytest.mark.parametrize("air", ["0.6", "dry"])
@pytest.mark.parametrize("solids", [OF_POLYSILICON, OTHERS])
def test_the_command_says_of_the_file_of_the_page_what_the_page_says(
    opened, tmp_path, capsys, kind, known, tension, air, solids
):
    moved = f"""
    document.getElementById('kind').value = '{kind}';
    for (const [key, value] of Object.entries({json.dumps(solids)})) document.getElementById(key).value = value;
    const air = document.getElementById('humidity');
    air.value = '{air}' === 'dry' ? air.min : '{air}';
    document.getElementById('tension_mN_per_m').value = '{tension}';
    for (const box of document.querySelectorAll('input[type=checkbox]')) box.checked = false;
    for (const key of {known}) document.getElementById('known_' + key).click();
    document.getElementById('form').dispatchEvent(new Event('input', {{bubbles: true}}));
    return ['said', 'stuck', 'life', 'yaml'].map((id) => document.getElementById(id).textContent);
    """
    said, stuck, life, text = opened.run(moved)
    assert f"humidities: [{air}]" in text
    assert ("liquids" in text) == (tension > 0 and kind != "stopper")
    assert ("materials:" in text) == (solids is OTHERS)
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    assert main(["check", str(tmp_path / "mine.yaml"), "-d", str(tmp_path)]) == 0
    capsys.readouterr()
    if (kind, air) == ("bridge", "dry"):
        reason = "a bridge was not learnt in dry air"
        assert estimate.main([str(tmp_path / "mine.yaml")]) == 2
        assert reason in said
        assert reason in capsys.readouterr().out
        return
    assert estimate.main([str(tmp_path / "mine.yaml")]) == 0
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    assert said in lines
    assert stuck in lines
    life = life.replace("\N{NO-BREAK SPACE}", " ").splitlines()
    assert life == [line for line in lines if line.startswith("While ") or " it " in line and line not in (said, stuck)]
    assert len(life) == (0 if kind == "stopper" else 3 if tension else 1)


def test_a_stopper_has_its_own_sliders_forces_and_file(opened):
    choose = """
    const kind = document.getElementById('kind');
    kind.value = 'KIND';
    kind.dispatchEvent(new Event('input', {bubbles: true}));
    const seen = (id) => document.getElementById(id).offsetParent !== null;
    return [seen('side_um'), seen('gap_um'), ...['said', 'yaml'].map((id) => document.getElementById(id).textContent)];
    """
    side, gap, said, text = opened.run(choose.replace("KIND", "stopper"))
    assert (side, gap) == (True, False)
    assert "µN" in said
    assert "kind: stopper" in text
    assert "contact_um: [3, 3]" in text
    assert opened.errors() == []
    side, gap, said, text = opened.run(choose.replace("KIND", "cantilever"))
    assert (side, gap) == (False, True)
    assert "µm" in said
    assert "kind: cantilever" in text
