"""Figure 17: convergence in the number of samples and of coordinates."""

from stiction.report.figures_studies import sample_convergence
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data


def main(paths, outputs, settings):
    """Draw the densities of one case and Err^DR of all."""
    cases = map(tuple, settings["cases"])
    errors = {
        case: data.load(path, "chaos").dimension_error.values for case, path in zip(cases, paths.chaos, strict=True)
    }
    save(sample_convergence(data.load(paths.sizes, "sample_sizes"), errors, settings["tolerance"]), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
