"""HTML from templates. Every text is shown as its characters alone.

A stage that writes HTML has the `files` of its template among its inputs: a change of them makes its pages again.
"""

import base64
import hashlib
import re
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, meta

from stiction.plan.stage import File

TEMPLATES = Path(__file__).with_name("templates")
#: Most characters of a cell that is never broken.
_LONG = 24
#: Comments on lines of their own, and indentation.
_FOR_READERS = re.compile(r"^ *(?://.*|/\*\*.*\*/)\n|^ +", re.MULTILINE)
#: Space between two sentences, and most characters of a term that one explains.
_SENTENCE, _LONGEST_TERM = re.compile(r"(?<=\.) (?=[A-Z])"), 60
#: Space between the thousands of a number.
_THOUSANDS = re.compile(r"(?<=\d) (?=\d{3}\b)")


class _Loader(FileSystemLoader):
    """Templates, and scripts without what is for readers of the source alone."""

    def get_source(self, environment, template):
        """Source of a template (of scripts without comments and indentation), its file and whether it is new."""
        source, *rest = super().get_source(environment, template)
        return (_FOR_READERS.sub("", source) if template.endswith(".js") else source), *rest


_ENVIRONMENT = Environment(
    loader=_Loader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
)


def _kinds(cells):
    """Class of each column: long texts, which are broken, and words read from the left; numbers have none."""
    columns = [column.astype(str).str for _, column in cells.items()]
    return ["text" if (one.len() > _LONG).any() else "" if one.contains(r"\d").any() else "word" for one in columns]


def _explained(caption):
    """Sentences of a caption, each with the term before its colon, or none, and lines of a list without their mark.

    Examples
    --------
    >>> list(_explained("All rows. Limit: the least: one.")), list(_explained("- (1) Too steep: 0.1."))
    ([('', 'All rows.'), ('Limit', 'the least: one.')], [('', '(1) Too steep: 0.1.')])
    """
    for line in filter(None, caption.split("\n")):
        for sentence in [line.removeprefix("- ")] if line.startswith("- ") else _SENTENCE.split(line):
            term, _, text = sentence.partition(": ")
            is_term = text and len(term) <= _LONGEST_TERM and not line.startswith("- ")
            yield (term, text) if is_term else ("", sentence)


def _unbroken(text):
    """Text, or a number, in which no line ends between the thousands of a number."""
    return _THOUSANDS.sub("\N{NO-BREAK SPACE}", str(text))


_ENVIRONMENT.filters |= {"kinds": _kinds, "explained": _explained, "unbroken": _unbroken}
_ENVIRONMENT.policies["json.dumps_kwargs"] = {"sort_keys": True, "separators": (",", ":")}


def rendered(template: str, **values: Any) -> str:
    """Fill a template with values."""
    return _ENVIRONMENT.get_template(template).render(values)


@cache
def hash_of(script: str) -> str:
    """Hash of an included script, as a content security policy states it."""
    source, _, _ = _ENVIRONMENT.loader.get_source(_ENVIRONMENT, script)
    digest = hashlib.sha256(source.removesuffix("\n").encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode()}"


@cache
def files(template: str) -> tuple[File, ...]:
    """Files of a template: itself, and all its inclusions."""
    text = (TEMPLATES / template).read_text(encoding="utf-8")
    included = meta.find_referenced_templates(_ENVIRONMENT.parse(text))
    inside = [file for name in included for file in files(name)]
    return tuple(dict.fromkeys([File(TEMPLATES / template), *inside]))
