"""Effect of the chaos model on the crack length, compared with resampled force laws."""

from stiction.report.tables import save
from stiction.report.tables_beams import resampling
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Compare both for every case of model NG."""
    released = load_named(job.input.beams, "beams", key_of)
    beams = {(pair, humidity): found for (pair, humidity, _), found in released.items()}
    save(resampling(beams, load_named(job.input.resampled, "resampling", key_of)), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
