"""App. B: release beams on force laws of the samples themselves, as a reference for the chaos model."""

from functools import partial

from stiction.beam.montecarlo import Experiment, columns, simulate
from stiction.chaos import model as chaos
from stiction.config.cases import pair_of
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.stages.cantilevers import cantilever, points
from stiction.streams import stream


def main(forces, output, settings, case):
    """Draw the laws of every beam from the samples, with replacement."""
    forces = data.load(forces, "forces")
    vectors, limit = data.vectors(forces), float(forces.limit)
    beam, number = cantilever(settings, pair_of(case)), settings["beams"]
    experiment = Experiment(beam, points(settings), lambda rng, n: chaos.resample_laws(vectors, limit, n, rng))
    released = simulate(experiment, range(number), partial(stream, settings["seed"], "resampling", case))
    outcomes = list(progress(released, "beams", total=number))
    data.save(data_studies.resampling(columns(outcomes)), output, "resampling", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0], snakemake.params.settings, snakemake.wildcards.case)
