"""Crack lengths of a pair under one reading of what the paper leaves open, from its contact."""

from stiction.run.logs import logged
from stiction.stages import data, data_studies
from stiction.study import PairStudy


def main(contact, output, settings, pair):
    """Run the stages behind the contact in process, at all humidities."""
    study = PairStudy(pair, data.load(contact, "contact"), settings)
    humidities = settings["pairs"][pair]["humidities"]
    energies = [study.energies(humidity) for humidity in humidities]
    beams = [study.beams(humidity) for humidity in humidities]
    data.save(data_studies.reading(humidities, energies, beams), output, "reading", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0], snakemake.params.settings, snakemake.wildcards.pair)
