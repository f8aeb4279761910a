"""Sec. II-B: the spectrum of the Gaussian field underlying a measured surface."""

from stiction.config.units import typed
from stiction.measured import spectrum
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Take the fit or the table of the measured spectrum and invert the translation."""
    estimate = storage.load(job.input.estimate, "estimate")
    heights = storage.load(job.input.heights, "heights")
    dataset = spectrum.compute(estimate, heights, typed(spectrum.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "spectrum", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
