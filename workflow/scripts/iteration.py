"""Sec. II-B2, Fig. 4: the iterative algorithm, to compare with the closed form."""

from itertools import islice

import numpy as np

from stiction.config.units import si
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import cases, data, data_studies
from stiction.streams import stream
from stiction.surface.field import StripGrid
from stiction.surface.iteration import iterate, misfit, sampling_misfit, target_rings
from stiction.surface.translation import Translation

#: Side of the periodic fields [m].
FIELD = 10.24e-6


def main(heights, spectrum, output, settings, name):
    """Iterate as often as the settings say and keep all spectra."""
    spectrum, wanted = data.load(spectrum, "spectrum"), settings["iteration"]
    target = cases.target_spectrum(spectrum)
    translation = Translation(cases.density(data.load(heights, "heights"), "NG"))
    grid = StripGrid(FIELD, FIELD, si({"spacing_nm": settings["spacing_nm"]})["spacing"], margin=0.0)
    steps = iterate(target, translation, grid, wanted["fields"], stream(settings["seed"], "iteration", name))
    kept = list(progress(islice(steps, wanted["iterations"]), "iterations", total=wanted["iterations"]))
    underlying, periodograms = (np.array(column) for column in zip(*kept, strict=True))
    zeta, rings = target_rings(target, grid)
    misfits = {
        "misfit": misfit(periodograms.mean(axis=1), rings),
        "sampling_misfit": sampling_misfit(periodograms),
        "closed_form_misfit": misfit(np.interp(zeta, spectrum.wavenumber, spectrum.achieved), rings),
    }
    dataset = data_studies.iteration((zeta, rings), (underlying, periodograms), misfits)
    data.save(dataset, output, "iteration", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.spectrum,
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.surface,
        )
