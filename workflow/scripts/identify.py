"""Sec. II-C: the spectrum whose surfaces have the measured summits."""

from stiction.run.logs import logged
from stiction.stages import data
from stiction.stages.identifications import identification


def main(heights, output, settings, surface):
    """Fit Eq. (7) to radius and density of the summits."""
    found = identification(surface, data.load(heights, "heights"), settings)
    data.save(found, output, "identification", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.heights, snakemake.output[0], snakemake.params.settings, snakemake.wildcards.surface)
