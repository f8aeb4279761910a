"""Pull-off force of all stoppers."""

from stiction.designs import findings
from stiction.designs.figures_budget import stoppers
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """Draw P(stuck) over the restoring force, and the force over the humidity, with the warnings below."""
    found = load_named(job.input.stoppers, "stoppers")
    warnings = findings.of_stoppers(load_named(job.input.plasticity, "plasticity"), job.params.settings)
    save(stoppers(found, warnings), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
