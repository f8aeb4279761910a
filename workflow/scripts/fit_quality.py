"""Table of the fit by Eq. (12) over all cases."""

from stiction.report import tables
from stiction.report.tables_fit import fit_quality, markdown_fit
from stiction.run.logs import logged
from stiction.stages import data


def main(fits, output, settings):
    """Collect the errors of all cases."""
    keys = map(tuple, settings["keys"])
    table = fit_quality({key: data.load(path, "fit") for key, path in zip(keys, fits, strict=True)})
    tables.save(table, markdown_fit(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
