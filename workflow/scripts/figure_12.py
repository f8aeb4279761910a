"""Figure 12: computed and generated force curves."""

from stiction.chaos import model as chaos
from stiction.report.figures_forces import force_curves
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages import data, laws
from stiction.streams import stream


def main(paths, outputs, settings):
    """Generate as many laws of every pair as curves were kept, and draw all."""
    drawn = {}
    for k, (pair, case) in enumerate(settings["cases"].items()):
        gaussian, other = (data.load(files[k], "forces") for files in (paths.gaussian, paths.other))
        model = laws.chaos_model(data.load(paths.chaos[k], "chaos"))
        rng = stream(settings["seed"], "figure 12", case)
        drawn[pair] = gaussian, other, chaos.draw_laws(model, other.sizes["curve"], rng)[0]
    save(force_curves(drawn), *outputs)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output, snakemake.params.settings)
