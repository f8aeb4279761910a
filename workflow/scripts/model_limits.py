"""Where the results of pairs are beyond the limits of the model."""

from stiction.designs import findings
from stiction.run.atomic import save_text
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write the warnings about all pairs."""
    beams, plasticity = load_named(job.input.beams, "beams", key_of), load_named(job.input.plasticity, "plasticity")
    settings = job.params.settings
    warnings = findings.of_pairs(beams, plasticity, settings["materials"], settings["pairs"])
    save_text(findings.as_markdown(warnings), job.output[0])


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
