"""Names of the files on which a job depends where they follow from the plan; rules state all other names themselves.

Files are relative to the working directory of a run. No module of a computation uses these names, so that no
fingerprint contains this module; a rule that names another file reruns because it depends on another file.
"""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from stiction.config.cases import case_id, pair_of
from stiction.config.designs import KEYS_OF_SOLIDS, Designs
from stiction.config.plan import Plan
from stiction.models import SHIFTED

#: Folder of the contacts of devices.
_CONTACT = "results/devices/contact"


def one_of(names: Iterable[str]) -> str:
    """Pattern of a wildcard that is one of some names; matches nothing without names.

    Examples
    --------
    >>> one_of(["Sub1", "B2"]), one_of([])
    ('B2|Sub1', '(?!)')
    """
    return "|".join(sorted(names)) or "(?!)"


def titled(name: str, shows: str) -> str:
    """Title of a table or figure in the report.

    Examples
    --------
    >>> titled("figure_05", "a force curve"), titled("fit_quality", "errors of Eq. (12)")
    ('Figure 5: a force curve', 'Fit quality: errors of Eq. (12)')
    """
    return f"{name.replace('_0', ' ').replace('_', ' ').capitalize()}: {shows}"


def of_surfaces(names: Iterable[str]) -> dict[str, list[str]]:
    """Datasets from which surfaces are drawn, by stage.

    Examples
    --------
    >>> of_surfaces(["B2"])
    {'heights': ['results/heights/B2.nc'], 'spectrum': ['results/spectrum/B2.nc']}
    """
    names = list(names)
    return {stage: [f"results/{stage}/{name}.nc" for name in names] for stage in ("heights", "spectrum")}


@dataclass(frozen=True)
class Paths:
    """Names of the input files of jobs for one configuration."""

    plan: Plan

    @cached_property
    def _designs(self):
        return Designs(self.plan.config)

    # Main line and studies

    def scan(self, surface: str, number: str) -> str:
        """File of a scan, relative to the working directory, so that a moved folder changes nothing."""
        return os.path.relpath(self.plan.scan_files(surface)[number])

    def identification(self, surface: str) -> str | list:
        """Dataset of the identification if the spectrum of a surface is identified, otherwise an empty list."""
        source = self.plan.config["surfaces"][surface]["psd"]
        return f"results/identification/{surface}.nc" if source == "identified" else []

    def surfaces(self, pair: str) -> dict[str, list[str]]:
        """Datasets of the surfaces of beam and substrate, in this order, by stage."""
        return of_surfaces(self.plan.sides(pair))

    def measured_surfaces(self, pair: str) -> dict[str, list[str]]:
        """As `surfaces`, of those surfaces that are described by scans, each once."""
        return of_surfaces(name for name in self.plan.scanned if name in self.plan.sides(pair))

    def estimates(self, pair: str) -> list[str]:
        """Estimates of the surfaces of a pair that are described by scans."""
        return [f"results/estimate/{surface}.nc" for surface in self.plan.scanned_sides(pair)]

    def contact(self, case: str, model: str) -> str:
        """Contact of the pair of a case, which is independent of humidity."""
        return f"results/contact/{pair_of(case)}_{model}.nc"

    def shifted_contacts(self, pair: str, surface: str) -> dict[str, list[str]]:
        """Contacts of a pair with less and with more of every quantity of a surface."""
        quantities = self.plan.quantities(surface)
        return {side: [f"{_shifted(pair)}_{surface}_{name}_{side}.nc" for name in quantities] for side in SHIFTED}

    def summits_of_variant(self, pair: str, variant: str) -> str:
        """Summits of a pair under a variant, which other variants may share."""
        return f"results/studies/variants/summits/{pair}_{self.plan.summits_under(pair, variant)}.nc"

    def contact_of_variant(self, case: str, variant: str) -> str:
        """Contact of the pair of a case under a variant, which other variants may share.

        That of the base is the contact of the main line, unless the variants have more samples.
        """
        shared = self.plan.contact_under(variant)
        if shared == "base" and self.plan.has_samples_of_variants:
            return self.contact(case, "NG")
        return f"results/studies/variants/contact/{pair_of(case)}_{shared}.nc"

    # Devices

    def ground(self, device: str) -> str:
        """Contact of the patch on which a device sticks: that of its pair in the main line if both are equal."""
        if self._designs.has_strips_of_pair(device):
            return f"results/contact/{self._section(device)['pair']}_NG.nc"
        return f"{_CONTACT}/{self._designs.ground(device).name}.nc"

    def tips(self, device: str) -> str | list:
        """Contact of the strips that hold the tips of a cantilever; an empty list for a bridge."""
        if self._section(device)["kind"] == "bridge":
            return []
        return f"{_CONTACT}/tips/{self._designs.tips(device).name}.nc"

    def uncertain_surfaces(self, device: str) -> dict[str, list[str]]:
        """Datasets of the surfaces of a device with uncertain quantities, and estimates of those described by scans."""
        names = dict.fromkeys(surface for surface, _ in self._designs.quantities(device))
        return of_surfaces(names) | {"estimates": self.estimates(self._section(device)["pair"])}

    def contacts_of_budget(self, device: str) -> dict[str, str | list[str]]:
        """Contact of the patch of a device, with less and more of every uncertain input, and under other choices."""
        pair, patch = self._section(device)["pair"], self._designs.ground(device).name
        slopes = _shifted(pair) if self._designs.has_strips_of_pair(device) else f"{_CONTACT}/slopes/{patch}"
        changed = self._changed_contacts(device, slopes, _CONTACT, patch, self.plan.choices_of_device(device))
        return {"contact": self.ground(device)} | changed

    def contacts_of_tip_budget(self, device: str) -> dict[str, str | list[str]]:
        """As `contacts_of_budget`, of the tips of a cantilever."""
        tips, folder = self._designs.tips(device), f"{_CONTACT}/tips"
        slopes, choices = f"{folder}/slopes/{tips.name}", self.plan.choices_of_solids(tips.pair)
        return {"contact": self.tips(device)} | self._changed_contacts(device, slopes, folder, tips.name, choices)

    def _changed_contacts(self, device, slopes, folder, patch, choices):
        """Contacts of a patch with less and more of every uncertain input of a device, and under choices of the model.

        ``slopes`` is the beginning of the names of those with a shifted quantity of a surface.
        """
        quantities = [f"{slopes}_{surface}_{quantity}" for surface, quantity in self._designs.quantities(device)]
        shifted = {side: [f"{begin}_{side}.nc" for begin in quantities] for side in SHIFTED}
        uncertain = self._designs.uncertain_solids(device)
        solids = {
            name: [f"{folder}/{name}/{patch}_{side}.nc" for side in SHIFTED if name in uncertain]
            for name in KEYS_OF_SOLIDS
        }
        return shifted | solids | {"choices": [f"{folder}/choices/{patch}_{variant}.nc" for variant in choices]}

    def summits_of_choice(self, pair: str, size: str, variant: str) -> str:
        """Summits of a patch of a pair, of a size such as ``1500x30000`` [nm], under a choice of the model."""
        return f"{_CONTACT}/summits/{pair}_{size}_{self.plan.summits_under(pair, variant)}.nc"

    def results(self, device: str) -> dict[str, list[str]]:
        """Everything that the page of a device shows, by stage."""
        designs, section = self._designs, self._section(device)
        cases = [case_id(device, humidity) for humidity in section["humidities"]]
        stopper = section["kind"] == "stopper"
        found = {
            "budgets": [f"budget/{name}" for name in (designs.budgets(device) if device in designs.budgeted else [])],
            "charts": [f"chart/{case}" for case in (designs.chart_cases(device) if device in designs.charted else [])],
            "safe_lengths": [] if stopper else [f"safe_lengths/{case}" for case in cases],
            "stoppers": [f"stoppers/{device}"] if stopper else [],
        }
        paths = {stage: [f"results/devices/{name}.nc" for name in names] for stage, names in found.items()}
        return paths | {"plasticity": [f"results/studies/plasticity/{pair}.nc" for pair in designs.pressed(device)]}

    def _section(self, device):
        return self.plan.config["devices"][device]


def _shifted(pair):
    """Beginning of the names of the contacts of a pair with a shifted quantity."""
    return f"results/studies/slopes/contact/{pair}"
