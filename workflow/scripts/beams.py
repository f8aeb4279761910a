"""Sec. III-C and IV: press beams down, let them go and see where their cracks stop."""

from functools import partial

from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.chaos import model as chaos
from stiction.config.cases import pair_of
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import data, laws
from stiction.stages.cantilevers import cantilever, points
from stiction.streams import stream

#: Number of shapes kept for drawing (Fig. 14).
KEPT = 100


def main(model, output, settings, case, threads):
    """Release all beams of a case; models NG and GEO share their force laws."""
    beam, number = cantilever(settings, pair_of(case)), settings["samples"]
    fitted = laws.chaos_model(data.load(model, "chaos"))
    experiment = Experiment(
        beam, points(settings), lambda rng, n: chaos.draw_laws(fitted, n, rng)[0], settings["scatter"]
    )
    address = partial(stream, settings["seed"], "beams", case)
    released = simulate(experiment, range(number), address, threads)
    outcomes = list(progress(released, "beams", total=number))
    data.save(data.beams(columns(outcomes, KEPT), beam.nodes), output, "beams", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input[0],
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.case,
            snakemake.threads,
        )
