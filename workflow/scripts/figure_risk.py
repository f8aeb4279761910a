"""Share of stuck beams over their length."""

from stiction.designs import findings
from stiction.designs.figures_devices import risk
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Draw one panel for each device, with its warnings below."""
    found = load_named(job.input.lengths, "safe_lengths", key_of)
    plasticity = load_named(job.input.plasticity, "plasticity")
    warnings = findings.of_devices(found, plasticity, job.params.settings["devices"])
    save(risk(found, warnings), *job.output)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
