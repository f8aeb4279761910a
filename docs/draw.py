"""Draw the pictures of devices and of the method for the docs: ``python docs/draw.py``.

They need no results: `docs/update.py` draws them whenever it updates the pages.
"""

import sys
from pathlib import Path

from stiction.report.drawings import devices
from stiction.report.drawings.method import method

PICTURES = Path(__file__).parent / "pictures"


def drawings() -> dict[Path, str]:
    """Contents of all drawings by their files."""
    drawn = (devices.beam(), devices.stopper_and_bridge(), method())
    return {PICTURES / f"{drawing.name}.svg": drawing.svg for drawing in drawn}


if __name__ == "__main__":
    for path, svg in drawings().items():
        path.write_text(svg, encoding="utf-8")
        sys.stdout.write(f"{path}\n")
