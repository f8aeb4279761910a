"""A device in one process: from a configuration to its safe lengths, forces and uncertainty, without files.

Stages, settings and addresses of random numbers are the same as in the workflow, and so are the results.
"""

from dataclasses import dataclass
from functools import cached_property

import xarray as xr

from stiction.config import jobs
from stiction.config.cases import case_id
from stiction.config.designs import BEAMS, Designs
from stiction.config.merging import merged
from stiction.config.plan import Plan
from stiction.config.units import typed
from stiction.designs import budget, chart, cracks, findings, inputs, safe_lengths, stoppers
from stiction.models import SHIFTED
from stiction.stages import contact as stage_contact
from stiction.stages import identification
from stiction.studies import slope_contact
from stiction.study import estimate_of, surface_datasets
from stiction.variants import contact as variant_contact
from stiction.variants import summits


@dataclass(frozen=True)
class Device:
    """One device of a configuration, and its safe lengths or pull-off forces at any relative humidity.

    Examples
    --------
    >>> import stiction
    >>> beam = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    >>> config = stiction.load({"devices": {"C1": beam | {"humidities": [0.67]}}})
    >>> device = stiction.Device.of(config, "C1")  # doctest: +SKIP
    >>> device.safe_lengths(0.67).safe_length  # doctest: +SKIP
    """

    name: str
    contact: xr.Dataset  #: contact of the strips along a beam, or of the whole area of a stopper
    tips: xr.Dataset | None  #: contact of the strips that hold the tips of a cantilever
    config: dict  #: complete configuration
    surfaces: list[tuple[xr.Dataset, xr.Dataset]]  #: datasets (heights, spectrum) of beam and substrate

    @classmethod
    def of(cls, config: dict, name: str) -> "Device":
        """Device of a configuration: draws the surfaces and computes their contact.

        This takes about 5 ms per sample of 1.5 µm x 30 µm, and more for larger ones.

        Parameters
        ----------
        config : dict
            Complete configuration, from `stiction.load`.
        name : str
            Name of the device.

        Raises
        ------
        ValueError
            If the configuration has no such device.
        """
        designs, plan = Designs(config), Plan(config)
        if name not in designs.devices:
            raise ValueError(f"there is no device {name}; the configuration has {', '.join(designs.devices) or 'none'}")
        pair, kind = (config["devices"][name][key] for key in ("pair", "kind"))
        surfaces = [surface_datasets(plan, side) for side in plan.sides(pair)]

        def contact(settings):
            return stage_contact.compute(surfaces, pair, "NG", typed(stage_contact.Settings, settings))

        shared = designs.has_strips_of_pair(name)
        ground = contact(jobs.contact(plan, pair) if shared else jobs.device_contact(plan, *designs.ground(name)))
        tips = contact(jobs.tip_contact(plan, *designs.tips(name))) if kind == "cantilever" else None
        return cls(name, ground, tips, config, surfaces)

    def cracks(self, humidity: float) -> xr.Dataset:
        """Crack lengths of long beams, or lengths of held bridges; dataset of `stiction.designs.cracks`.

        The first call takes half a minute, for a bridge a minute.
        """
        self._must_be(*BEAMS)
        if humidity not in self._known_cracks:
            self._known_cracks[humidity] = cracks.compute(self.contact, self._settings(cracks, jobs.cracks, humidity))
        return self._known_cracks[humidity]

    def safe_lengths(self, humidity: float) -> xr.Dataset:
        """P(stuck) over the length, and safe lengths; dataset of `stiction.designs.safe_lengths`."""
        found, settings = self.cracks(humidity), self._settings(safe_lengths, jobs.safe_lengths, humidity)
        return safe_lengths.compute(found, self.tips, settings)

    def chart(self, humidity: float) -> xr.Dataset:
        """Safe lengths of the thicknesses and gaps of its chart; dataset of `stiction.designs.chart`."""
        self._must_be(*BEAMS)
        self._must_state("chart", self._section.get("chart"))
        return chart.compute(self.contact, self.tips, self._settings(chart, jobs.chart, humidity))

    def forces(self) -> xr.Dataset:
        """Pull-off forces of a stopper, P(stuck) and the worst humidity; dataset of `stiction.designs.stoppers`."""
        self._must_be("stopper")
        return stoppers.compute(self.contact, typed(stoppers.Settings, jobs.stoppers(Plan(self.config), self.name)))

    def budget(self, humidity: float) -> xr.Dataset:
        """Uncertainty of the mean length or force; dataset of `stiction.designs.budget`.

        The first call draws the surfaces with every uncertain input changed, a few minutes.
        """
        self._must_state("uncertainty", self.name in Designs(self.config).budgeted)
        return self._budget(self.contact, self._changed, jobs.budget, humidity)

    def tip_budget(self, humidity: float) -> xr.Dataset:
        """As `budget`, of the length that the tip of a cantilever holds."""
        self._must_be("cantilever")
        self._must_state("uncertainty", self.name in Designs(self.config).budgeted)
        return self._budget(self.tips, self._changed_tips, jobs.tip_budget, humidity)

    def _budget(self, contact, changed, job, humidity):
        """Budget with the contacts of the device or of its tips."""
        plan = Plan(self.config)
        plain = job(plan, case_id(self.name, humidity))
        settings = typed(inputs.Settings, plain["budget"])
        described = dict(zip(plan.sides(self._section["pair"]), self.surfaces, strict=True))
        uncertain = {name: described[name] for name, _ in plain["quantities"]}
        estimates = {name: estimate_of(plan, name) for name in uncertain if name in plan.scanned}
        known = inputs.covariances(uncertain, estimates, settings)
        return budget.compute(contact, *changed, known, settings)

    @cached_property
    def _changed(self):
        """Contacts with less and with more of every input, and under other choices of the model."""
        plan, designs = Plan(self.config), Designs(self.config)
        pair, ground = self._section["pair"], designs.ground(self.name)
        shared = designs.has_strips_of_pair(self.name)
        shifts = jobs.slope_contact(plan, pair) if shared else jobs.device_slope_contact(plan, *ground)
        choices = {name: self._choice(plan, *ground, name) for name in plan.choices_of_device(self.name)}
        return *self._changes(ground, shifts, jobs.solid_contact), choices

    @cached_property
    def _changed_tips(self):
        """As `_changed`, of the strips that hold the tips."""
        plan, tips = Plan(self.config), Designs(self.config).tips(self.name)
        chosen = plan.choices_of_solids(tips.pair)
        choices = {name: self._met(tips.pair, jobs.tip_choice_contact(plan, *tips, name)) for name in chosen}
        return *self._changes(tips, jobs.tip_contact(plan, *tips), jobs.tip_solid_contact), choices

    def _changes(self, patch, shifts, solid_job):
        """Contacts of a patch with less and with more of every input."""
        plan, designs, shifting = Plan(self.config), Designs(self.config), typed(slope_contact.Settings, shifts)
        shifted = {
            key: tuple(slope_contact.compute(self.surfaces, patch.pair, *key, shifting))
            for key in designs.quantities(self.name)
        }
        solids = {
            name: tuple(self._met(patch.pair, solid_job(plan, *patch, name, side)) for side in SHIFTED)
            for name in designs.uncertain_solids(self.name)
        }
        return shifted, solids

    def _met(self, pair, plain):
        """Contact of the surfaces under the settings of a job."""
        return stage_contact.compute(self.surfaces, pair, "NG", typed(stage_contact.Settings, plain))

    def _choice(self, plan, pair, length, width, variant):
        """Contact under another choice of the model."""
        plain = jobs.device_choice_summits(plan, pair, length, width, variant)
        described = dict(zip(plan.sides(pair), self.surfaces, strict=True))
        identified = {
            name: identification.compute(
                described[name][0], name, typed(identification.Settings, jobs.identification(plan, name))
            )
            for name in plain["identified"]
        }
        measured = {name: described[name] for name in plan.scanned_sides(pair)}
        both = (plain["base"], merged(plain["base"], plain["changes"]))
        found = summits.compute(identified, pair, *(typed(summits.Settings, one) for one in both), measured)
        return variant_contact.compute(found, typed(variant_contact.Settings, plan.variant_contact(pair, variant)))

    def warnings(self, found: xr.Dataset) -> list[str]:
        """Where a result of `safe_lengths` or `forces` is beyond the limits of the model, one sentence each.

        Plasticity is not checked, which is one of the sentences.
        """
        plan = Plan(self.config)
        if self._section["kind"] == "stopper":
            return findings.of_stoppers({}, jobs.beyond_stoppers(plan))[self.name]
        plain = jobs.beyond_the_model(plan)["devices"][self.name]
        return findings.numbered(findings.of_device(found, typed(findings.OfDevice, plain)))[0]

    @property
    def _section(self):
        """Its section of the configuration."""
        return self.config["devices"][self.name]

    @cached_property
    def _known_cracks(self):
        """Cracks by humidity, as far as they were computed."""
        return {}

    def _must_be(self, *kinds):
        """Refuse a result that other kinds of devices have."""
        if self._section["kind"] not in kinds:
            raise ValueError(f"device {self.name} is a {self._section['kind']}; only a {' or '.join(kinds)} has this")

    def _must_state(self, key, stated):
        """Refuse a result without the key of the device on which it depends."""
        if not stated:
            raise ValueError(f"device {self.name} has no {key}: state devices.{self.name}.{key}")

    def _settings(self, stage, job, humidity):
        """Settings of a stage at a humidity."""
        return typed(stage.Settings, job(Plan(self.config), case_id(self.name, humidity)))
