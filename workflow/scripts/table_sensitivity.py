"""Figure 13 in numbers."""

from stiction.report import tables, tables_studies
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, output, settings):
    """Put the sensitivities beside those that the paper states."""
    loaded = {
        moment: data.load(path, "sensitivity") for moment, path in zip(settings["moments"], paths.studies, strict=True)
    }
    table = tables_studies.sensitivity(loaded, settings["pair"], tables.published(paths.printed))
    tables.save(table, tables_studies.markdown_sensitivity(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
