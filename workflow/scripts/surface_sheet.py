"""Sheet of one measured surface."""

from stiction.measured.figures_scans import surface_sheet
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Draw what the scans show and what is drawn from it."""
    estimate, spectrum = (storage.load(job.input.get(stage), stage) for stage in ("estimate", "spectrum"))
    save(surface_sheet(job.wildcards.surface, estimate, spectrum), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
