"""End the run with a sentence if a check of the results failed."""

import sys

from stiction.report import checks, tables
from stiction.run.logs import logged
from stiction.stages import data


def main(path, output):
    """Read the checks; all must have passed."""
    table = tables.published(path)
    sentence = checks.verdict(table)
    if not table.passed.all():
        sys.exit(f"{sentence} Every number stands in results/checks.md.")
    data.save_text(f"{sentence}\n", output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0])
