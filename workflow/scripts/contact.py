"""Sec. III-A: the contact of all samples of a pair, joined from its chunks."""

from stiction.run.logs import logged
from stiction.stages import contact, storage


def main(job):
    """Join the chunks in the order of their samples."""
    dataset = contact.joined(storage.load_all(job.input, "contact"))
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake)
