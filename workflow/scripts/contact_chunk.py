"""Sec. III-A: contact of a range of surface pairs."""

from stiction.run.logs import logged
from stiction.stages import data, pairs


def main(heights, spectra, output, settings, pair, model, chunk, number):
    """Draw surface pairs and keep their solid pressure and bearing area."""
    surfaces = [(data.load(h, "heights"), data.load(s, "spectrum")) for h, s in zip(heights, spectra, strict=True)]
    total = settings["contact"]["samples"]
    samples = range(total * chunk // number, total * (chunk + 1) // number)
    data.save(pairs.contact(surfaces, pair, model, settings, samples), output, "contact", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.spectrum,
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.pair,
            snakemake.wildcards.model,
            int(snakemake.wildcards.chunk),
            int(snakemake.wildcards.number),
        )
