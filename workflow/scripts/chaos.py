"""App. B: the chaos model of the force law, and its statistics compared with its input."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import chaos, storage


def main(job):
    """Fit the chaos model and compare draws from it with its input."""
    dataset = chaos.compute(
        storage.load(job.input.forces, "forces"),
        job.wildcards.case,
        job.wildcards.model,
        typed(chaos.Settings, job.params.settings),
    )
    storage.save(dataset, job.output[0], "chaos", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
