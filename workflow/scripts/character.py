"""Table I: statistics of simulated surfaces, sampled as coarsely as the microscope did."""

import numpy as np

from stiction.config.units import si
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import cases, data
from stiction.streams import stream
from stiction.surface.field import StripGrid, radial_periodogram
from stiction.surface.summits import find_summits

#: Side of the periodic fields for the spectrum and of the patch for pictures [m], and their number.
FIELD, FIELDS = 10.24e-6, 8
#: Summits kept for the joint density of height and radius.
KEPT = 20_000


def main(heights, spectrum, output, settings, name, model):
    """Draw strips, keep their moments and summits; draw periodic fields, keep their spectra."""
    datasets = data.load(heights, "heights"), data.load(spectrum, "spectrum")
    character, seed = si(settings["character"]), settings["seed"]
    grid = cases.strip_grid(settings["sampling"], si(settings["beam"])["width"])
    surface = cases.rough_surface(*datasets, model, grid)
    every = round(character["spacing"] / grid.spacing)
    strips, summits = {"power": [], "summit_density": [], "mean_curvature": []}, []
    for k in progress(range(character["strips"]), "strips"):
        z = surface.draw(stream(seed, "character", name, k))[::every, ::every]
        height, curvature, density = find_summits(z, character["spacing"])
        strips["power"].append([np.mean(z.astype(float) ** order) for order in (1, 2, 3, 4)])
        strips["summit_density"].append(density)
        strips["mean_curvature"].append(curvature.mean())
        summits.append((height, curvature))
    field = cases.rough_surface(*datasets, model, StripGrid(FIELD, FIELD, grid.spacing, margin=0.0))
    drawn = [field.draw(stream(seed, "character", name, "field", k)) for k in range(FIELDS)]
    spectra = [radial_periodogram(z, grid.spacing) for z in drawn]
    dataset = data.character(
        strips,
        (spectra[0][0], [periodogram for _, periodogram in spectra]),
        np.hstack(summits)[:, :KEPT],
        (grid.spacing, drawn[0][:300, :300]),
    )
    data.save(dataset, output, "character", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.spectrum,
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.surface,
            snakemake.wildcards.model,
        )
