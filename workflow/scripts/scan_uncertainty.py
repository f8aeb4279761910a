"""Uncertainty of the adhesion energy of a pair due to finite scans of measured surfaces."""

from stiction.config.units import typed
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import after_pair, load_named
from stiction.studies import scan_uncertainty


def main(job):
    """Multiply the slopes by the errors of the estimates, and compare the choices with the base."""
    slopes = load_named(job.input.slopes, "slopes", after_pair)
    estimates = load_named(job.input.estimates, "estimate")
    choices = load_named(job.input.choices, "contact", after_pair)
    samples = max(choice.sizes["sample"] for choice in choices.values())
    base = storage.load(job.input.base, "contact", sample=slice(samples))
    errors = scan_uncertainty.errors_by_surface(slopes, estimates)
    dataset = scan_uncertainty.compute(
        slopes, errors, base, choices, typed(scan_uncertainty.Settings, job.params.settings)
    )
    storage.save(dataset, job.output[0], "scan_uncertainty", job.params.settings, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
