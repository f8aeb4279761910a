"""Table II: published and identified spectra."""

from stiction.report import tables
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, output, settings):
    """Compare the parameters of Eq. (7)."""
    names = settings["surfaces"]
    found = {n: data.load(p, "identification") for n, p in zip(names, paths.identifications, strict=True)}
    spectra = {n: data.load(p, "spectrum") for n, p in zip(names, paths.spectra, strict=True)}
    table = tables.table_2(found, spectra, tables.published(paths.printed))
    tables.save(table, tables.markdown_2(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
