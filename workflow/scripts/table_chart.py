"""Safe lengths along the axes of all charts with their warnings."""

from stiction.designs import findings
from stiction.designs.tables_devices import chart
from stiction.report.tables import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write one row per device, thickness, gap, shape, humidity and share."""
    found, plasticity = load_named(job.input.charts, "chart", key_of), load_named(job.input.plasticity, "plasticity")
    warnings = findings.of_charts(found, plasticity, job.params.settings["devices"])
    save(chart(found, warnings), job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
