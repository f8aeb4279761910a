"""Settings of Sphinx; `make docs` builds docs/_build/html without a network."""

import shutil
import sys
from functools import cache
from pathlib import Path
from unittest.mock import patch

from sphinx import addnodes

DOCS = Path(__file__).parent
sys.path[:0] = [str(DOCS / "_ext"), str(DOCS.parent / "src")]

import stiction  # noqa: E402

project = "stiction"
author = "The stiction developers"
project_copyright = "2026, The stiction developers"
release = stiction.__version__

extensions = ["myst_parser", "mathml", "minus", "plain", "sphinx_copybutton", "sphinx_gallery.gen_gallery"]
extensions += [f"sphinx.ext.{name}" for name in ("autodoc", "autosummary", "napoleon", "viewcode")]
exclude_patterns = ["_build", "templates", "gallery"]
templates_path = ["_templates"]

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
html_math_renderer = "mathml"

autosummary_generate = True
# Otherwise pages of removed modules would remain.
shutil.rmtree(DOCS / "_api", ignore_errors=True)
autodoc_member_order = "bysource"
# Docstrings give shapes and units, annotations the types.
autodoc_typehints = "signature"
python_maximum_signature_line_length = 100
napoleon_google_docstring = False
napoleon_use_param = False
napoleon_use_rtype = False
# Attributes of dataclasses are described once, with their docstring.
napoleon_use_ivar = True
default_role = "py:obj"
nitpick_ignore = [("py:obj", "ast.dump")]
# Types of other libraries have no pages here; `range` is also the name of attributes.
nitpick_ignore_regex = [
    ("py:class", r"(?!stiction\.).*"),
    ("py:exc", r"(?!stiction\.).*"),
    ("py:class", r"stiction\.[\w.]+\.[A-Z]"),
]
suppress_warnings = ["ref.python"]
# Public names are described where they are defined.
nitpick_ignore += [("py:obj", f"stiction.{name}") for name in stiction.__all__]

# Studies that run when the documentation is built, and show their output without bars of progress.
stiction.show_progress(False)
sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "_gallery",
    "within_subsection_order": "FileNameSortKey",
    "show_memory": False,
    "min_reported_time": 1e9,
    "write_computation_times": False,
}

html_theme = "furo"
html_title = f"stiction {release}"
html_static_path = ["_static"]
html_css_files = ["stiction.css"]
html_copy_source = False
html_show_sphinx = False


def titled(_app, docname, source):
    """Give a table of ``docs/tables`` a title, and leave it out of the navigation: pages link to it."""
    if docname.startswith("tables/"):
        title = docname.removeprefix("tables/").replace("_", " ").capitalize()
        source[0] = f"---\norphan: true\n---\n\n# {title}\n\n{source[0]}"


@cache
def titles(env):
    """Contents of each page without its headings and objects: its title and the pages that it lists."""
    tocs = {name: toc.deepcopy() for name, toc in env.tocs.items()}
    for entry in (entry for toc in tocs.values() for entry in toc.children if len(entry) > 1):
        entry[1][:] = list(entry.findall(addnodes.toctree))
        if not entry[1].children:
            entry.pop(1)
    return tocs


def light_sidebar(app, pagename, _templatename, context, _doctree):
    """Copy titles only for the list of all pages, which shows no more; pages of source code have no list.

    A page of a module lists the modules beside it: a list of all on each of 350 pages takes a third of the time.
    """
    listed, collapsed = context["toctree"], {"collapse": True} if pagename.startswith("_api/") else {}

    def toctree(**options):
        with patch.object(app.env, "tocs", titles(app.env)):
            return listed(**options | collapsed)

    context["toctree"] = (lambda **_options: "") if pagename.startswith("_modules/") else toctree


def setup(app):
    """Register `titled` with Sphinx, and `light_sidebar` before the theme asks for the list."""
    app.connect("source-read", titled)
    app.connect("html-page-context", light_sidebar, priority=100)
