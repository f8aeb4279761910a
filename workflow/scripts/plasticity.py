"""App. A, Fig. 16: stress of every summit of a pair that touches at a small distance."""

import numpy as np

from stiction.config.units import si
from stiction.contact.asperity import hertz_maximum_stress, reduced_modulus
from stiction.progress import progress
from stiction.run.logs import logged
from stiction.stages import data, data_studies, pairs
from stiction.studies import plasticity
from stiction.surface.summits import find_summits


def main(heights, spectra, output, settings, pair):
    """Find the touching summits of all strips and the share of their area that yields."""
    surfaces = [(data.load(h, "heights"), data.load(s, "spectrum")) for h, s in zip(heights, spectra, strict=True)]
    meeting = pairs.surface_pair(surfaces, "NG", settings)
    streams = pairs.streams_of_sides(settings["seed"], pair)
    distance, found = si({"distance_nm": settings["distance_nm"]})["distance"], []
    for k in progress(range(settings["strips"]), "strips"):
        height, curvature, _ = find_summits(meeting.draw(*streams(k)), meeting.beam.grid.spacing * meeting.every)
        interference, radius = plasticity.touching(height, curvature, distance)
        found.append((interference, radius, np.full(len(radius), k)))
    interference, radius, strip = np.hstack(found)
    summits = {"interference": interference, "radius": radius, "strip": strip.astype(int)}
    summits["stress"] = hertz_maximum_stress(interference, radius, reduced_modulus(**si(settings["solid"])))
    area = plasticity.contact_area(interference, radius)
    share = plasticity.plastic_share(area, summits["stress"], summits["strip"], settings["strips"])
    data.save(data_studies.plasticity(summits, share, distance), output, "plasticity", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(
            snakemake.input.heights,
            snakemake.input.spectrum,
            snakemake.output[0],
            snakemake.params.settings,
            snakemake.wildcards.pair,
        )
