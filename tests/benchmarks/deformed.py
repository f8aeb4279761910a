"""Attraction across the gaps of deformed surfaces, and of undeformed ones as in the package: ``make deformed``.

The package takes the attraction across gaps from the bearing area of the undeformed surfaces. Here it acts in full
elastic contact, where it deforms them as water and the attraction of touching solids do: by how much does it raise the
adhesion energy of a strip, in either model of the contact?
"""

import argparse
from dataclasses import dataclass

import numpy as np

from stiction.config.cases import air
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact import elements, forcelaw, gaps
from stiction.contact.environment import Water
from stiction.contact.pair import bearing_area
from stiction.devices.materials import ELASTIC
from stiction.estimates import mean_with_error
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.plan.stage import select
from stiction.report.format import TO_MJ, with_error
from stiction.stages.contact import full_contact
from stiction.stages.surfaces.rough_surfaces import both, surface_inputs

#: Gaps of the tables of the work [m], up to where it is below 1e-5 of that of touching flats.
GAPS = np.arange(0, 300e-9, 0.02e-9)
#: Width of the strips [µm], a third of that of the beam.
WIDTH = 10.0


@dataclass(frozen=True)
class AcrossGaps(elements.Adhesion):
    """Attraction of touching summits and water, and across gaps: of the latter, the work beyond that of the summits."""

    work: np.ndarray = None  #: at `GAPS` [J m⁻²]
    pull: np.ndarray = None  #: its negative derivative [Pa]

    def traction(self, gap):
        """Attraction q at gaps [Pa]."""
        return super().traction(gap) + np.interp(gap, GAPS, self.pull).astype(np.float32)

    def energy(self, gap):
        """Energy w per area at gaps >= 0, negative [J m⁻²]."""
        return super().energy(gap) - np.interp(gap, GAPS, self.work)


def across_gaps(adhesion, water):
    """Adhesion with the work across gaps as well [J m⁻²].

    Within the range of the summits' stress this work, which vanishes where solids touch, is linear: the stress is
    weaker there by what the gaps beyond have, and flats that touch need the work of Eq. (10) in all.
    """
    work, end = water.gaps.work(GAPS, adhesion.height), adhesion.reach + adhesion.ramp / 2
    work = np.where(end > GAPS, GAPS / end * np.interp(end, GAPS, work), work)
    return AcrossGaps(**vars(adhesion), work=work, pull=-np.gradient(work, GAPS))


def undeformed(heights, distance, force, work):
    """Forces of the sum over summits with the attraction across undeformed gaps [Pa], and the energy beyond [J m⁻²]."""
    step = distance[1] - distance[0]
    below, above = (int(np.ceil(end / step)) + 1 for end in (-heights.min(), heights.max()))
    area = bearing_area(heights, step, below, above + 1)[None]
    pressure, beyond = gaps.gap_pressures(area, -below * step, distance, step, lambda gap: np.interp(gap, GAPS, work))
    return force + pressure[0], beyond[0]


def energies(space, heights, adhesion, curve, water):
    """e of one strip: sum over summits, touching and across all gaps; full contact, touching and all gaps [J m⁻²]."""
    across, (distance, force) = across_gaps(adhesion, water), curve
    more, beyond = undeformed(heights, distance, force, across.work)
    found = [forcelaw.adhesion_energy(distance, force), forcelaw.adhesion_energy(distance, more, beyond)]
    for each, of_summits in ((adhesion, force), (across, more)):
        state, _ = elements.at_rest(space, heights, each, (distance, of_summits))
        found.append(-state.energy(heights, each))
    return found


def row(pair, humidity, strips):
    """One row of the table: pair, air, energies without attraction across gaps, and what it adds, in both models."""
    medium = {"van_der_waals": "water" if humidity else "dry", "attraction": {"reach": "all"}}
    config = load(medium | {"beam": {"width_um": WIDTH}})
    plan, results = Plan(config), Results.of(config)
    data = {stage: [results[name] for name in names] for stage, names in surface_inputs(plan, pair).items()}
    water = plan.air.water(pair)
    seen = plan.seen_by(pair, (*ELASTIC, "hardness_GPa"), samples=None)
    others = {"water": {key: value for key, value in water.items() if key != "gaps"}}
    section = seen | others | {"humidities": [humidity], "strips": strips}
    settings = in_si(full_contact.Settings, select(full_contact.Settings, section))
    drawn = full_contact.strips(both(data), pair, settings)
    found = np.array([energies(*strip, *case, in_si(Water, water)) for *strip, (case,) in drawn])
    undeformed, deformed = found[:, 1] - found[:, 0], found[:, 3] - found[:, 2]
    ratio = deformed.mean() / undeformed.mean()
    error = mean_with_error(deformed - ratio * undeformed)[1] / undeformed.mean()
    columns = (found[:, 0], undeformed, found[:, 2], deformed)
    return [
        pair,
        air(humidity),
        *(with_error(*(TO_MJ * np.array(mean_with_error(one)))) for one in columns),
        with_error(ratio, error),
    ]


#: Pair and humidity (0 in dry air).
CASES = (("a", 0.45), ("c", 0.6))
HEADER = ("pair", "air", "summits [mJ/m²]", "+ gaps", "full contact [mJ/m²]", "+ gaps", "+ gaps, full / summits")


def main():
    """Print the table as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strips", type=int, default=6)
    strips = parser.parse_args().strips
    print(f"| {' | '.join(HEADER)} |\n|{'---|' * len(HEADER)}", flush=True)  # noqa: T201
    for case in CASES:
        print(f"| {' | '.join(row(*case, strips))} |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
