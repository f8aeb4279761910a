"""Device in one process: from a configuration to its safe lengths, forces and uncertainty, without files.

Stages, settings and addresses of random numbers are the same as in the workflow, and so are the results.
"""

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

import xarray as xr

from stiction.accuracy import decided
from stiction.answer.data import Answer
from stiction.config.cases import case_id, in_numbers
from stiction.config.kinds import BEAM, KEYS, KINDS, STOPPER, Kind, Release, kind_of
from stiction.config.mission.conditions import CONDITIONS
from stiction.contact.air import Air
from stiction.devices.limits.limit import Limit, restored
from stiction.estimate.answer import Estimate as Estimate
from stiction.estimate.answer import answer as estimated
from stiction.estimate.complete import question_of
from stiction.estimate.table import known
from stiction.plan.devices import DevicePlan
from stiction.plan.graph import Results
from stiction.report.answer import screen as answer_screen
from stiction.report.answer import words as answer_words
from stiction.report.answer.judged import with_limits
from stiction.report.format import conditions_in_words
from stiction.report.limits import words
from stiction.stages.answer.answer import answer_of
from stiction.stages.devices import device_warnings
from stiction.stages.devices.contact_names import contact_of, tips_of
from stiction.stages.devices.device_warnings import gap_warnings, left_out_changes
from stiction.stages.devices.results import stuck_beams, stuck_stoppers
from stiction.stages.surfaces import surface_flags

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Device:
    """Device of a configuration, and its safe lengths or pull-off forces at any relative humidity, or ``"dry"``.

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
        device = cls(name, Results.of(decided(config)))
        device.contact, device.tips  # noqa: B018 - computed now, as the docstring says
        return device

    @property
    def contact(self) -> xr.Dataset:
        """Contact of the strips along a beam, or of the whole area of a stopper, at its highest humidity."""
        return self.results[contact_of(self._plan, self._wettest)]

    @property
    def tips(self) -> xr.Dataset | None:
        """Contact of the strips at the tips of a cantilever, at its highest humidity, ``None`` for others."""
        return next((self.results[name] for name in tips_of(self._plan, self._wettest).values()), None)

    @property
    def _wettest(self):
        """Name of the device at its highest humidity: the contact differs in dry air alone."""
        return case_id(self.name, max(self._section["humidities"]))

    def cracks(self, humidity: float | str) -> xr.Dataset:
        """Crack lengths of long beams, or lengths of stuck bridges. Dataset of `stiction.stages.devices.cracks`.

        The first call takes half a minute, for a bridge a minute.
        """
        self._must_be(BEAM)
        return self._result("cracks", humidity)

    def safe_lengths(self, humidity: float | str) -> xr.Dataset:
        """P(stuck) against length, and safe lengths. Dataset of `stiction.stages.devices.safe_lengths`."""
        self._must_be(BEAM)
        return self._result("safe_lengths", humidity)

    def stuck(self, humidity: float | str) -> xr.Dataset:
        """P(stuck) with its 95 % band: of a beam over its length, of a stopper over its restoring force.

        Beams and stoppers have one layout, that of `stiction.stages.devices.results`.
        """
        return _STUCK[self.kind.release.name](self, humidity)

    def plot(self) -> "Figure":
        """Figure of P(stuck) by simulation alone, at all humidities: over lengths of beams, or forces of stoppers."""
        from stiction.report.devices.parts import OF_QUESTION

        return OF_QUESTION[self.kind.question(self._section)].figure(self.name, self._simulated)

    @property
    def kind(self) -> Kind:
        """Differences of its kind of devices from others."""
        return kind_of(self._section)

    @property
    def facts(self) -> dict[str, str]:
        """Dimensions, surfaces and air in words, by name."""
        section = self._section
        values = {key: section[key] for key in KEYS if key in section}
        numbers = {key: value if isinstance(value, list) else [value] for key, value in values.items()}
        sizes = {
            KEYS[key][0]: f"{' x '.join(f'{number:g}' for number in of_key)} {KEYS[key][1]}"
            for key, of_key in numbers.items()
        }
        pair = " on ".join(self._plan.sides(section["pair"]))
        humidities = ", ".join(Air(humidity).name for humidity in section["humidities"])
        mission = {"conditions": conditions_in_words(section[CONDITIONS])} if CONDITIONS in section else {}
        return sizes | {"surfaces": f"{pair}, pair {section['pair']}"} | mission | {"relative humidity": humidities}

    def __repr__(self):
        facts = ", ".join(f"{name} {value}" for name, value in self.facts.items())
        return f"Device {self.name}, {self.kind.words}: {facts}"

    def _repr_html_(self):
        """Table of its answer, if it is computed already, and of its facts, for notebooks."""
        headline = {}
        if self.results.has(f"devices/answer/{self.name}"):
            answer = self.answer()
            headline = (
                {answer_words.sign_of(answer)[1]: answer_screen.headline(answer)}
                if not answer_words.is_forbidden(answer)
                else {}
            )
        rows = "".join(
            f"<tr><td>{escape(name)}</td><td>{escape(value)}</td></tr>"
            for name, value in (headline | self.facts).items()
        )
        return f"<table><caption>Device {escape(self.name)}, {escape(self.kind.words)}</caption>{rows}</table>"

    def answer(self) -> Answer:
        """Answer about the device: the size to build, its steps, and P(stuck) at its own size, all as fields.

        It has everything inside that the device states, as on its page. The first call computes all of it: with stated
        uncertainties, some minutes. Whether the contact is plastic is not checked.
        """
        answer = answer_of(self.results[f"devices/answer/{self.name}"])
        return with_limits(answer, [limit for dataset in self._simulated.values() for limit in self.limits(dataset)])

    def estimate(self) -> Estimate:
        """Estimate at once of the lengths or forces at which few stick, for exact inputs and one answer in all airs.

        Raises
        ------
        NotLearnt
            If the estimate does not know the device.
        """
        return estimated(question_of(self._plan.config, self.name, self._section), *known())

    def chart(self, humidity: float | str) -> xr.Dataset:
        """Safe lengths of the thicknesses and gaps of its chart. Dataset of `stiction.stages.devices.chart`."""
        self._must_be(BEAM)
        self._must_state("chart", self._section.get("chart"))
        return self._result("chart", humidity)

    def forces(self) -> xr.Dataset:
        """Pull-off forces of a stopper, P(stuck) and the worst humidity: dataset of stage stoppers."""
        self._must_be(STOPPER)
        return self.results[f"devices/stoppers/{self.name}"]

    def life(self) -> xr.Dataset:
        """Life of the device: causes of contact, adhesion then, and ways to free it.

        Dataset of `stiction.stages.life.table`, one answer for every name along its dimension.
        """
        return self.results[f"devices/life/{self.name}"]

    def budget(self, humidity: float | str) -> xr.Dataset:
        """Uncertainty of the mean length or force. Dataset of `stiction.stages.devices.budget`.

        The first call draws the surfaces with every uncertain input changed, a few minutes.
        """
        self._must_state("uncertainty", self.name in self._plan.devices.with_budget)
        return self._result("budget", humidity)

    def tip_budget(self, humidity: float | str) -> xr.Dataset:
        """Uncertainty of the length of adhesion at the tip of a cantilever, see `budget`."""
        self._must_be(BEAM, has_tip=True)
        self._must_state("uncertainty", self.name in self._plan.devices.with_budget)
        return self._result("budget", humidity, "_tip")

    def roughness(self) -> xr.Dataset:
        """Safe length or force along the roughness of a surface, and roughnesses sufficient for its requirement.

        Dataset of `stiction.stages.axes.roughness`. The first call draws the surfaces at eight roughnesses.
        """
        self._must_state("roughness", self._section.get("roughness"))
        return self.results[f"devices/roughness/{self.name}"]

    def test_beams(self) -> xr.Dataset:
        """Evidence of its test beams on inputs and lengths. Dataset of `stiction.stages.test_beams.inference`.

        The first call computes the budgets of device and test beams, a few minutes.
        """
        self._must_state("test_beams", self._section.get("test_beams"))
        return self.results[f"devices/test_beams/{self.name}"]

    def test_beams_again(self) -> xr.Dataset:
        """Update of `test_beams`, with lengths or forces computed again at the inputs from the test beams.

        Dataset of `stiction.stages.test_beams.rerun`.
        """
        self._must_state("test_beams", self._section.get("test_beams"))
        return self.results[f"devices/test_beams/rerun/{self.name}"]

    def warnings(self, safe_lengths: xr.Dataset) -> list[str]:
        """Sentences on the `limits` of `safe_lengths` or `forces`."""
        return words.texts(self.limits(safe_lengths))

    def limits(self, safe_lengths: xr.Dataset) -> list[Limit]:
        """Limits of the model that `safe_lengths` or `forces` are beyond, each with the side on which they then err.

        Plasticity is not checked, which is one of the limits. Where attraction across gaps is left out, the first
        call computes what it would change.
        """
        settings = self.results.graph.job(f"devices/warnings/{self.name}.json").settings
        measured = surface_flags.inputs(self._plan, self._section["pair"])
        flags = surface_flags.together(
            {stage: {name: self.results[file] for name, file in files.items()} for stage, files in measured.items()}
        )
        left_out = device_warnings.left_out_gaps(self._plan, self.name).values()
        changes = {key: change for name in left_out for key, change in left_out_changes(self.results[name]).items()}
        flags += map(restored, settings.get("assumed", []))
        by_shape = device_warnings.of_settings(settings).limits(safe_lengths)
        with_gaps = {shape: limits + gap_warnings(changes, shape) for shape, limits in by_shape.items()}
        return words.distinct(with_gaps) + flags

    def _result(self, stage, humidity, end=""):
        """Dataset of a stage at a humidity."""
        return self.results[f"devices/{stage}/{case_id(self.name, humidity)}{end}"]

    @property
    def _simulated(self):
        """Datasets of simulation alone, of a beam by humidity."""
        return _SIMULATED[self.kind.release.name](self)

    @property
    def _plan(self):
        return self.results.graph.plan

    @property
    def _section(self):
        return self._plan.config["devices"][self.name]

    def _must_be(self, release: Release, has_tip: bool = False):
        """Refuse a result of other kinds of devices: of another release, or without a tip."""
        kinds = [name for name, kind in KINDS.items() if kind.release is release and kind.has_tip >= has_tip]
        if self._section["kind"] not in kinds:
            raise ValueError(f"device {self.name} is a {self._section['kind']}; only a {' or '.join(kinds)} has this")

    def _must_state(self, key, is_stated):
        """Refuse a result without its key in the section of the device."""
        if not is_stated:
            raise ValueError(f"device {self.name} has no {key}: state devices.{self.name}.{key}")


#: Datasets of simulation alone, and P(stuck) at a humidity, by the name of the release.
_SIMULATED = {
    "beam": lambda device: {humidity: device.safe_lengths(humidity) for humidity in device._section["humidities"]},
    "stopper": lambda device: {"forces": device.forces()},
}
_STUCK = {
    "beam": lambda device, humidity: stuck_beams(device.safe_lengths(humidity)),
    "stopper": lambda device, humidity: stuck_stoppers(device.forces(), in_numbers(humidity)),
}
