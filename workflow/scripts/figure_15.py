"""Figure 15: adhesion energies over the relative humidity."""

from stiction.config.units import typed
from stiction.contact.meniscus import flooded_energy
from stiction.report import published
from stiction.report.figures_beams import adhesion_energies
from stiction.report.style import save
from stiction.run.logs import logged
from stiction.stages.cantilevers import Cantilevers, cantilever
from stiction.stages.curves import Water
from stiction.stages.named import key_of, load_named, surface_and_model


def main(job):
    """Draw the energies of all pairs with the published and measured ones."""
    settings = job.params.settings
    beams = load_named(job.input.beams, "beams", key_of)
    bands = load_named(job.input.humidity, "humidity", surface_and_model)
    sections = typed(Cantilevers, {name: settings[name] for name in ("solid", "beam", "pairs")})
    pairs = {pair: (cantilever(sections, pair), *_of(pair, beams, bands)) for pair in settings["pairs"]}
    known = published.of_paper(published.read(job.input.published), settings["of_paper"])
    waters = {pair: typed(Water, settings["water"][pair]) for pair in pairs}
    flat = {pair: flooded_energy(water.temperature, water.contact_angles) for pair, water in waters.items()}
    save(adhesion_energies(pairs, known, flat), *job.output)


def _of(pair, beams, bands):
    """Beams of one pair by humidity and model, and its humidity bands by model."""
    released = {(humidity, model): found for (name, humidity, model), found in beams.items() if name == pair}
    return released, {model: band for (name, model), band in bands.items() if name == pair}


if __name__ == "__main__":
    with logged(snakemake.log[0], snakemake.output):
        main(snakemake)
