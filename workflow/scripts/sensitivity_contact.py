"""Fig. 13: contact of a pair whose beam surface has a little less or a little more of one moment."""

from stiction.config.units import si
from stiction.run.logs import logged
from stiction.stages import cases, data, pairs
from stiction.studies import sensitivity


def main(heights, spectra, output, settings, wildcards):
    """Draw the same samples, in the sense of their random numbers, with a shifted moment."""
    beam, substrate = [
        (data.load(h, "heights"), data.load(s, "spectrum")) for h, s in zip(heights, spectra, strict=True)
    ]
    moments = {name: float(beam[0][name]) for name in cases.MOMENTS}
    less, more = sensitivity.shifted(moments[wildcards.moment], settings["step"])
    moments[wildcards.moment] = less if wildcards.side == "less" else more
    # ASSUME: the spectrum of the heights keeps its shape when a moment changes.
    shape = cases.surface(moments, cases.target_spectrum(beam[1]), si(settings["sampling"])["spacing"])
    contact = pairs.contact((shape, substrate), wildcards.pair, "NG", settings)
    data.save(contact.assign(moment=moments[wildcards.moment]), output, "contact", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.spectrum,
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards,
        )
