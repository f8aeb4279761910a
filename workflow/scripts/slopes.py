"""Slopes of the mean adhesion energy of a pair to the quantities of one surface."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named, surface_and_quantity
from stiction.studies import slopes


def main(job):
    """Compare the energies at both values of every quantity."""
    less, more = (load_named(paths, "contact", surface_and_quantity) for paths in (job.input.less, job.input.more))
    contacts = {quantity: [less[surface, quantity], more[surface, quantity]] for surface, quantity in less}
    dataset = slopes.compute(contacts, typed(slopes.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "slopes", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
