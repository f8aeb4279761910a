"""Check what was computed against what must hold; judges nothing, so that its report outlives a failure."""

from itertools import chain

from stiction.config.units import si
from stiction.report import checks
from stiction.run.logs import logged
from stiction.stages import data
from stiction.stages.cantilevers import cantilever


def main(paths, csv, markdown, settings):
    """Write all checks, passed or not."""
    names = ("laws", "cases", "surfaces", "resampled")
    laws, cases, surfaces, resampled = ([tuple(key) for key in settings[name]] for name in names)

    def loaded(stage, keys):
        return {key: data.load(path, stage) for key, path in zip(keys, paths[stage], strict=True)}

    forces, targets = loaded("forces", laws), settings["targets"]
    defects = {surface: float(spectrum.defect) for surface, spectrum in loaded("spectrum", targets).items()}
    beams = {pair: cantilever(settings, pair) for pair in settings["pairs"]}
    outcomes = loaded("beams", cases)
    found = chain(
        checks.of_surfaces(loaded("character", surfaces), targets, defects),
        checks.of_laws(forces, loaded("chaos", laws)),
        checks.of_trends(forces, settings["skewed"]),
        checks.of_beams(outcomes, forces, beams, si(settings["sampling"])["strip_length"]),
        checks.of_resampling(outcomes, loaded("resampling", resampled)),
    )
    table = checks.table(found)
    data.save_text(table.to_csv(index=False), csv)
    data.save_text(checks.markdown(table), markdown)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output.csv, snakemake.output.markdown, snakemake.params.settings)
