"""Contact of a pair with one quantity of one surface slightly decreased or increased."""

from stiction.config.units import typed
from stiction.models import SHIFTED
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.studies import slope_contact


def main(job):
    """Draw samples with the same random numbers for all values of the quantities."""
    surfaces = storage.load_surfaces(job.input.heights, job.input.spectrum)
    wanted = typed(slope_contact.Settings, job.params.settings)
    at = job.wildcards
    of_modes = storage.load_all(job.input.estimates, "estimate")
    paths = storage.in_order(job.output, SHIFTED)
    contacts = slope_contact.compute(surfaces, at.pair, at.surface, at.quantity, wanted, *of_modes)
    for dataset, path in zip(contacts, paths, strict=True):
        storage.save(dataset, path, "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
