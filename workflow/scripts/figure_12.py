"""Figure 12: computed and generated force curves."""

from stiction.report.figures_forces import force_curves
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.chaos import generated_laws
from stiction.stages.named import load_named


def main(job):
    """Generate as many force laws of every pair as curves were kept, and draw all."""
    gaussian, other = (load_named(paths, "forces") for paths in (job.input.gaussian, job.input.other))
    models, seed, drawn = load_named(job.input.chaos, "chaos"), job.params.settings["seed"], {}
    for pair, case in job.params.settings["cases"].items():
        computed = gaussian[f"{case}_G"], other[f"{case}_NG"]
        drawn[pair] = *computed, generated_laws(models[f"{case}_NG"], computed[1].sizes["curve"], case, seed)
    save(force_curves(drawn), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
