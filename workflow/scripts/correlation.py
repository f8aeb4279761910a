"""App. C, Fig. 19c: autocorrelation of the surfaces."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named
from stiction.studies import correlation


def main(job):
    """Transform the spectra, Eq. (7)."""
    spectra = load_named(job.input.spectra, "spectrum")
    dataset = correlation.compute(spectra, typed(correlation.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "correlation", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
