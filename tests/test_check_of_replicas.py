"""Coherences that two surfaces cannot have are refused before any job, as by the jobs themselves."""

import re
from unittest.mock import patch

import pytest
from configurations import PAPER
from plans import surface_datasets

from stiction import pilot
from stiction.command.prepared import prepared
from stiction.config.merging import merged
from stiction.config.messages import ConfigError
from stiction.config.units import in_si
from stiction.plan.plan import Plan
from stiction.plan.stage import select
from stiction.stages.contact import pairs

SKEWED = {
    "rms_nm": 3.4,
    "skewness": -0.76,
    "kurtosis": 3.9,
    "psd": "published",
    "published_psd": {"corner_rad_per_um": 12, "cutoff_rad_per_um": 125, "floor_nm4": 0.3, "plateau_nm4": 14380},
}
LEVER = {"kind": "stopper", "pair": "r", "contact_um": [1, 1], "restoring_force_uN": 20, "humidities": [0.6]}


def study(coherence, **surface):
    """Stopper on a copy of this coherence, on an independent surface without one."""
    pair = {"beam": "S", "substrate": "S", "gap_um": 2, "humidities": [0.6]}
    pair |= {} if coherence is None else {"replica": {"coherence": coherence}}
    run = {"pairs": [], "studies": []}
    surfaces = {"S": {key: value for key, value in (SKEWED | surface).items() if value is not None}}
    return merged(PAPER, {"surfaces": surfaces, "pairs": {"r": pair}, "devices": {"D": LEVER}, "run": run})


def is_refused_by_job(coherence):
    """Whether a job refuses the coherence of the skewed surfaces."""
    plan = Plan(prepared(study(coherence)).config)
    settings = in_si(pairs.Settings, select(pairs.Settings, plan.seen_by("r", samples=1)))
    try:
        pairs.require_feasible([surface_datasets(plan, "S")] * 2, "NG", settings)
    except ValueError:
        return True
    return False


def refusal(coherence, **surface):
    """Refusal of a check, none if the study can run."""
    try:
        prepared(study(coherence, **surface), with_samples=True)
    except ConfigError as error:
        return str(error)
    return None


def test_a_check_names_the_largest_coherence_that_jobs_accept():
    (line,) = refusal(0.97).splitlines()
    assert line.startswith("pairs.r.replica.coherence is 0.97, must be at most 0.")
    assert "a full replica has the opposite skewness" in line
    largest = float(re.search(r"at most ([\d.]+) for", line)[1])
    assert is_refused_by_job(largest + 0.01)
    assert not is_refused_by_job(largest)
    assert refusal(largest) is None
    assert refusal(0.97, skewness=0, kurtosis=3) is None


def test_surfaces_without_a_copy_are_not_asked():
    with patch.object(pilot, "Replica", side_effect=AssertionError):
        assert refusal(None) is None
        with pytest.raises(AssertionError):
            refusal(0.5)


def test_preliminary_spectra_are_refused_beyond_doubt_only():
    line = refusal(0.99, psd="identified", published_psd=None, mean_summit_radius_um=0.56, summit_density_per_um2=29)
    assert line.endswith("(preliminary, given surfaces.S.psd = 'identified')")


@pytest.mark.parametrize(("largest", "is_refused"), [(0.97, True), (0.6, False)])
def test_the_largest_coherence_of_a_range_is_checked_as_a_stated_one(largest, is_refused):
    over = {"requirement": {"share": 0.01}, "roughness": {"surface": "S", "coherence": [0, largest]}}
    try:
        prepared(merged(study(0.5), {"devices": {"D": over}}), with_samples=True)
        said = ""
    except ConfigError as error:
        said = str(error)
    assert said.startswith("devices.D.roughness.coherence[1] is 0.97, must be at most 0.") is is_refused
    assert bool(said) is is_refused
