"""Limits of results as text of JSON, in files and in variables of datasets."""

import json
from collections.abc import Iterable

from stiction.devices.limits.limit import Limit, restored


def as_text(limits: Iterable[Limit]) -> str:
    """Limits as one line of text, empty without any."""
    stored = [limit.stored() for limit in limits]
    return json.dumps(stored, ensure_ascii=False, allow_nan=False) if stored else ""


def of_text(text: str) -> list[Limit]:
    """Limits from their text, the inverse of `as_text`.

    Examples
    --------
    >>> from stiction.devices.limits.rules import thin_film
    >>> of_text(as_text([thin_film(1e-9)])) == [thin_film(1e-9)]
    True
    """
    return [restored(fields) for fields in json.loads(text or "[]")]
