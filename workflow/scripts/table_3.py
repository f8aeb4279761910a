"""Table III: crack lengths and adhesion energies."""

from stiction.report import tables
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, output, settings):
    """Average over the beams of every case and compare with print and experiment."""
    keys = [tuple(key) for key in settings["keys"]]
    beams = {key: data.load(path, "beams") for key, path in zip(keys, paths.beams, strict=True)}
    forces = {key: data.load(path, "forces") for key, path in zip(keys, paths.forces, strict=True)}
    table = tables.table_3(beams, forces, tables.published(paths.printed))
    tables.save(table, tables.markdown_3(table), output)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
