"""Table I: statistics of the simulated surfaces."""

from stiction.report import tables
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, output, settings):
    """Compare simulated, printed and measured statistics."""
    keys = map(tuple, settings["keys"])
    loaded = {key: data.load(path, "character") for key, path in zip(keys, paths.characters, strict=True)}
    table = tables.table_1(loaded, settings["measured"], tables.published(paths.printed))
    tables.save(table, tables.markdown_1(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
