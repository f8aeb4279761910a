"""Question to the estimate about a device of a complete configuration."""

import math
from collections.abc import Mapping
from typing import Any

from stiction.config.reading import paper
from stiction.estimate.bridge import Bridge
from stiction.estimate.force import Stopper
from stiction.estimate.length import NotLearnt
from stiction.estimate.question import Question, questions

#: Sections whose entries are read as a whole.
_READ_AS_STATED = ("surfaces", "pairs")
#: Relative difference up to which numbers count as those of the paper, less than any that a length shows.
_SAME = 1e-5


def question_of(
    config: Mapping[str, Any], name: str, section: Mapping[str, Any]
) -> Question | Stopper | Bridge | NotLearnt:
    """Question about a device of a name and a section: what differs from the paper's configuration counts as stated."""
    others = {key: value for key, value in config.items() if key not in (*_READ_AS_STATED, "devices")}
    stated = _differing(others, paper()) | {key: config[key] for key in _READ_AS_STATED} | {"devices": {name: section}}
    return questions(stated, {"library": paper()["surfaces"], "pairs": {}})[name]


def _differing(config, base):
    """Keys of nested sections with other values than in another configuration."""
    differing = {}
    for key, value in config.items():
        other = base.get(key)
        if isinstance(value, Mapping) and isinstance(other, Mapping):
            value, other = _differing(value, other), {}
        if not _is_same(value, other):
            differing[key] = value
    return differing


def _is_same(value, other):
    """Whether two values are equal, numbers but for their last digits."""
    if isinstance(value, int | float) and isinstance(other, int | float):
        return math.isclose(value, other, rel_tol=_SAME)
    return value == other
