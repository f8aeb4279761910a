"""Sec. II-B: the spectrum of the Gaussian field behind a non-Gaussian surface."""

from stiction.config.units import si
from stiction.run.logs import logged
from stiction.stages import cases, data
from stiction.surface.spectrum import CutoffSelfAffine


def main(heights, identification, output, settings):
    """Take Eq. (7) as published or as identified and invert the translation."""
    if settings["psd"] == "identified":
        target = cases.target_spectrum(data.load(identification, "identification"))
    else:
        target = CutoffSelfAffine(**si(settings["psd"]))
    density = cases.density(data.load(heights, "heights"), "NG")
    spacing = si({"spacing_nm": settings["spacing_nm"]})["spacing"]
    data.save(cases.spectrum(density, target, spacing), output, "spectrum", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.get("identification"),
            snakemake.output[0],
            snakemake.params.settings,
        )
