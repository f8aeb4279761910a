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
    assert opened.run("return document.getElementById('bar').offsetHeight") <= 844 / 10
    shown = (
        "return [...document.querySelectorAll('[data-confidence=\"95\"]')].map((cell) => cell.offsetParent !== null)"
    )
    assert not any(opened.run(shown))
    opened.resize(1500, 1000)
    assert all(opened.run(shown)), "the control"


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
    const said = ['said', 'promise', 'flat', 'unsafe', 'stuck', 'life', 'yaml'];
    return said.map((id) => document.getElementById(id).textContent);
    """
    said, promise, flat, unsafe, stuck, life, text = opened.run(moved)
    stuck = f"{unsafe} {stuck}".strip()
    assert f"humidities: [{air}]" in text
    assert ("liquids" in text) == (tension > 0 and kind != "stopper")
    assert ("materials:" in text) == (solids is OTHERS)
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    assert main(["check", str(tmp_path / "mine.yaml"), "-d", str(tmp_path)]) == 0
    capsys.readouterr()
    assert estimate.main([str(tmp_path / "mine.yaml")]) == 0
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    assert said in lines
    assert promise in lines
    assert flat.replace("\N{NO-BREAK SPACE}", " ") in lines
    assert stuck in lines
    life = life.replace("\N{NO-BREAK SPACE}", " ").splitlines()
    assert life == [line for line in lines if line.startswith("While ") or " it " in line and line not in (said, stuck)]
    assert len(life) == (0 if kind == "stopper" else 3 if tension else 1)


@pytest.mark.parametrize(
    ("kind", "slider", "safe", "unsafe"),
    [("cantilever", "length_um", 100, 300), ("bridge", "length_um", 60, 400), ("stopper", "force_uN", 500, 20)],
)
def test_the_page_says_first_and_in_red_that_a_size_is_not_safe(opened, kind, slider, safe, unsafe):
    moved = """
    const [kind, slider, value] = arguments, first = document.getElementById('unsafe');
    document.getElementById('tension_mN_per_m').value = 0;
    document.getElementById('humidity').value = 0.6;
    document.getElementById('kind').value = kind;
    document.getElementById(slider).value = value;
    document.getElementById('form').dispatchEvent(new Event('input', {bubbles: true}));
    return [first.textContent, document.getElementById('before').textContent, getComputedStyle(first).color,
      first === first.parentElement.firstElementChild];
    """
    sentence, before, colour, is_first = opened.run(moved, kind, slider, unsafe)
    assert f"{unsafe} µ" in sentence
    assert sentence.endswith(": not safe.")
    assert (colour, is_first) == ("rgb(185, 28, 28)", True)
    assert before == f"For exact inputs, before {'' if kind == 'stopper' else 'drying and '}fast separation."
    assert opened.run(moved, kind, slider, safe)[0] == "", "the control"


def test_what_is_known_of_the_surface_is_folded_until_it_is_stated(opened):
    alone = """
    for (const box of document.querySelectorAll('input[type=checkbox]')) box.checked = false;
    document.getElementById('surface').open = false;
    const box = document.getElementById('known_hurst'), isOpen = () => document.getElementById('surface').open;
    document.getElementById('form').dispatchEvent(new Event('input', {bubbles: true}));
    const before = isOpen();
    box.click();
    const after = isOpen();
    box.click();
    return [before, after];
    """
    assert opened.run(alone) == [False, True]


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
