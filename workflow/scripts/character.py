"""Table I: statistics of simulated surfaces, sampled at the interval of the microscope."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import character, storage


def main(job):
    """Draw strips and periodic fields and compute their statistics."""
    surface = storage.load(job.input.heights, "heights"), storage.load(job.input.spectrum, "spectrum")
    dataset = character.compute(
        *surface, job.wildcards.surface, job.wildcards.model, typed(character.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "character", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
