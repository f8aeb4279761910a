"""App. A, Fig. 16: stress of every touching summit of a pair at a small distance."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import plasticity


def main(job):
    """Find the touching summits of all strips and the share of their area that yields."""
    surfaces = storage.load_surfaces(job.input.heights, job.input.spectrum)
    dataset = plasticity.compute(surfaces, job.wildcards.pair, typed(plasticity.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "plasticity", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
