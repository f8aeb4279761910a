"""Attraction across the gaps of deformed surfaces, and of undeformed ones as in the package: ``make deformed``.

The force laws take the attraction across gaps from the bearing area of the undeformed surfaces. In full elastic contact
it deforms them, as water and the attraction of touching solids do: by how much does it raise the adhesion energy of a
strip, in either model of the contact? The last columns are what contact.model full does to devices.
"""

import argparse
from dataclasses import replace

import numpy as np

from stiction.beam.energy import CRACK_LENGTH_POWER
from stiction.config.files import load
from stiction.config.units import in_si
from stiction.contact import forcelaw
from stiction.contact.air import Air
from stiction.contact.full import elements
from stiction.contact.materials import ELASTIC
from stiction.estimates import mean_with_error
from stiction.plan.graph import Results
from stiction.plan.plan import Plan
from stiction.plan.stage import select
from stiction.report.format import TO_MJ, signed, with_error
from stiction.stages.contact import full_contact
from stiction.stages.surfaces.rough_surfaces import sides_of, surface_inputs

#: Width of the strips [µm], a third of that of the beam.
WIDTH = 10.0


def energies(strip, touching, across):
    """e of one strip: sum over summits, touching and across all gaps; full contact, touching and all gaps [J m⁻²]."""
    cases = touching, across
    of_summits = [forcelaw.adhesion_energy(*case.curve, case.beyond) for case in cases]
    states = [elements.at_rest(*strip, *case[:2])[0] for case in cases]
    deformed = [-state.energy(strip[1], case.adhesion) for state, case in zip(states, cases, strict=True)]
    return *of_summits, *deformed


def row(pair, humidity, strips):
    """One row of the table: pair, air, energies without attraction across gaps, and what it adds, in both models."""
    medium = {"van_der_waals": "water" if humidity else "dry", "attraction": {"reach": "all"}}
    config = load(medium | {"beam": {"width_um": WIDTH}})
    plan, results = Plan(config), Results.of(config)
    data = {stage: [results[name] for name in names] for stage, names in surface_inputs(plan, pair).items()}
    seen = plan.seen_by(pair, (*ELASTIC, "hardness_GPa"), samples=None) | {"humidities": [humidity], "strips": strips}
    across = in_si(full_contact.Settings, select(full_contact.Settings, seen))
    touching = replace(across, water=replace(across.water, gaps=None))
    drawn = [full_contact.strips(sides_of(data), pair, settings) for settings in (touching, across)]
    found = np.array([energies(strip, *one, *other) for (*strip, one), (*_, other) in zip(*drawn, strict=True)])
    summits, all_summits, full, all_full = found.T
    parts, whole = ratio(all_full - full, all_summits - summits), ratio(all_full, all_summits)
    columns = (summits, all_summits - summits, full, all_full - full)
    return [
        pair,
        Air(humidity).words,
        *(with_error(*(TO_MJ * np.array(mean_with_error(one)))) for one in columns),
        with_error(*parts),
        with_error(*whole),
        signed(*length_change(*whole)),
    ]


def ratio(first, second):
    """Ratio of two means over the same strips, and its standard error [-]."""
    found = first.mean() / second.mean()
    return found, mean_with_error(first - found * second)[1] / second.mean()


def length_change(energy, error):
    """Change of crack lengths by a ratio of energies, and its standard error [%]."""
    factor = energy**CRACK_LENGTH_POWER
    return 100 * (factor - 1), 100 * abs(CRACK_LENGTH_POWER) * factor * error / energy


#: Pair and humidity (0 in dry air).
CASES = (("a", 0), ("b", 0), ("c", 0), ("a", 0.45), ("b", 0.44), ("c", 0.6))
HEADER = ("pair", "air", "summits [mJ/m²]", "+ gaps", "full contact [mJ/m²]", "+ gaps", "+ gaps, full / summits")
HEADER += ("all, full / summits", "lengths [%]")


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
