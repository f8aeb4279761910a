"""Contact of a pair under one reading of what the paper leaves open; like all contact, free of humidity."""

from stiction.config.cases import merged
from stiction.run.logs import logged
from stiction.stages import cases, data, pairs


def main(identifications, output, settings, pair):
    """Change the settings, but draw the surfaces of the base, also where a reading does so on another grid."""
    identified = {
        name: cases.target_spectrum(data.load(path, "identification"))
        for name, path in zip(settings["identified"], identifications, strict=True)
    }
    surfaces = cases.surfaces_of(settings["base"], pair, identified)
    changed = merged(settings["base"], settings["changes"])
    data.save(pairs.contact(surfaces, pair, "NG", changed), output, "contact", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output[0], snakemake.params.settings, snakemake.wildcards.pair)
