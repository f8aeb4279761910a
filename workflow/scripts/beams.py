"""Sec. III-C and IV: press beams down, let them go and see where their cracks stop."""

from functools import partial

from stiction import chaos, data, laws
from stiction.beam import Beam
from stiction.logs import logged, progress
from stiction.montecarlo import Experiment, columns, simulate
from stiction.streams import stream
from stiction.units import si

#: Number of shapes kept for drawing (Fig. 14).
KEPT = 100


def main(model, output, settings, case, scattered, threads):
    """Release all beams of a case; models NG and GEO share their force laws."""
    entry = si(settings["beam"])
    gap, young_modulus = si({"gap_um": settings["gap_um"]}), si({"young_modulus_GPa": settings["young_modulus_GPa"]})
    beam = Beam(**{key: entry[key] for key in ("length", "width", "thickness", "elements")}, **gap, **young_modulus)
    points = round(beam.length / si({"strip_length_um": settings["strip_length_um"]})["strip_length"])
    fitted = laws.chaos_model(data.load(model, "chaos"))
    experiment = Experiment(
        beam, points, lambda rng, n: chaos.draw_laws(fitted, n, rng)[0], entry["scatter"] if scattered else 0.0
    )
    address = partial(stream, settings["seed"], "beams", case)
    released = simulate(experiment, range(entry["samples"]), address, threads)
    outcomes = list(progress(released, "beams", total=entry["samples"]))
    data.save(data.beams(columns(outcomes, KEPT), beam.nodes), output, "beams", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input[0],
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.case,
            snakemake.wildcards.model == "GEO",
            snakemake.threads,
        )
