"""Which input of a device moves its length, or the pull-off force of a stopper, by how much."""

from stiction.config.units import typed
from stiction.designs import budget
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import load_named


def main(job):
    """Compare contacts with less and with more of every input, and those under other choices of the model."""
    plain = job.params.settings
    settings = typed(budget.Settings, plain["budget"])
    less, more, modulus, choices = (
        storage.load_all(paths, "contact")
        for paths in (job.input.less, job.input.more, job.input.modulus, job.input.choices)
    )
    names = [tuple(entry) for entry in plain["quantities"]]
    surfaces = dict.fromkeys(surface for surface, _ in names)
    described = zip(*(storage.load_all(job.input[stage], stage) for stage in ("heights", "spectrum")), strict=True)
    estimates = load_named(job.input.estimates, "estimate")
    known = budget.covariances(dict(zip(surfaces, described, strict=True)), estimates, settings)
    dataset = budget.compute(
        storage.load(job.input.contact, "contact"),
        dict(zip(names, zip(less, more, strict=True), strict=True)),
        tuple(modulus) or None,
        dict(zip(plain["choices"], choices, strict=True)),
        known,
        settings,
    )
    storage.save(dataset, job.output[0], "budget", plain, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake)
