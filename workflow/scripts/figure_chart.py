"""Safe length of beams of several thicknesses over the relative humidity."""

from stiction.designs.figures_devices import chart
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Draw one panel for each device and gap."""
    save(chart(load_named(job.input.charts, "chart", key_of)), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
