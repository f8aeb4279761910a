"""Every number with an error in the tables and checks of a finished run has the digits that its error allows."""

import re

#: A value with its error, as in 57.82 ± 0.20.
PAIR = re.compile(r"([+-]?[\d.]+) ± ([\d.]+)")


def faults(text):
    """Numbers of a text with other decimals than their errors, with too few digits of the error, or a negative zero."""
    found = re.findall(r"(?<![\w.,^{−-])[−-]0(?:\.0*)?(?![\d.])", text)
    for value, error in PAIR.findall(text):
        decimals = [len(number.rstrip(".").partition(".")[2]) for number in (value, error)]
        digits = error.replace(".", "").lstrip("0")
        exact = error == "0"  # all samples are equal
        if not exact and (decimals[0] != decimals[1] or digits in ("", "1")):
            found.append(f"{value} ± {error}")
    return found


def test_all_numbers_of_a_run_have_the_digits_of_their_errors(smoke):
    results = smoke / "results"
    paths = [*results.glob("tables/*.md"), *results.glob("tables/*.html"), results / "checks.md"]
    texts = {path.name: path.read_text(encoding="utf-8") for path in paths}
    assert len(texts) >= 13
    assert sum(len(PAIR.findall(text)) for text in texts.values()) > 100
    assert {name: faults(text) for name, text in texts.items() if faults(text)} == {}


def test_numbers_with_wrong_digits_are_noticed():
    wrong = ["0.0012 ± 0.001", "57.8 ± 0.20", "5 ± 0.0", "| -0 |", "| -0.00 |", "<td>−0.0<"]
    assert [bool(faults(text)) for text in wrong] == [True] * len(wrong)
    right = ["0.0012 ± 0.0010", "57.8 ± 0.4", "0.5 ± 0", "-0.04", "+0.0 ± 0.3", "1234 ± 30"]
    assert [faults(text) for text in right] == [[]] * len(right)
