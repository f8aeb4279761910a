"""Run devices on drawn surfaces: python drawn_devices.py FIRST LAST, one line each.

Every draw must end in an answer, or be refused before the first job.
"""

import sys
import time
import warnings
from pathlib import Path

sys.path = [*sys.path[1:], str(Path(__file__).parents[1])]  # this file has the name of the module that it imports

from drawn_devices import drawn, outcome


def main(first, last):
    for number in range(int(first), int(last)):
        start = time.process_time()
        warnings.simplefilter("ignore")
        found = outcome(drawn(number))
        print(f"{number} {drawn(number)} {time.process_time() - start:.0f} s\n    {found}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
