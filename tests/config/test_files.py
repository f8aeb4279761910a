"""Configuration files are read strictly, change single keys, and do not depend on the order of keys."""

import copy
import json

import numpy as np
import pytest
from configurations import PAPER, ROOT
from hypothesis import given
from hypothesis import strategies as st
from snakemake.utils import update_config

from stiction.config import files, reading
from stiction.config.files import load
from stiction.config.merging import merged
from stiction.config.messages import ConfigError
from stiction.config.validation import normalised


@given(*[st.recursive(st.integers(), lambda inner: st.dictionaries(st.sampled_from("abc"), inner, min_size=1))] * 2)
def test_files_are_merged_as_snakemake_does(base, overlay):
    merging = {"root": copy.deepcopy(base)}
    update_config(merging, {"root": overlay})
    assert merged({"root": base}, {"root": overlay}) == merging


def test_the_configuration_of_the_package_is_a_copy_of_that_of_the_checkout():
    assert not reading.PAPER.is_symlink()
    assert reading.PAPER.read_bytes() == (ROOT / "config.yaml").read_bytes(), "copy config.yaml to src/stiction/config"
    assert load() == PAPER


def test_overlays_change_single_keys_one_after_the_other(tmp_path):
    overlay = tmp_path / "mine.yaml"
    overlay.write_text("run: {pairs: [b]}\ncontact: {samples: 2000, chunks: 2}\n", encoding="utf-8")
    for path in (overlay, str(overlay)):
        config = load(path, {"contact": {"chunks": 4}})
        assert config["run"]["pairs"] == ["b"]
        assert config["contact"] == PAPER["contact"] | {"samples": 2000, "chunks": 4}
        assert config["surfaces"] == PAPER["surfaces"]


#: Values of NumPy and those of Python that they stand for.
OF_NUMPY = {
    "float32": (np.float32(2.5), 2.5),
    "float32 with decimals": (np.float32(0.45), 0.45),
    "float64": (np.float64(0.1), 0.1),
    "integer": (np.int64(2000), 2000),
    "truth": (np.bool_(True), True),
    "text": (np.str_("b"), "b"),
    "no dimension": (np.array(2.5), 2.5),
    "array": (np.array([0.44, 0.67]), [0.44, 0.67]),
    "array in single precision": (np.array([[0.44], [0.67]], np.float32), [[0.44], [0.67]]),
    "tuple": ((1, np.int8(2)), [1, 2]),
    "sections": ({"a": {"b": [np.float16(0.5)]}}, {"a": {"b": [0.5]}}),
}


@pytest.mark.parametrize(("value", "expected"), OF_NUMPY.values(), ids=OF_NUMPY)
def test_values_of_numpy_are_those_of_python(value, expected):
    found = files.plain(value)
    assert json.dumps(found) == json.dumps(expected)
    assert files.plain(expected) == expected


def test_a_configuration_of_numpy_is_that_of_python():
    of_numpy = {
        "surfaces": {"B2": {"rms_nm": np.float32(2.5)}},
        "pairs": {"b": {"humidities": np.array([0.67, 0.8])}},
        "contact": {"samples": np.int64(2000)},
        "run": {"pairs": ("b",)},
    }
    assert load(of_numpy) == load(files.plain(of_numpy))
    for wrong in ({"surfaces": {"B2": {"rms_nm": np.array([2.5, 3])}}}, {"contact": {"samples": np.float32(2000)}}):
        with pytest.raises(
            ConfigError, match=r"^(surfaces.B2.rms_nm is \[2.5, 3.0\]|contact.samples is 2000.0), must be"
        ):
            load(wrong)


def test_an_invalid_configuration_is_rejected_with_the_problems_of_all_overlays():
    with pytest.raises(ConfigError) as refused:
        load({"seed": -1}, {"chaos": {"order": 13}})
    assert [line.split()[0] for line in refused.value.problems] == ["seed", "chaos.order"]
    assert str(refused.value) == "\n".join(refused.value.problems)


def reordered(value):
    """The same configuration with the keys of all sections and all humidities in reverse order."""
    if not isinstance(value, dict):
        return value
    turned = {key: reordered(value[key]) for key in reversed(value)}
    return turned | ({"humidities": turned["humidities"][::-1]} if "humidities" in turned else {})


def test_the_normal_form_does_not_depend_on_the_order_of_keys_and_humidities():
    other = reordered(PAPER)
    assert (list(other), other["pairs"]["a"]["humidities"][0]) != (list(PAPER), 0.45)
    assert json.dumps(normalised(other)) == json.dumps(normalised(PAPER))
    assert normalised(PAPER) == PAPER
    assert json.dumps(normalised(PAPER)) == json.dumps(normalised(PAPER), sort_keys=True)
    assert json.dumps(load(other)) == json.dumps(load())


def test_the_normal_form_keeps_the_order_of_other_lists_and_does_not_change_its_argument():
    config = merged(PAPER, {"run": {"pairs": ["c", "a"]}, "pairs": {"a": {"humidities": [0.9, 0.5]}}})
    before = copy.deepcopy(config)
    assert normalised(config)["run"] == {"pairs": ["c", "a"]}
    assert normalised(config)["pairs"]["a"]["humidities"] == [0.5, 0.9]
    assert config == before
