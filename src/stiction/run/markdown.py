"""Text in Markdown as its characters alone, for names, files and channels of users."""

import re

#: Signs that begin a formula, a tag, a reference, an emphasis or the address of a link, or that end a word's emphasis.
_SIGNS = re.compile(r"[\\$<&]|\*(?=\S)|_(?![^\W_])|(?<=\])\(")


def literal(text: str) -> str:
    r"""Write text as one line.

    Examples
    --------
    >>> print(literal("a $x$ <script>.gwy"))
    a \$x\$ \<script>.gwy
    """
    return _SIGNS.sub(r"\\\g<0>", " ".join(text.splitlines()))


def cell(text: str) -> str:
    r"""Write text as a cell of a table.

    Examples
    --------
    >>> print(cell("a|b.gwy"))
    a\|b.gwy
    """
    return literal(text).replace("|", r"\|")


def plain(line: str) -> str:
    """Read a line written by `literal`.

    Examples
    --------
    >>> plain(literal("a $x$ <script>.gwy"))
    'a $x$ <script>.gwy'
    """
    return re.sub(r"\\([\\$<&*_(])", r"\1", line)
