"""Figure 17: convergence in the number of samples and of coordinates."""

from stiction.report.figures_studies import sample_convergence
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.chaos import chaos_model
from stiction.stages.named import key_of, load_named


def main(job):
    """Draw the densities of one case and Err^DR of all cases."""
    models = load_named(job.input.chaos, "chaos", key_of)
    errors = {(pair, humidity): chaos_model(found).dimension_error for (pair, humidity, _), found in models.items()}
    sizes = storage.load(job.input.sizes, "sample_sizes")
    save(sample_convergence(sizes, errors, job.params.settings["tolerance"]), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
