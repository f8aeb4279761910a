"""Crack lengths of a pair under one reading of what the paper leaves open."""

from dataclasses import replace

from stiction import cases, data, data_studies
from stiction.logs import logged
from stiction.settings import merged
from stiction.study import PairStudy


def main(identifications, output, settings, pair):
    """Run all stages in process. Surfaces are those of the base, also where a reading draws them on another grid."""
    names = settings["identified"]
    identified = {
        n: cases.target_spectrum(data.load(path, "identification"))
        for n, path in zip(names, identifications, strict=True)
    }
    base = PairStudy.of(settings["base"], pair, identified=identified)
    study = replace(base, settings=merged(base.settings, settings["changes"]))
    humidities = settings["base"]["pairs"][pair]["humidities"]
    energies = [study.forces(humidity)[0][:, 0] for humidity in humidities]
    beams = [study.beams(humidity) for humidity in humidities]
    data.save(data_studies.reading(humidities, energies, beams), output, "reading", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input, snakemake.output[0], snakemake.params.settings, snakemake.wildcards.pair)
