"""Draw the pictures of devices and of the method for the docs from ``docs/drawings``: ``python docs/draw.py``.

They need no results: `docs/update.py` draws them whenever it updates the pages.
"""

import sys
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from stiction.report.html import TEMPLATES

DOCS = Path(__file__).parent
#: Options as of the package, whose template of colours these extend.
_ENVIRONMENT = Environment(
    loader=FileSystemLoader([DOCS / "drawings", TEMPLATES]),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)


def drawings() -> dict[Path, str]:
    """Contents of all drawings by their files."""
    names = sorted(path.name for path in (DOCS / "drawings").iterdir())
    return {DOCS / "pictures" / name: _ENVIRONMENT.get_template(name).render() for name in names}


if __name__ == "__main__":
    for path, svg in drawings().items():
        path.write_text(svg, encoding="utf-8")
        sys.stdout.write(f"{path}\n")
