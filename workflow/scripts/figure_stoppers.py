"""Pull-off force of all stoppers."""

from stiction.designs.figures_budget import stoppers
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import load_named


def main(job):
    """Draw P(stuck) over the restoring force, and the force over the humidity."""
    save(stoppers(load_named(job.input.stoppers, "stoppers")), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
