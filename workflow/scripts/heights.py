"""Sec. II-A: the maximum-entropy height density of one surface."""

from stiction import data, maxent
from stiction.logs import logged
from stiction.units import si


def main(output, settings):
    """Solve for the density that has the moments of the surface."""
    moments = si(settings)
    density = maxent.solve(moments["skewness"], moments["kurtosis"])
    data.save(data.heights(density, moments), output, "heights", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.output[0], snakemake.params.settings)
