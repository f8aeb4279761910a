"""Errors of the curves of too small patches of the real surfaces of pair b name the patch."""

import numpy as np
import pytest
import small
from plans import job_settings

from stiction.config.merging import merged
from stiction.config.units import in_si
from stiction.contact.environment import Water
from stiction.stages.contact import contact, curves
from stiction.stages.contact.error_notes import on_patch

WATER = Water(300.0)


def energies(length, width):
    """Adhesion energies of 200 samples of patches with these sides [nm], as in the stages of devices."""
    settings = in_si(
        contact.Settings,
        merged(job_settings(small.PLAN, f"devices/contact/b_{length}x{width}"), {"contact": {"samples": 200}}),
    )
    drawn = contact.compute(small.surfaces(), "b", "NG", settings)
    with on_patch(1e-9 * length, 1e-9 * width):
        return curves.energies(drawn, 0.5, WATER)


def test_patches_with_as_many_summits_as_required_resist_the_adhesion():
    assert np.all(energies(50, 18_000) > 0)  # 19 summits


def test_patches_with_few_summits_do_not_resist_and_the_error_says_how_small_they_are():
    with pytest.raises(ValueError, match=r"the patch of surface is too small, so that a sample has too few") as refused:
        energies(50, 4000)  # 4 summits
    assert refused.value.__notes__ == ["The patch of surface is 0.05 x 4 µm."]


def test_other_errors_have_no_note():
    with pytest.raises(KeyError) as error, on_patch(1e-6, 1e-6):
        raise KeyError("e")
    assert not hasattr(error.value, "__notes__")
