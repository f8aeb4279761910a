"""Sec. III-A: the contact of all samples of a pair, joined from its chunks."""

from stiction.run.logs import logged
from stiction.stages import contact, storage


def main(job):
    """Join the chunks in the order of their samples, one at a time."""
    chunks = (storage.load(path, "contact") for path in job.input)
    dataset = contact.joined(chunks, job.params.settings["contact"]["samples"])
    storage.save(dataset, job.output[0], "contact", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
