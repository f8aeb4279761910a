"""Figure 14: shapes and crack lengths of the beams of one case."""

from stiction import data
from stiction.figures import save
from stiction.figures_beams import beam_shapes
from stiction.logs import logged


def main(beams, outputs):
    """Draw the beams of one case."""
    save(beam_shapes(data.load(beams, "beams")), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.beams, snakemake.output)
