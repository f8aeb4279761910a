"""What the chaos model does to the crack length: laws drawn from it beside laws of the samples themselves."""

from stiction.report import tables, tables_studies
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, output, settings):
    """Compare the two for every case of model NG."""
    keys = [tuple(key) for key in settings["keys"]]
    beams = {key: data.load(path, "beams") for key, path in zip(keys, paths.beams, strict=True)}
    resampled = {key: data.load(path, "resampling") for key, path in zip(keys, paths.resampled, strict=True)}
    table = tables_studies.resampling(beams, resampled)
    tables.save(table, tables_studies.markdown_resampling(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
