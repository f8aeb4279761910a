"""App. B: the chaos model of the force law, and its statistics beside those of its input."""

from stiction.chaos import model as chaos
from stiction.run.logs import logged
from stiction.stages import data
from stiction.streams import stream

#: Draws on which the model is compared with its input.
DRAWS = 100_000


def main(forces, output, settings, case, model):
    """Fit the polynomials and draw from them."""
    forces = data.load(forces, "forces")
    vectors, wanted = data.vectors(forces), settings["chaos"]
    fitted = chaos.fit(vectors, float(forces.limit), wanted["order"], wanted["dimension_tolerance"])
    report = chaos.fit_report(fitted, vectors, DRAWS, stream(settings["seed"], "chaos", case, model))
    _, rejected = chaos.draw(fitted, DRAWS, stream(settings["seed"], "rejection", case, model))
    data.save(data.chaos(fitted, report, rejected / (rejected + DRAWS)), output, "chaos", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input[0],
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.case,
            snakemake.wildcards.model,
        )
