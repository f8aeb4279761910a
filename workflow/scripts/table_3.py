"""Table III: crack lengths and adhesion energies."""

from stiction.report import published
from stiction.report.tables import save
from stiction.report.tables_beams import table_3
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Average over the beams of every case and compare with published and measured lengths."""
    beams = load_named(job.input.beams, "beams", key_of)
    forces = load_named(job.input.forces, "forces", key_of)
    known = published.of_paper(published.read(job.input.published), job.params.settings["of_paper"])
    save(table_3(beams, forces, known), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
