"""One way to a configuration that can run: checked, completed, with the numbers that it leaves open."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from stiction.config import scans
from stiction.config.messages import ConfigError, Problem
from stiction.config.reading import PAPER
from stiction.config.surfaces import process
from stiction.plan.devices import DevicePlan
from stiction.run.disk_cache import NOWHERE, Kept
from stiction.run.fingerprint import PACKAGE, fingerprint

if TYPE_CHECKING:
    from stiction.accuracy import Numbers


@dataclass(frozen=True)
class Prepared:
    """Configuration that can run."""

    config: dict[str, Any]  #: complete, valid and in normal form, with all numbers
    estimates: dict[str, dict]  #: preliminary numbers of its measured surfaces
    numbers: "Numbers | None"  #: decided for the errors of its devices, none if it leaves none open


def prepared(stated: dict[str, Any], kept: Kept = NOWHERE, with_samples: bool = False) -> Prepared:
    """Check and complete a configuration, and decide the numbers that it leaves open.

    Parameters
    ----------
    stated : dict
        Configuration as its files state it, see `stiction.config.files.joined`.
    kept : Kept
        What an earlier process found out.
    with_samples : bool
        Whether first samples must not show that a job would fail. Those of a stated accuracy are always drawn.

    Raises
    ------
    ConfigError
        If the configuration is invalid, or cannot run.
    """
    config, estimates = _checked(stated, kept)
    has_open_numbers = DevicePlan(config).has_open_numbers
    is_sampled = with_samples or has_open_numbers and "accuracy" in config["design"]  # whose pilot takes longer
    if is_sampled and (problems := problems_of_samples(config, estimates, kept)):
        raise ConfigError(*map(str, problems))
    if not has_open_numbers:
        return Prepared(config, estimates, None)
    from stiction import accuracy  # imports the physics, as the pilot does

    with kept.cache("accuracy.json") as remember:
        code = fingerprint(PACKAGE / "accuracy.py", kept.code)
        numbers = accuracy.numbers(config, estimates, code, remember)
    return Prepared(numbers.within(config) if numbers else config, estimates, numbers)


def _checked(stated, kept):
    """Complete configuration, and its estimates. A known one without scans is not checked again."""

    def check():
        """Check it now."""
        from stiction.config.validation import checked  # imports the physics

        return checked(stated, kept.folder and kept.folder / "scans")

    if scans.has_scans(stated) or process.has_scans(stated):
        return check()
    code = fingerprint(PACKAGE / "config" / "validation.py", kept.code, silent=())
    texts = [PAPER.with_name(name).read_text(encoding="utf-8") for name in (PAPER.name, "schema.yaml")]
    with kept.cache("planning.json") as remember:
        return remember(["valid", stated, code, texts], check)


def problems_of_samples(config: dict[str, Any], estimates: dict[str, dict], kept: Kept) -> list[Problem]:
    """Problems of a complete configuration in its first samples, which show that a job would fail."""
    from stiction import pilot

    with kept.cache("pilot.json") as remember:
        return pilot.problems(config, estimates, fingerprint(PACKAGE / "pilot.py", kept.code), remember)
