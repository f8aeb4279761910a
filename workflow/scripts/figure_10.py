"""Figure 10: spectra of simulated surfaces."""

from stiction.report.figures_surfaces import spectra
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data

STAGES = ("heights", "spectrum", "character", "iteration")


def main(paths, outputs, settings):
    """Draw the spectra of all surfaces; paths by stage."""
    columns = [[data.load(path, stage) for path in paths[stage]] for stage in STAGES]
    save(spectra(dict(zip(settings["surfaces"], zip(*columns, strict=True), strict=True))), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
