"""The script of budgets takes every file for what its name says, whatever the order of the files."""

import importlib.util
from pathlib import Path
from types import SimpleNamespace

import pytest
import small
import xarray as xr

from stiction.config.units import typed
from stiction.designs import budget, inputs
from stiction.models import OF_MOMENTS
from stiction.stages import storage

SCRIPT = Path(__file__).parents[2] / "workflow" / "scripts" / "budget.py"
SURFACES = ("B2", "Sub1")
PLAIN = {
    "budget": {
        "seed": small.SEED,
        "water": {"temperature_K": 300},
        "humidity": 0.67,
        "surfaces": list(SURFACES),
        "uncertainty": {"young_modulus_GPa": 5, "hamaker_constant_zJ": 20, "scan_um": 10},
        "young_modulus_GPa": 164,
        "hamaker_constant_zJ": 97.5,
        "contact_um": [1.5, 6],
    },
    "quantities": [[name, quantity] for name in SURFACES for quantity in OF_MOMENTS],
    "choices": ["van_der_waals_dry", "every_2"],
}


class Files(list):
    """Input files of a job: a list of all, and lists by name."""

    def __init__(self, named):
        super().__init__(path for paths in named.values() for path in ([paths] if isinstance(paths, Path) else paths))
        vars(self).update(named)


@pytest.fixture(scope="module")
def main():
    spec = importlib.util.spec_from_file_location("script_of_budgets", SCRIPT)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded.main


def changed(factor):
    """Contact of the small study with other pressures of the solids."""
    contact = small.contact_of_pair()
    return contact.assign(solid_pressure=factor * contact.solid_pressure, difference=((), 0.1))


@pytest.fixture(scope="module")
def contacts():
    """Contact at both sides of every quantity of a surface."""
    return {
        (name, quantity): (changed(1 - 0.01 * k), changed(1 + 0.02 * k))
        for k, (name, quantity) in enumerate(map(tuple, PLAIN["quantities"]), 1)
    }


@pytest.fixture(scope="module")
def solids():
    """Contact at both sides of every property of the solids."""
    return {"modulus": (changed(0.9), changed(1.2)), "hamaker_constant": (changed(1.1), changed(0.95))}


@pytest.fixture(scope="module")
def choices():
    """Contact under every other choice of the model."""
    return {"van_der_waals_dry": changed(1.3), "every_2": changed(0.8)}


@pytest.fixture(scope="module")
def files(tmp_path_factory, contacts, solids, choices):
    """All input files, in an order of their own for every kind."""
    folder = tmp_path_factory.mktemp("inputs")

    def saved(dataset, stage, name):
        path = folder / stage / f"{name}.nc"
        path.parent.mkdir(parents=True, exist_ok=True)
        storage.save(dataset, path, stage, {})
        return path

    patch = "b_1500x6000"
    sides = {
        side: [saved(both[k], "contact", f"{patch}_{name}_{quantity}_{side}") for (name, quantity), both in entries]
        for k, side, entries in (
            (0, "less", reversed(contacts.items())),
            (1, "more", sorted(contacts.items(), key=lambda entry: entry[0][::-1])),
        )
    }
    of_solids = {
        name: [saved(both[k], "contact", f"{name}/{patch}_{side}") for k, side in ((1, "more"), (0, "less"))]
        for name, both in solids.items()
    }
    described = dict(zip(SURFACES, small.surfaces(), strict=True))
    return Files(
        sides
        | of_solids
        | {
            "contact": saved(small.contact_of_pair(), "contact", patch),
            "poisson_ratio": [],
            "choices": [saved(one, "contact", f"{patch}_{name}") for name, one in reversed(choices.items())],
            "heights": [saved(described[name][0], "heights", name) for name in SURFACES],
            "spectrum": [saved(described[name][1], "spectrum", name) for name in reversed(SURFACES)],
            "estimates": [],
        }
    )


def test_files_in_any_order_give_the_budget_of_what_they_are(main, files, contacts, solids, choices, tmp_path):
    output = tmp_path / "S1_rh067.nc"
    main(SimpleNamespace(params=SimpleNamespace(settings=PLAIN), input=files, output=[output]))
    settings = typed(inputs.Settings, PLAIN["budget"])
    known = inputs.covariances(dict(zip(SURFACES, small.surfaces(), strict=True)), {}, settings)
    expected = budget.compute(small.contact_of_pair(), contacts, solids, choices, known, settings)
    xr.testing.assert_equal(storage.load(output, "budget"), expected)
    assert len(set(expected.slope.values)) == len(contacts) + len(solids)  # control: every file has a slope of its own
