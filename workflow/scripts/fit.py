"""Sec. III-B1, Fig. 5: relative errors of Eq. (12) with respect to the force curves."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import fit


def main(job):
    """Compare every curve with the force law of its vector v."""
    dataset = fit.compute(
        storage.load(job.input.contact, "contact"),
        storage.load(job.input.forces, "forces"),
        typed(fit.Settings, job.params.settings),
    )
    storage.save(dataset, job.output[0], "fit", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
