"""Secs. III-C and IV: press beams down, release them and find where their cracks arrest."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import beams, storage


def main(job):
    """Release all beams of a case."""
    dataset = beams.compute(
        storage.load(job.input.chaos, "chaos"), job.wildcards.case, typed(beams.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "beams", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
