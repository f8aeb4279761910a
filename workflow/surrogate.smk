"""Points from which the estimate is learnt, and its table, in the folder that --directory names.

The file control.json shows whether the contacts are still those of the points: see stiction.estimate.learning.jobs.control.
"""

import re
import sys

from stiction.estimate.learning.jobs.families import FAMILIES

PYTHON = f"OPENBLAS_NUM_THREADS=1 {sys.executable} -m stiction.estimate.learning"


wildcard_constraints:
    family="|".join(map(re.escape, FAMILIES)),
    set=r"\w+",
    first=r"\d{4}",


rule table:
    input:
        "control.json",
        [chunk for family in FAMILIES.values() for chunk in family.chunks()],
    output:
        "table.json",
    resources:
        runtime=30,
        mem_mb=1500,
    message:
        "Table of the estimate."
    shell:
        "{PYTHON}.make . {output}"


rule points:
    input:
        "control.json",
        lambda at: f"{FAMILIES[at.family].after}/{at.set}/{at.first}" if FAMILIES[at.family].after else [],
    output:
        directory("{family}/{set}/{first}"),
    resources:
        runtime=60,
        mem_mb=1500,
    params:
        effort=lambda at: repr((FAMILIES[at.family].sets[at.set], FAMILIES[at.family].numbers(at.set))),
    message:
        "Points of {output}."
    shell:
        "{PYTHON}.jobs.families {output}"
