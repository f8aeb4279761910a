"""Slopes of the mean adhesion energy of a pair to the quantities of one surface."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named
from stiction.studies import slopes


def main(job):
    """Compare the energies at both values of every quantity."""
    sides = [
        load_named(paths, "contact", lambda name: name.split("_")[2]) for paths in (job.input.less, job.input.more)
    ]
    contacts = {quantity: [side[quantity] for side in sides] for quantity in sides[0]}
    dataset = slopes.compute(contacts, typed(slopes.Settings, job.params.settings))
    storage.save(dataset, job.output[0], "slopes", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake)
