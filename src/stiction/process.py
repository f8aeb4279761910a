"""Process in one process: from a configuration to the law of its surface and the recommended settings, without files.

Stages, settings and addresses of random numbers are the same as in the workflow, and so are the results.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import xarray as xr

from stiction.config.surfaces import process
from stiction.plan.graph import Results
from stiction.report.axes import process as sentences
from stiction.stages.axes.law import at_value
from stiction.stages.axes.recommended import devices_over

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Process:
    """Process of a configuration: the law of its surface, and the settings that suffice for its devices.

    Examples
    --------
    >>> import stiction
    >>> numbers = lambda rms: {"rms_nm": rms, "uncertainty": {"rms_nm": 0.05}}
    >>> settings = [{"value": 30} | numbers(2.1), {"value": 60} | numbers(3.4), {"value": 90} | numbers(5.2)]
    >>> etch = {"variable": "etch_time_s", "surface": "B2", "settings": settings}
    >>> stiction.Process.of(stiction.load({"process": {"etch": etch}}), "etch")
    Process etch: B2 over the etch time, 30 to 90 s, 3 settings
    """

    name: str
    results: Results  #: results of all stages by the names of their files

    @classmethod
    def of(cls, config: dict, name: str) -> "Process":
        """Process of a configuration, from `stiction.load`.

        Raises
        ------
        ValueError
            If the configuration has no such process.
        """
        processes = config.get("process", {})
        if name not in processes:
            raise ValueError(f"there is no process {name}; the configuration has {', '.join(processes) or 'none'}")
        return cls(name, Results.of(config))

    @property
    def law(self) -> xr.Dataset:
        """Settings and the law through them. Dataset of `stiction.stages.axes.law`."""
        return self.results[f"process/laws/{self.name}"]

    def at(self, value: float) -> xr.Dataset:
        """Quantities of the surface at a value of the variable, with their standard errors.

        They are ln of the rms in metres, skewness, kurtosis, ln of the corner in rad/m and slope of the spectrum.

        Raises
        ------
        ValueError
            If the value is beyond the settings.
        """
        return at_value(self.law, value)

    @property
    def devices(self) -> list[str]:
        """Devices over its variable, alone or with that of another process."""
        return devices_over(self._plan, self._section["variable"]) + self._mapped

    def margins(self, device: str) -> xr.Dataset:
        """Margins of one of its devices over the variable. Dataset of `stiction.stages.axes.margins`.

        The first call computes the device at seven values or more, a minute or two for a stopper of 5 µm. Over two
        processes it has an axis for each, and takes five to seven times as long.
        """
        self._must_have(device)
        return self.results[f"process/{'maps' if device in self._mapped else 'curves'}/{device}"]

    def settings(self) -> xr.Dataset:
        """Settings that suffice for each device and for all, the best, and the next to measure.

        Dataset of `stiction.stages.axes.recommended`. The first call computes all devices.
        """
        if not devices_over(self._plan, self._section["variable"]):
            alone = " alone" if self._mapped else ""
            raise ValueError(f"no device has process {self.name}{alone}: state it in the key process of a device")
        return self.results[f"process/settings/{self._section['variable']}"]

    def pairs(self, device: str) -> xr.Dataset:
        """Pairs of settings of two processes that suffice for a device with ``second_process``, and the best pair.

        Dataset of `stiction.stages.axes.recommended`.
        """
        if device not in self._mapped:
            raise ValueError(f"device {device} has no second_process beside {self.name}")
        return self.results[f"process/pairs/{device}"]

    def answers(self, device: str) -> list[str]:
        """Settings that suffice for one of its devices, or for ``all devices`` if there are several, in sentences."""
        if device in self._mapped:
            return sentences.answers_of_pairs(self.pairs(device))
        settings = self.settings()
        if device not in settings.who.values:
            self._must_have(device)
        return sentences.answers(settings, device)

    def plot(self, device: str | None = None) -> "Figure":
        """Figure of the law, or of one of its devices over the variable."""
        from stiction.report.axes import figures

        if device in self._mapped:
            return figures.process_map(self.margins(device), self.pairs(device))
        if device is None:
            return figures.laws(self.law)
        return figures.devices(self.margins(device), self.settings(), device)

    def __repr__(self):
        section = self._section
        values = [setting["value"] for setting in section["settings"]]
        variable = section["variable"]
        return (
            f"Process {self.name}: {section['surface']} over the {process.words_of(variable)}, {min(values):g} to "
            f"{max(values):g} {process.unit_of(variable)}, {len(values)} settings"
        )

    def _must_have(self, device):
        """Refuse a device without this process."""
        if device not in self.devices:
            raise ValueError(
                f"device {device} has no process over {self._section['variable']}: {', '.join(self.devices)}"
            )

    @property
    def _mapped(self):
        """Devices over this process and another one."""
        named = {
            device: process.processes_of(self._plan.config, device) for device in self._plan.devices.processed_twice
        }
        return [device for device, processes in named.items() if self.name in processes]

    @property
    def _plan(self):
        return self.results.graph.plan

    @property
    def _section(self):
        return self._plan.config["process"][self.name]
