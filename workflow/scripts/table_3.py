"""Table III: crack lengths and adhesion energies."""

from stiction.designs import findings
from stiction.report import published
from stiction.report.tables import save
from stiction.report.tables_beams import table_3
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named
from stiction.studies.scan_uncertainty import pair_errors


def main(job):
    """Average over the beams of every case and compare with published and measured lengths."""
    beams = load_named(job.input.beams, "beams", key_of)
    forces = load_named(job.input.forces, "forces", key_of)
    known = published.of_paper(published.read(job.input.published), job.params.settings["of_paper"])
    scanned = load_named(job.input.by_scans, "scan_uncertainty")
    by_scans = {(pair, humidity): e for pair, found in scanned.items() for humidity, e in pair_errors(found).items()}
    warnings = findings.of_thin_films(beams, job.params.settings["water"])
    save(table_3(beams, forces, known, by_scans, warnings), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
