"""Summits of a pair under one variant, i.e. one changed model choice; independent of the solids and of humidity."""

from stiction.config.merging import merged
from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named
from stiction.variants import summits


def main(job):
    """Draw the surfaces of the base with the changed settings."""
    settings = job.params.settings
    identifications = load_named(job.input.identifications, "identification")
    heights, spectra = (load_named(job.input[stage], stage) for stage in ("heights", "spectrum"))
    measured = {name: (heights[name], spectra[name]) for name in heights}
    changed = merged(settings["base"], settings["changes"])
    wanted = [typed(summits.Settings, plain) for plain in (settings["base"], changed)]
    dataset = summits.compute(identifications, job.wildcards.pair, *wanted, measured)
    storage.save(dataset, job.output[0], "variant_summits", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
