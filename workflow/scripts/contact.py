"""Sec. III-A: the contact of all samples of a pair, from its chunks."""

import xarray as xr

from stiction.run.logs import logged
from stiction.stages import data


def main(chunks, output, settings):
    """Join the chunks in the order of their samples."""
    parts = [data.load(chunk, "contact") for chunk in chunks]
    joined = xr.concat(parts, "sample", data_vars="minimal", coords="minimal", compat="equals", join="exact")
    data.save(joined, output, "contact", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output[0], snakemake.params.settings)
