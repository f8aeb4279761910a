"""Table I: statistics of the simulated surfaces."""

from stiction import data, tables
from stiction.logs import logged


def main(paths, csv, markdown, settings):
    """Compare simulated, printed and measured statistics."""
    keys = map(tuple, settings["keys"])
    loaded = {key: data.load(path, "character") for key, path in zip(keys, paths.characters, strict=True)}
    table = tables.table_1(loaded, settings["measured"], tables.published(paths.printed))
    data.save_text(table.to_csv(index=False), csv)
    data.save_text(tables.markdown_1(table), markdown)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output.csv, snakemake.output.markdown, snakemake.params.settings)
