"""Figure 14: shapes and crack lengths of the beams of one case."""

from stiction.report.figures_beams import beam_shapes
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Draw the beams of one case."""
    save(beam_shapes(storage.load(job.input.beams, "beams")), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
