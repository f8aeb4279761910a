"""Safe lengths of beams of several thicknesses and gaps at one humidity of the axis of a chart."""

from stiction.config.units import typed
from stiction.designs import chart
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Compute beams by finite elements, and those between them by a power law."""
    tips = storage.load(job.input.tips, "contact") if job.input.tips else None
    wanted = typed(chart.Settings, job.params.settings)
    dataset = chart.compute(storage.load(job.input.contact, "contact"), tips, wanted)
    storage.save(dataset, job.output[0], "chart", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
