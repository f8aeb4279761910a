"""Sec. II-C: the spectrum whose surfaces have the measured summits."""

from stiction import cases, data
from stiction.identify import SummitTarget, identify
from stiction.logs import logged
from stiction.streams import stream
from stiction.surfaces import StripGrid
from stiction.translation import Translation
from stiction.units import si


def main(heights, output, settings):
    """Fit Eq. (7) to radius and density of the summits."""
    heights = data.load(heights, "heights")
    wanted, patch = si(settings["target"]), si(settings["identification"])
    spacing = si({"spacing_nm": settings["spacing_nm"], "target_spacing_nm": settings["target_spacing_nm"]})
    target = SummitTarget(
        float(heights.rms), wanted["mean_summit_radius"], wanted["summit_density"], spacing["target_spacing"]
    )
    grid = StripGrid(patch["patch"], patch["patch"], spacing["spacing"], margin=0.0)

    def patches(*address):
        return lambda: (stream(settings["seed"], "identification", *address, k) for k in range(patch["patches"]))

    found = identify(target, Translation(cases.density(heights, "NG")), grid, patches(), patches("control"))
    data.save(data.identification(found, target), output, "identification", settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        main(snakemake.input.heights, snakemake.output[0], snakemake.params.settings)
