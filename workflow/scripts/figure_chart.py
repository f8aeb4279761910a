"""Safe length of beams of several thicknesses over the relative humidity."""

from stiction.designs import findings
from stiction.designs.figures_devices import chart
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Draw one panel for each device and gap, with its warnings below."""
    found, plasticity = load_named(job.input.charts, "chart", key_of), load_named(job.input.plasticity, "plasticity")
    warnings = findings.of_charts(found, plasticity, job.params.settings["devices"])
    save(chart(found, warnings), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
