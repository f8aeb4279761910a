"""Safe lengths of all beams with their errors and warnings."""

from stiction.designs import findings
from stiction.designs.tables_devices import safe_lengths
from stiction.report.tables import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write one row per device, humidity, shape and share."""
    found = load_named(job.input.lengths, "safe_lengths", key_of)
    plasticity = load_named(job.input.plasticity, "plasticity")
    warnings = findings.of_devices(found, plasticity, job.params.settings["devices"])
    save(safe_lengths(found, warnings), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
