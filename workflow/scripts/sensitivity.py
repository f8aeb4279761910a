"""Fig. 13: adhesion energy of a pair whose beam surface has a little less and a little more of one moment."""

import numpy as np

from stiction import cases, data, data_studies, sensitivity
from stiction.logs import logged
from stiction.study import MOMENTS, PairStudy, surface
from stiction.units import si


def main(heights, spectra, output, settings, pair, moment):
    """Compare the same samples, in the sense of their random numbers, at the two values of the moment."""
    beam, substrate = [
        (data.load(h, "heights"), data.load(s, "spectrum")) for h, s in zip(heights, spectra, strict=True)
    ]
    moments = {name: float(beam[0][name]) for name in MOMENTS}
    target, spacing = cases.target_spectrum(beam[1]), si(settings["sampling"])["spacing"]
    at = sensitivity.shifted(moments[moment], settings["step"])
    shapes = [surface(moments | {moment: value}, target, spacing) for value in at]
    studies = [PairStudy(pair, (shape, substrate), settings) for shape in shapes]
    energies = np.array([[study.forces(h)[0][:, 0] for h in settings["humidities"]] for study in studies])
    estimate = sensitivity.energy_sensitivity(energies.swapaxes(1, 2), at)
    data.save(data_studies.sensitivity(energies, at, estimate, settings["humidities"]), output, "sensitivity", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.spectrum,
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.pair,
            snakemake.wildcards.moment,
        )
