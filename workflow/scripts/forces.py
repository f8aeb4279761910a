"""Sec. III-B1: force curves at one humidity and the vectors of their parameters."""

from stiction.config.units import si
from stiction.contact.forcelaw import parametrise
from stiction.run.logs import logged
from stiction.stages import data
from stiction.stages.curves import force_curves

#: Number of curves kept for drawing (Fig. 12).
KEPT = 200


def main(contact, output, settings):
    """Add the water to the solid contact of every sample and find e, f_max, d_max and d_limit."""
    contact = data.load(contact, "contact")
    distance, curve = force_curves(contact, settings["humidity"], si(settings["water"])["temperature"])
    vectors, limit = parametrise(distance, curve, contact.sizes["sample"])
    kept = [curve(k).copy() for k in range(min(KEPT, contact.sizes["sample"]))]
    data.save(data.forces(vectors, limit, distance, kept), output, "forces", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input[0], snakemake.output[0], snakemake.params.settings)
