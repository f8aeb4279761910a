"""Progress bars of long loops."""

import sys

from tqdm import tqdm


def progress(steps, what, total=None):
    """Iterate over ``steps`` and show a progress bar on the standard error, which in a job is its log."""
    return tqdm(steps, desc=what, total=total, mininterval=2.0, ascii=True, file=sys.stderr)
