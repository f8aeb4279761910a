"""A device in one process: from a configuration to its safe lengths, forces and uncertainty, without files.

Stages, settings and addresses of random numbers are the same as in the workflow, and so are the results.
"""

from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr

from stiction.config.cases import case_id
from stiction.config.kinds import KINDS, Kind
from stiction.config.units import in_si
from stiction.plan.devices import DevicePlan
from stiction.plan.graph import Results
from stiction.stages.beams import pair_warnings
from stiction.stages.devices import device_warnings
from stiction.stages.devices.contact_names import contact_of, tips_of
from stiction.stages.surfaces import surface_flags


@dataclass(frozen=True)
class Device:
    """One device of a configuration, and its safe lengths or pull-off forces at any relative humidity, or ``"dry"``.

    Examples
    --------
    >>> import stiction
    >>> beam = {"kind": "cantilever", "pair": "b", "thickness_um": 2.6, "gap_um": 20, "width_um": 30}
    >>> config = stiction.load({"devices": {"C1": beam | {"humidities": [0.67]}}})
    >>> device = stiction.Device.of(config, "C1")  # doctest: +SKIP
    >>> device.safe_lengths(0.67).safe_length  # doctest: +SKIP
    """

    name: str
    results: Results  #: results of all stages by the names of their files

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
        devices = DevicePlan(config).sections
        if name not in devices:
            raise ValueError(f"there is no device {name}; the configuration has {', '.join(devices) or 'none'}")
        device = cls(name, Results.of(config))
        device.contact, device.tips  # noqa: B018 - computed now, as the docstring says
        return device

    @property
    def contact(self) -> xr.Dataset:
        """Contact of the strips along a beam, or of the whole area of a stopper, at its highest humidity."""
        return self.results[contact_of(self._plan, self._wettest)]

    @property
    def tips(self) -> xr.Dataset | None:
        """Contact of the strips that hold the tips of a cantilever, at its highest humidity; ``None`` for others."""
        return next((self.results[name] for name in tips_of(self._plan, self._wettest).values()), None)

    @property
    def _wettest(self):
        """Name of the device at its highest humidity: the contact differs in dry air alone."""
        return case_id(self.name, max(self._section["humidities"]))

    def cracks(self, humidity: float | str) -> xr.Dataset:
        """Crack lengths of long beams, or lengths of held bridges; dataset of `stiction.stages.devices.cracks`.

        The first call takes half a minute, for a bridge a minute.
        """
        self._must_be(lambda kind: kind.is_beam)
        return self._result("cracks", humidity)

    def safe_lengths(self, humidity: float | str) -> xr.Dataset:
        """P(stuck) over the length, and safe lengths; dataset of `stiction.stages.devices.safe_lengths`."""
        self._must_be(lambda kind: kind.is_beam)
        return self._result("safe_lengths", humidity)

    def chart(self, humidity: float | str) -> xr.Dataset:
        """Safe lengths of the thicknesses and gaps of its chart; dataset of `stiction.stages.devices.chart`."""
        self._must_be(lambda kind: kind.is_beam)
        self._must_state("chart", self._section.get("chart"))
        return self._result("chart", humidity)

    def forces(self) -> xr.Dataset:
        """Pull-off forces of a stopper, P(stuck) and the worst humidity: dataset of stage stoppers."""
        self._must_be(lambda kind: not kind.is_beam)
        return self.results[f"devices/stoppers/{self.name}"]

    def budget(self, humidity: float | str) -> xr.Dataset:
        """Uncertainty of the mean length or force; dataset of `stiction.stages.devices.budget`.

        The first call draws the surfaces with every uncertain input changed, a few minutes.
        """
        self._must_state("uncertainty", self.name in self._plan.devices.budgeted)
        return self._result("budget", humidity)

    def tip_budget(self, humidity: float | str) -> xr.Dataset:
        """As `budget`, of the length that the tip of a cantilever holds."""
        self._must_be(lambda kind: kind.has_tip)
        self._must_state("uncertainty", self.name in self._plan.devices.budgeted)
        return self._result("budget", humidity, "_tip")

    def roughness(self) -> xr.Dataset:
        """Safe length or force over the roughness of a surface, and which roughness suffices for its requirement.

        Dataset of `stiction.stages.roughness.curves`. The first call draws the surfaces at eight roughnesses.
        """
        self._must_state("roughness", self._section.get("roughness"))
        return self.results[f"devices/roughness/{self.name}"]

    def test_beams(self) -> xr.Dataset:
        """What its test beams say about its inputs and lengths; dataset of `stiction.stages.test_beams.inference`.

        The first call computes the budgets of device and test beams, a few minutes.
        """
        self._must_state("test_beams", self._section.get("test_beams"))
        return self.results[f"devices/test_beams/{self.name}"]

    def test_beams_again(self) -> xr.Dataset:
        """As `test_beams`, with lengths or forces computed again at the inputs that the test beams suggest.

        Dataset of `stiction.stages.test_beams.rerun`.
        """
        self._must_state("test_beams", self._section.get("test_beams"))
        return self.results[f"devices/test_beams/rerun/{self.name}"]

    def warnings(self, safe_lengths: xr.Dataset) -> list[str]:
        """Where a result of `safe_lengths` or `forces` is beyond the limits of the model, one sentence each.

        Plasticity is not checked, which is one of the sentences.
        """
        settings = self.results.graph.job(f"devices/warnings/{self.name}.json").settings
        measured = surface_flags.inputs(self._plan, self._section["pair"])
        flags = surface_flags.together(
            {stage: {name: self.results[file] for name, file in files.items()} for stage, files in measured.items()}
        )
        if "stopper" in settings:
            return device_warnings.of_stopper(in_si(device_warnings.OfStopper, settings["stopper"])) + flags
        of_beam = device_warnings.of_device(safe_lengths, in_si(device_warnings.OfDevice, settings["beam"]))
        return pair_warnings.numbered(of_beam)[0] + flags

    def _result(self, stage, humidity, end=""):
        """Dataset of a stage at a humidity."""
        return self.results[f"devices/{stage}/{case_id(self.name, humidity)}{end}"]

    @property
    def _plan(self):
        return self.results.graph.plan

    @property
    def _section(self):
        return self._plan.config["devices"][self.name]

    def _must_be(self, wanted: Callable[[Kind], bool]):
        """Refuse a result that other kinds of devices have."""
        kinds = [name for name, kind in KINDS.items() if wanted(kind)]
        if self._section["kind"] not in kinds:
            raise ValueError(f"device {self.name} is a {self._section['kind']}; only a {' or '.join(kinds)} has this")

    def _must_state(self, key, stated):
        """Refuse a result without the key of the device on which it depends."""
        if not stated:
            raise ValueError(f"device {self.name} has no {key}: state devices.{self.name}.{key}")
