"""Which input of a device moves its length, or the pull-off force of a stopper, by how much."""

from stiction.config.units import typed
from stiction.designs import budget, inputs
from stiction.devices.budget import OF_SOLIDS
from stiction.run.logs import logged
from stiction.stages import storage
from stiction.stages.named import after_patch, load_named, side_of, surface_and_quantity


def main(job):
    """Compare contacts with less and with more of every input, and those under other choices of the model."""
    plain = job.params.settings
    settings = typed(inputs.Settings, plain["budget"])
    less, more = (load_named(paths, "contact", surface_and_quantity) for paths in (job.input.less, job.input.more))
    solids = {name: load_named(getattr(job.input, name), "contact", side_of) for name in OF_SOLIDS}
    heights, spectra, estimates = (
        load_named(paths, stage)
        for paths, stage in (
            (job.input.heights, "heights"),
            (job.input.spectrum, "spectrum"),
            (job.input.estimates, "estimate"),
        )
    )
    choices = load_named(job.input.choices, "contact", after_patch)
    described = {name: (heights[name], spectra[name]) for name, _ in plain["quantities"]}
    dataset = budget.compute(
        storage.load(job.input.contact, "contact"),
        {key: (less[key], more[key]) for key in less},
        {name: (both["less"], both["more"]) for name, both in solids.items() if both},
        {name: choices[name] for name in plain["choices"]},
        inputs.covariances(described, estimates, settings),
        settings,
    )
    storage.save(dataset, job.output[0], "budget", plain, job.input)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
