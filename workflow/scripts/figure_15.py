"""Figure 15: adhesion energies over the humidity."""

from stiction.report.figures_beams import adhesion_energies
from stiction.report.style import save
from stiction.report.tables import published
from stiction.run.logs import logged
from stiction.stages import data
from stiction.stages.cantilevers import cantilever


def by_pair(keys, paths, stage):
    """Datasets by pair and by what is left of their keys."""
    found = {}
    for (pair, *key), path in zip(keys, paths, strict=True):
        found.setdefault(pair, {})[tuple(key) if len(key) > 1 else key[0]] = data.load(path, stage)
    return found


def main(paths, outputs, settings):
    """Draw the energies of all pairs beside print and experiment."""
    released = by_pair(settings["cases"], paths.beams, "beams")
    bands = by_pair(settings["bands"], paths.humidity, "humidity")
    pairs = {pair: (cantilever(settings, pair), released[pair], bands[pair]) for pair in settings["pairs"]}
    save(adhesion_energies(pairs, published(paths.printed)), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
