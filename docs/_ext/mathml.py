"""Equations as MathML, which browsers draw without scripts, fonts or a network."""

import re

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml


def braced(source):
    r"""Equation in which every ``\frac43`` is ``\frac{4}{3}``, because docutils reads its digits as one number."""
    return re.sub(r"(\\[td]?frac)(\d)(\d)", r"\1{\2}{\3}", source)


def visit_inline(self, node):
    """Write an inline equation."""
    self.body.append(tex2mathml(braced(node.astext()), as_block=False))
    raise nodes.SkipNode


def visit_block(self, node):
    """Write a displayed equation."""
    self.body.append(f'<div class="math">{tex2mathml(braced(node.astext()), as_block=True)}</div>')
    raise nodes.SkipNode


def setup(app):
    """Register the renderer ``mathml``."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
