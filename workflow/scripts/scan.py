"""Read a scan of a surface from the file of a microscope."""

from stiction.config.units import typed
from stiction.measured import scan
from stiction.run.logs import logged
from stiction.stages import storage


def main(job):
    """Read the map of heights."""
    dataset = scan.compute(job.input.file, typed(scan.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "scan", job.params.settings)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
