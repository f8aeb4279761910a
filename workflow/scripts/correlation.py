"""App. C, Fig. 19c: autocorrelation of the surfaces."""

import numpy as np

from stiction.run.logs import logged
from stiction.stages import cases, data, data_studies
from stiction.surface.spectrum import autocovariance, correlation_length

#: Distances drawn [m].
LAG = np.linspace(0, 1e-6, 401)


def main(spectra, output, settings):
    """Transform the spectra, Eq. (7)."""
    targets = [cases.target_spectrum(data.load(path, "spectrum")) for path in spectra]
    covariances = [autocovariance(target, LAG) for target in targets]
    lengths = [correlation_length(target) for target in targets]
    dataset = data_studies.correlation(settings["surfaces"], LAG, [c / c[0] for c in covariances], lengths)
    data.save(dataset, output, "correlation", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output[0], snakemake.params.settings)
