"""Figure 13 in numbers."""

from stiction import data, tables, tables_studies
from stiction.logs import logged


def main(paths, csv, markdown, settings):
    """Put the sensitivities beside those that the paper states."""
    loaded = {
        moment: data.load(path, "sensitivity") for moment, path in zip(settings["moments"], paths.studies, strict=True)
    }
    table = tables_studies.sensitivity(loaded, settings["pair"], tables.published(paths.printed))
    data.save_text(table.to_csv(index=False), csv)
    data.save_text(tables_studies.markdown_sensitivity(table), markdown)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output.csv, snakemake.output.markdown, snakemake.params.settings)
