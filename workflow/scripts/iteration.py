"""Sec. II-B2, Fig. 4: the iterative algorithm, for comparison with the closed form."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import iteration


def main(job):
    """Run the iterations and store all spectra."""
    surface = storage.load(job.input.heights, "heights"), storage.load(job.input.spectrum, "spectrum")
    dataset = iteration.compute(*surface, job.wildcards.surface, typed(iteration.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "iteration", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
