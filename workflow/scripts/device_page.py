"""Page of one device for the report."""

from stiction.designs import findings, pages
from stiction.run.atomic import save_text
from stiction.run.logs import logged
from stiction.stages.named import key_of, load_named


def main(job):
    """Write the answer, tables, figures and warnings of a device."""
    settings = job.params.settings
    name, section = settings["name"], settings["device"]
    plasticity = load_named(job.input.plasticity, "plasticity")
    budgets = {tuple(key): dataset for (_, *key), dataset in load_named(job.input.budgets, "budget", key_of).items()}
    if section["kind"] == "stopper":
        (found,) = load_named(job.input.stoppers, "stoppers").values()
        warnings = findings.of_stoppers(plasticity, settings["warned"])[name]
        page = pages.of_stopper(name, section, found, budgets, warnings)
    else:
        found, charts = _by_humidity(job.input.safe_lengths, "safe_lengths"), _by_humidity(job.input.charts, "chart")
        cases = {(name, humidity): dataset for humidity, dataset in found.items()}
        warnings = findings.of_devices(cases, plasticity, settings["warned"])
        axis = {(name, humidity): dataset for humidity, dataset in charts.items()}
        warnings |= findings.of_charts(axis, plasticity, settings["warned"])
        page = pages.of_beam(name, section, found, charts, budgets, warnings)
    save_text(page.html, job.output[0])


def _by_humidity(paths, stage):
    """Datasets of a stage by humidity."""
    return {humidity: dataset for (_, humidity), dataset in load_named(paths, stage, key_of).items()}


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
