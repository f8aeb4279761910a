"""Table III under other readings of what the paper leaves open."""

from stiction.report import tables, tables_studies
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, output, settings):
    """Compare every reading with the base, with the print and with the experiment."""
    keys = map(tuple, settings["keys"])
    loaded = {key: data.load(path, "reading") for key, path in zip(keys, paths.studies, strict=True)}
    table = tables_studies.readings(loaded, tables.published(paths.printed))
    tables.save(table, tables_studies.markdown_readings(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
