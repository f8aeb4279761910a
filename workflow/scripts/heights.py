"""Sec. II-A: the maximum-entropy height density of one surface."""

from stiction.config.units import si
from stiction.run.logs import logged
from stiction.stages import data
from stiction.surface import maxent


def main(output, settings):
    """Solve for the density that has the moments of the surface."""
    moments = si(settings)
    density = maxent.solve(moments["skewness"], moments["kurtosis"])
    data.save(data.heights(density, moments), output, "heights", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.output[0], snakemake.params.settings)
