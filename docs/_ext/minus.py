"""Signs of minus in pages and tables, as on the pages of results; code keeps its hyphens."""

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms.post_transforms import SphinxPostTransform

from stiction.report.html import typeset

#: Elements whose text is code.
CODE = (nodes.literal, nodes.FixedTextElement, nodes.math, nodes.raw, addnodes.desc_signature)


def is_code(text):
    """Whether a text is inside an element of code."""
    while (text := text.parent) is not None:
        if isinstance(text, CODE):
            return True
    return False


class Minus(SphinxPostTransform):
    """Typeset all text that is not code, after references are resolved."""

    default_priority = 900

    def run(self):
        """Replace the texts of a document."""
        for text in list(self.document.findall(nodes.Text)):
            if not is_code(text):
                text.parent.replace(text, nodes.Text(typeset(text)))


def setup(app):
    """Register the transform."""
    app.add_post_transform(Minus)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
