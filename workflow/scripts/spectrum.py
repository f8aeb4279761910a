"""Sec. II-B: the spectrum of the Gaussian field underlying a non-Gaussian surface."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import spectrum, storage


def main(job):
    """Take the published or the identified parameters of Eq. (7) and invert the translation."""
    identification = storage.load(job.input.identification, "identification") if job.input.identification else None
    dataset = spectrum.compute(
        storage.load(job.input.heights, "heights"), identification, typed(spectrum.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "spectrum", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
