"""Table of the fit by Eq. (12) over all cases."""

from stiction import data
from stiction.logs import logged
from stiction.tables_fit import fit_quality, markdown_fit


def main(fits, csv, markdown, settings):
    """Collect the errors of all cases."""
    keys = map(tuple, settings["keys"])
    table = fit_quality({key: data.load(path, "fit") for key, path in zip(keys, fits, strict=True)})
    data.save_text(table.to_csv(index=False), csv)
    data.save_text(markdown_fit(table), markdown)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output.csv, snakemake.output.markdown, snakemake.params.settings)
