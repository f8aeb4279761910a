"""Stop the run with a message if a check of the results failed."""

import sys

from stiction.report import checks
from stiction.run import atomic
from stiction.run.logs import logged


def main(job):
    """Read the checks and exit with an error if any failed."""
    table = checks.read(job.input.checks)
    sentence = checks.verdict(table)
    if not table.passed.all():
        sys.exit(f"{sentence} Every number is in results/checks.md.")
    atomic.save_text(f"{sentence}\n", job.output[0])


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
