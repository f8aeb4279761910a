"""Table III under other readings of what the paper leaves open."""

from stiction import data, tables, tables_studies
from stiction.logs import logged


def main(paths, csv, markdown, settings):
    """Compare every reading with the base, with the print and with the experiment."""
    keys = map(tuple, settings["keys"])
    loaded = {key: data.load(path, "reading") for key, path in zip(keys, paths.studies, strict=True)}
    table = tables_studies.readings(loaded, tables.published(paths.printed))
    data.save_text(table.to_csv(index=False), csv)
    data.save_text(tables_studies.markdown_readings(table), markdown)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output.csv, snakemake.output.markdown, snakemake.params.settings)
