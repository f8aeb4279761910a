"""Schema for editors."""

import json
import re
from pathlib import Path

import jsonschema
import yaml

from stiction.command import editor_schema

ROOT = Path(__file__).parents[2]


def test_editors_accept_every_file_that_changes_keys_and_notice_wrong_ones():
    editor = jsonschema.Draft7Validator(json.loads(editor_schema.text()))
    study = ROOT / "src" / "stiction" / "command" / "study.yaml"
    examples = [path for path in (ROOT / "examples").rglob("*.yaml") if path.parent.name != "validation"]
    for path in (study, *examples, ROOT / "workflow" / "smoke.yaml", ROOT / "config.yaml"):
        content = path.read_text(encoding="utf-8")
        editor.validate(yaml.safe_load(content))
        named = re.match(r"# yaml-language-server: \$schema=(\S+)", content)
        assert named or path.parent == ROOT / "workflow" or path.name == "config.yaml", f"{path} names no schema"
        if named and path != study:
            assert (path.parent / named[1]).resolve() == editor_schema.OF_CHECKOUT
    for wrong in ("beam: {thicknes_um: 3}", "pairs: {b: {humidities: 0.5}}", "surfaces: {B1: {rms_nm: -1}}"):
        assert not editor.is_valid(yaml.safe_load(wrong)), wrong


def test_the_schema_of_a_checkout_is_made_where_its_environment_is():
    assert "-m stiction.command.editor_schema\n" in (ROOT / "Makefile").read_text(encoding="utf-8")
    ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()
    assert str(editor_schema.OF_CHECKOUT.relative_to(ROOT)) in ignored
