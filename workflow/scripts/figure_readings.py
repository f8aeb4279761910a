"""Crack lengths of Table III under other readings of what the paper leaves open."""

from stiction.report import tables
from stiction.report.figures_studies import readings
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, outputs, settings):
    """Draw all pairs and readings."""
    keys = [tuple(key) for key in settings["keys"]]
    loaded = {key: data.load(path, "reading") for key, path in zip(keys, paths.studies, strict=True)}
    pairs, names = (dict.fromkeys(parts) for parts in zip(*keys, strict=True))
    # A reading that changes nothing of a pair was left out: there it is the base.
    whole = {(pair, name): loaded.get((pair, name), loaded[pair, "base"]) for pair in pairs for name in names}
    save(readings(whole, tables.published(paths.printed)), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
