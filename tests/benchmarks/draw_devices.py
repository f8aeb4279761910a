"""Run devices on drawn surfaces, ``python tests/benchmarks/draw_devices.py FIRST LAST``: two lines each.

Every draw must end in an answer, or be refused before the first job.
"""

import sys
import time
import warnings
from importlib import import_module
from pathlib import Path

#: Folder of the module with the draws, which has the name of this file.
TESTS = str(Path(__file__).parents[1])


def main(first, last):
    """Run the draws from a number up to another one."""
    sys.path = [TESTS, *sys.path[1:]]
    draws = import_module("drawn_devices")
    warnings.simplefilter("ignore")
    for number in range(int(first), int(last)):
        start, of = time.process_time(), draws.drawn(number)
        found = draws.outcome(of)
        sys.stdout.write(f"{number} {of}, {time.process_time() - start:.0f} s\n    {found}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
