"""A configuration is prepared in one way, and what one process found out the next one need not."""

from datetime import date
from unittest.mock import patch

import pytest
import yaml

from stiction.command import prepared as module
from stiction.command.prepared import prepared
from stiction.config import validation
from stiction.config.files import joined, load
from stiction.config.messages import ConfigError
from stiction.run.disk_cache import Caches

COMPARED = {"run": {"pairs": ["b"]}, "compare": {"surfaces.B2.rms_nm": [3, 5]}}


@pytest.fixture
def asked():
    """Configurations that are checked."""
    seen, check = [], validation.checked
    with patch.object(validation, "checked", lambda stated, kept: seen.append(stated) or check(stated, kept)):
        yield seen


def test_the_configuration_is_that_of_python():
    ready = prepared(joined(COMPARED))
    assert (ready.config, ready.estimates, ready.numbers) == (load(COMPARED), {}, None)
    assert ready.config["run"]["pairs"] == ["bRms3", "bRms5"]


def test_a_known_configuration_is_not_checked_again_and_another_one_is(asked, tmp_path):
    kept, stated = Caches(tmp_path), joined(COMPARED)
    first = prepared(stated, kept)
    assert prepared(stated, kept) == first
    assert len(asked) == 1
    prepared(joined(COMPARED | {"seed": 2}), kept)
    assert len(asked) == 2, "control"
    assert prepared(stated) == first
    assert len(asked) == 3, "nothing is kept without a folder"


def test_other_code_or_another_schema_checks_a_known_configuration_again(asked, tmp_path):
    kept, stated = Caches(tmp_path), joined(COMPARED)
    prepared(stated, kept)
    with patch.object(module, "fingerprint", lambda *_, **__: {"stiction.config.relations": "changed"}):
        prepared(stated, kept)
    assert len(asked) == 2
    for number, changed in enumerate(("paper.yaml", "schema.yaml", "materials.yaml"), 3):
        for name in ("paper.yaml", "schema.yaml", "materials.yaml"):
            text = module.PAPER.with_name(name).read_text(encoding="utf-8")
            (tmp_path / name).write_text(text + "# changed" * (name == changed), encoding="utf-8")
        with patch.object(module, "PAPER", tmp_path / "paper.yaml"):
            prepared(stated, kept)
        assert len(asked) == number


def test_an_invalid_configuration_is_refused_each_time(asked, tmp_path):
    stated = joined({"seed": -1})
    for _ in range(2):
        with pytest.raises(ConfigError, match="^seed is -1"):
            prepared(stated, Caches(tmp_path))
    assert len(asked) == 2


DEVICE = {"kind": "stopper", "pair": "b", "contact_um": [3, 3], "restoring_force_uN": 5, "humidities": [0.6]}


@pytest.mark.parametrize("name", [True, 1, None, 2.5, date(2020, 1, 31)])
@pytest.mark.parametrize("section", ["devices", "surfaces", "pairs"])
def test_names_that_yaml_reads_as_no_text_are_refused_before_and_after_those_of_their_text(name, section, tmp_path):
    kept = Caches(tmp_path)
    paper_and = {"run": {"pairs": ["b"]}, "devices": {"S": DEVICE}}
    prepared(joined(paper_and | {"devices": {"true": DEVICE, "S": DEVICE}}), kept)
    wrong = joined(paper_and)
    wrong[section] = wrong[section] | {name: {}}
    with pytest.raises(ConfigError, match="is not a valid name"):
        prepared(wrong, kept)
    wrong[section] = {name: {}}
    with pytest.raises(ConfigError, match="is not a valid name"):
        prepared(wrong, kept)


def test_a_whole_number_of_too_many_digits_is_refused_in_a_sentence(tmp_path):
    with pytest.raises(ConfigError, match="must contain short numbers"):
        prepared(joined({"seed": 16**4000}), Caches(tmp_path))


def test_scans_are_looked_at_each_time(asked, tmp_path):
    missing = joined(yaml.safe_load("surfaces: {Mine: {scans: {files: [/none/a.gwy]}}}"))
    for _ in range(2):
        with pytest.raises(ConfigError, match="cannot be opened"):
            prepared(missing, Caches(tmp_path))
    assert len(asked) == 2


def test_a_configuration_whose_samples_fail_is_refused_where_samples_are_asked_for(tmp_path):
    weak = joined({"run": {"pairs": ["b"]}, "beam": {"width_um": 0.06}, "attraction": {"reach": "touching"}})
    assert prepared(weak, Caches(tmp_path)).config["beam"]["width_um"] == 0.06
    for _ in range(2):
        with pytest.raises(ConfigError, match="^beam.width_um is 0.06"):
            prepared(weak, Caches(tmp_path), with_samples=True)
