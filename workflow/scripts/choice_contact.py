"""Contact of a pair with another choice of how its scans are evaluated."""

from stiction.config.units import typed
from stiction.measured import choices
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named


def main(job):
    """Evaluate the estimates otherwise and draw samples with the random numbers of the pair."""
    surfaces = storage.load_surfaces(job.input.heights, job.input.spectrum)
    estimates = load_named(job.input.estimates, "estimate")
    at, wanted = job.wildcards, typed(choices.Settings, job.params.settings)
    dataset = choices.compute(surfaces, estimates, at.pair, at.choice, wanted)
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
