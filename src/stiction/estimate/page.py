"""Static page of the estimate: sliders and the arithmetic in JavaScript, in one file without network.

python -m stiction.estimate.page FILE
"""

import json
import sys

from stiction.estimate.answer import CONFIDENCES
from stiction.estimate.promise import promise
from stiction.estimate.table import FILE, origin
from stiction.run.atomic import save_text


def page() -> str:
    """Page as a text."""
    parts = {"table": FILE.name, "script": "estimate.js", "page": "page.js"}
    text = FILE.with_name("estimate.html").read_text(encoding="utf-8")
    for name, file in parts.items():
        text = text.replace(f"{{{{ {name} }}}}", FILE.with_name(file).read_text(encoding="utf-8").strip())
    promises = [promise(CONFIDENCES[0], is_force) for is_force in (False, True)]
    return text.replace("{{ promises }}", json.dumps(promises)).replace("{{ origin }}", origin())


if __name__ == "__main__":
    save_text(page(), sys.argv[1])
