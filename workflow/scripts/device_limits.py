"""Where the results of devices are beyond the limits of the model."""

from stiction.designs import findings
from stiction.run.atomic import save_text
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write the warnings about all devices."""
    settings, plasticity = job.params.settings, load_named(job.input.plasticity, "plasticity")
    found, along = load_named(job.input.lengths, "safe_lengths", key_of), load_named(job.input.charts, "chart", key_of)
    devices = findings.of_devices(found, plasticity, settings["devices"])
    charts = findings.of_charts(along, plasticity, settings["devices"])
    stoppers = findings.of_stoppers(plasticity, settings["stoppers"])
    save_text(findings.as_markdown(findings.subjects(devices, charts, stoppers)), job.output[0])


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
