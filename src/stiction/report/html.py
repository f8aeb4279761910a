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
#: Cell of a column of words, or an empty one in it.
_WORD = r"[^\W\d].*|\W?"
#: Comments on lines of their own, and indentation.
_FOR_READERS = re.compile(r"^ *(?://.*|/\*\*.*\*/)\n|^ +", re.MULTILINE)
#: Space between the thousands of a number, and hyphen that is its sign or stands between two terms.
_THOUSANDS, _SIGN = re.compile(r"(?<=\d) (?=\d{3}\b)"), re.compile(r"(?<![\w.)])-(?=\d)|(?<=[\w)] )-(?= [\w(])")


class _Loader(FileSystemLoader):
    """Templates, and scripts without what is for readers of the source alone."""

    def get_source(self, environment, template):
        """Source of a template (of scripts without comments and indentation), its file and whether it is new."""
        source, *file_and_age = super().get_source(environment, template)
        return (_FOR_READERS.sub("", source) if template.endswith(".js") else source), *file_and_age


_ENVIRONMENT = Environment(
    loader=_Loader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
)


def _kinds(cells):
    """Class of each column: long texts, which are broken, and words read from the left; numbers have none."""
    columns = [column.astype(str).str for _, column in cells.items()]
    return [
        "text" if (column.len() > _LONG).any() else "word" * bool(column.fullmatch(_WORD).all()) for column in columns
    ]


def with_minus(text: str) -> str:
    """Text with signs of minus in place of hyphens before numbers and between terms.

    Examples
    --------
    >>> with_minus("-5.3 %, 1 - (1 - p)^n, from 2026-11-30 on, B2-like")
    '−5.3 %, 1 − (1 − p)^n, from 2026-11-30 on, B2-like'
    """
    return _SIGN.sub("\N{MINUS SIGN}", text)


def typeset(text: Any) -> str:
    """Text, or a number, with signs of minus, in which no line ends between the thousands of a number.

    Examples
    --------
    >>> typeset("-5.3 % of 20 000, from 2026-11-30 on").replace("\N{NO-BREAK SPACE}", "_")
    '−5.3 % of 20_000, from 2026-11-30 on'
    """
    return with_minus(_THOUSANDS.sub("\N{NO-BREAK SPACE}", str(text)))


_ENVIRONMENT.filters |= {"kinds": _kinds, "typeset": typeset}
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
