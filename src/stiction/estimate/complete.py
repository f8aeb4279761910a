"""Question to the estimate about a device of a complete configuration."""

from collections.abc import Mapping
from typing import Any

from stiction.config.merging import differing
from stiction.config.reading import paper
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import Question, questions

#: Sections whose entries are read as a whole.
_WHOLE = ("surfaces", "pairs")


def question_of(config: Mapping[str, Any], name: str, section: Mapping[str, Any]) -> Question | NotLearnt:
    """Question about a device of a name and a section: what differs from the paper's configuration counts as stated."""
    stated = differing(config, paper()) | {key: config[key] for key in _WHOLE} | {"devices": {name: section}}
    return questions(stated, {"library": paper()["surfaces"], "pairs": {}})[name]
