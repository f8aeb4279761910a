"""Limits that are computed twice, in the units of the configuration and in SI, agree: what may run is not refused.

Each law takes values at a limit, for which both numbers differ in their last digits only, and values beyond it.
"""

from decimal import Decimal
from itertools import pairwise

import numpy as np
import pytest

from stiction.config import meetings, relations, scans
from stiction.config.keys import Keys, Relations
from stiction.config.units import in_si, to_si
from stiction.contact.correction import Correction, ElasticChange
from stiction.rounding import is_at_most
from stiction.stages.surfaces.measured_spectrum import Settings, cutoff_and_clipping
from stiction.surface.field import RoughSurface, StripGrid
from stiction.surface.spectrum import CutoffSelfAffine

RNG = np.random.default_rng(1)
#: Distances of points as users write them, and any others [nm].
SPACINGS = [*np.arange(1, 1001) / 10, *np.geomspace(0.1, 1000, 500)]
#: Numbers of a scan whose spectrum falls and ends far beyond every grid.
SCANNED = {"rms_nm": 3.0, "feasible": [0.0, 3.0], "plateau_nm4": 1e4, "corner_rad_per_um": 1e-3, "slope": -4.0}
SCANNED |= {"end_rad_per_um": 1e9, "correlation_um": {"fitted": 0.1}}


def refusals(relation, **sections):
    """Problems that one relation has with sections of a configuration."""
    return list(Relations([relation]).problems(Keys(sections)))


def grid_of(spacing):
    """Grid of a spacing [nm], as jobs have it."""
    return StripGrid(1e-5, 1e-5, to_si(spacing, "nm"), 0.0)


def refused(spacing, psd):
    """Whether relations or physics refuse a spectrum on a grid, and on that of a variant, each by itself."""
    pairs = {"pairs": {"mine": {"beam": "Mine", "substrate": "Mine"}}, "run": {"pairs": ["mine"]}, "devices": {}}
    entry = {"surfaces": {"Mine": {"published_psd": psd}}} | pairs
    yield bool(refusals(relations.grid_carries_the_roughness, **entry, sampling={"spacing_nm": spacing}))
    variant = {"studies": {"variants": {"spacing_nm": [spacing]}}}
    yield bool(refusals(relations.other_grids_carry_the_roughness, **entry, **variant))
    try:
        RoughSurface(in_si(CutoffSelfAffine, psd), None, 1e-9, grid_of(spacing))
        yield False
    except ValueError:
        yield True


@pytest.mark.parametrize("beyond", ["cut", "continued"])
def test_a_measured_spectrum_up_to_the_nyquist_wave_number_fits_on_every_grid(beyond):
    for spacing in SPACINGS:
        psd = scans._by_numbers({"beyond": beyond, "heights": "moments", "psd": "fitted"}, SCANNED, spacing)[
            "published_psd"
        ]
        assert not any(refused(spacing, psd)), spacing
        assert all(refused(spacing, psd | {"cutoff_rad_per_um": psd["cutoff_rad_per_um"] * 1.0001})), spacing


def test_scans_with_the_points_of_the_grid_are_not_cut_off():
    for spacing in SPACINGS:
        settings = Settings("fitted", "cut", to_si(spacing, "nm"), None)
        points = int(RNG.integers(64, 4096))
        pixel = to_si(spacing * points, "nm") / points
        assert cutoff_and_clipping(np.pi / pixel, settings)[1] == ""
        assert "before that of the scans" in cutoff_and_clipping(1.0001 * np.pi / pixel, settings)[1]


def test_a_strip_of_one_point_is_not_shorter_than_its_spacing():
    for spacing in SPACINGS:
        side = to_si(spacing / 1e3, "um")
        assert StripGrid(side, side, to_si(spacing, "nm"), 0.0).shape == (1, 1)
        with pytest.raises(ValueError, match="spacing <= strip"):
            StripGrid(0.999 * side, side, to_si(spacing, "nm"), 0.0)


def test_three_summits_fit_on_a_strip_of_three_spacings():
    for spacing in SPACINGS[:1000]:
        side = float(3 * Decimal(str(spacing)) / 1000)  # as users write it [µm]
        sides = {
            "beam": {"width_um": side},
            "sampling": {},
            "identification": {},
            "run": {"pairs": ["a"]},
            "surfaces": {},
        }
        for coarse, fits in ((spacing, True), (1.001 * spacing, False)):
            found = refusals(relations.strips_can_hold_a_summit, character={"spacing_nm": coarse}, **sides)
            assert bool(found) != fits, spacing


#: Relative humidities in steps of a hundredth, and their sums and differences as decimal numbers.
HUMIDITIES = [Decimal(k) / 100 for k in range(1, 100)]


def test_uncertain_humidities_within_those_of_full_contact_are_corrected():
    for low, high in pairwise(HUMIDITIES[::3]):
        deviation = (high - low) / 3
        stated = {"humidities": [float(low + deviation)], "uncertainty": {"humidity": float(deviation)}}
        sections = {
            "contact": {"model": "full"},
            "figures": {"humidity": float(high)},
            "run": {"pairs": []},
            "materials": {},
            "surfaces": {"B2": {}},
            "pairs": {"b": {"beam": "B2", "substrate": "B2", "humidities": [float(low), float(high)]}},
        }
        device = {"kind": "cantilever", "pair": "b"} | stated
        relation = meetings.corrections_are_not_extrapolated
        assert not refusals(relation, **sections, devices={"C1": device})
        assert refusals(relation, **sections, devices={"C1": device | {"humidities": [float(low)]}})
        ratios = Correction(np.array([float(low), float(high)]), *[ElasticChange(np.array([0.5, 1.0]))] * 2)
        changes = ratios.at(stated["humidities"][0] - float(deviation))
        assert [change.ratio for change in changes] == pytest.approx([0.5, 0.5])


def test_a_spectrum_that_a_relation_lets_fall_falls_in_si_too():
    for corner in 10 ** RNG.uniform(-2, 4, 2000):
        for cutoff in (corner, np.nextafter(corner, np.inf), 1.001 * corner):
            psd = {"plateau_nm4": 100.0, "floor_nm4": 1.0, "corner_rad_per_um": corner, "cutoff_rad_per_um": cutoff}
            found = refusals(relations.spectra_fall, surfaces={"Mine": {"published_psd": psd}})
            assert bool(found) == is_at_most(cutoff, corner)
            if not found:
                in_si(CutoffSelfAffine, psd)
