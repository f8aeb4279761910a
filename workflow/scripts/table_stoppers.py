"""P(stuck) of all stoppers."""

from stiction.designs import findings
from stiction.designs.tables_budget import stoppers
from stiction.report.tables import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """Write one row per stopper and humidity."""
    found = load_named(job.input.stoppers, "stoppers")
    warnings = findings.of_stoppers(load_named(job.input.plasticity, "plasticity"), job.params.settings)
    save(stoppers(found, warnings), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
