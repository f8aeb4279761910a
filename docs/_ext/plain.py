"""Literal bars and colons in docstrings: ``|x|`` is no substitution, and a colon after an attribute marks no type."""

import re

#: Text in which bars are not escaped: literals and roles.
_MARKED = re.compile(r"(`+[^`]*`+)")
_WITHOUT_TYPE = {"attribute", "data", "property"}
#: Placeholder for a colon, a character that occurs in no text.
_HIDDEN = "\ue000"


def with_bars(lines):
    """Lines of a docstring in which ``|x|`` outside of formulas is no substitution."""
    formula = None
    for line in lines:
        indent = len(line) - len(line.lstrip())
        if line.strip() and formula is not None and indent <= formula:
            formula = None
        if line.lstrip().startswith(".. math::"):
            formula = indent
        if formula is None:
            parts = _MARKED.split(line)
            line = "".join(part if k % 2 else part.replace("|", r"\|") for k, part in enumerate(parts))
        yield line


def before(app, what, name, obj, options, lines):  # noqa: ARG001
    """Escape bars, and hide colons from napoleon, which reads the text before the colon of an attribute as its type."""
    lines[:] = with_bars(lines)
    if what in _WITHOUT_TYPE:
        lines[:] = [line.replace(":", _HIDDEN) for line in lines]


def after(app, what, name, obj, options, lines):  # noqa: ARG001
    """Restore the colons."""
    lines[:] = [line.replace(_HIDDEN, ":") for line in lines]


def setup(app):
    """Connect the two steps before and after napoleon, whose priority is 500."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", before, priority=1)
    app.connect("autodoc-process-docstring", after, priority=900)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
