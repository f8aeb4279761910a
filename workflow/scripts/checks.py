"""Check the results; succeeds even if checks fail, so that the report remains."""

from itertools import chain

from stiction.config.units import typed
from stiction.report import checks
from stiction.run import atomic
from stiction.run.logs import logged
from stiction.stages.cantilevers import Cantilevers, StripLength, cantilever
from stiction.stages.named import key_of, load_named, surface_and_model
from stiction.stages.spectrum import defect


def main(job):
    """Write all checks, whether passed or failed."""
    settings, targets = job.params.settings, job.params.settings["targets"]
    sections = typed(Cantilevers, {name: settings[name] for name in ("solid", "beam", "pairs")})
    beams = {pair: cantilever(sections, pair) for pair in settings["pairs"]}
    strip = typed(StripLength, settings["sampling"]).strip_length
    heights = load_named(job.input.heights, "heights")
    spectra = load_named(job.input.spectrum, "spectrum")
    identified = load_named(job.input.identification, "identification")
    characters = load_named(job.input.character, "character", surface_and_model)
    forces, chaoses, outcomes = (load_named(job.input[stage], stage, key_of) for stage in ("forces", "chaos", "beams"))
    resampled = load_named(job.input.resampling, "resampling", key_of)
    found = chain(
        checks.of_surfaces(heights, characters, targets, {name: defect(found) for name, found in spectra.items()}),
        checks.of_identifications(identified),
        checks.of_force_laws(forces, chaoses),
        checks.of_trends(forces, settings["skewed"]),
        checks.of_beams(outcomes, forces, beams, strip, settings["on_mesh_of_paper"]),
        checks.of_resampling(outcomes, {(*case, "NG"): found for case, found in resampled.items()}),
    )
    table = checks.table(found)
    atomic.save_text(table.to_csv(index=False), job.output.csv)
    atomic.save_text(checks.markdown(table), job.output.markdown)


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
