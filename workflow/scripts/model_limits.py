"""Where the results of pairs and devices are beyond the limits of the model."""

from stiction.designs import findings
from stiction.run.atomic import save_text
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write all warnings of a run."""
    settings, plasticity = job.params.settings, load_named(job.input.plasticity, "plasticity")
    beams, found = load_named(job.input.beams, "beams", key_of), load_named(job.input.lengths, "safe_lengths", key_of)
    pairs = findings.of_pairs(beams, plasticity, settings["pairs"])
    devices = findings.of_devices(found, plasticity, settings["devices"])
    stoppers = findings.of_stoppers(plasticity, settings["stoppers"])
    save_text(findings.as_markdown(pairs | stoppers, devices), job.output[0])


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
