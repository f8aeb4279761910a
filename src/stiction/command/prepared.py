"""One way to a configuration that can run: checked, completed, with the numbers that it leaves open."""

from collections.abc import Callable
from dataclasses import astuple, dataclass
from typing import Any

from stiction.config import scans
from stiction.config.messages import ConfigError, Problem
from stiction.config.reading import PAPER
from stiction.config.surfaces import process
from stiction.config.tables import device_table
from stiction.plan.devices import DevicePlan
from stiction.plan.numbers import Numbers
from stiction.run.disk_cache import NOWHERE, Caches
from stiction.run.fingerprint import PACKAGE, fingerprint
from stiction.run.provenance import version_of

#: Files that determine what configurations mean.
_TEXTS = (PAPER.name, "schema.yaml", "materials.yaml")
#: Whole numbers from here on may have too many digits to be written.
LARGEST = 2**63


@dataclass(frozen=True)
class Prepared:
    """Configuration that can run."""

    config: dict[str, Any]  #: complete, valid and in normal form, with all numbers
    estimates: dict[str, dict]  #: preliminary numbers of its measured surfaces
    numbers: Numbers | None  #: decided for the errors of its devices, none if it leaves none open


def prepared(contents: dict[str, Any], caches: Caches = NOWHERE, with_samples: bool = False) -> Prepared:
    """Check and complete a configuration, and decide the numbers that it leaves open.

    Parameters
    ----------
    contents : dict
        Configuration as its files state it, see `stiction.config.files.joined`.
    caches : Caches
        What an earlier process found out.
    with_samples : bool
        Whether first samples must not show that a job would fail. Those of a stated accuracy are always drawn.

    Raises
    ------
    ConfigError
        If the configuration is invalid, or cannot run.
    """
    config, estimates = _checked(contents, caches)
    has_open_numbers = DevicePlan(config).has_open_numbers
    is_sampled = with_samples or has_open_numbers and "accuracy" in config["design"]  # whose pilot takes longer
    if is_sampled and (problems := problems_of_samples(config, estimates, caches)):
        raise ConfigError(*device_table.in_rows(map(str, problems), device_table.without_file(contents)[1]))
    if not has_open_numbers:
        return Prepared(config, estimates, None)
    numbers = _numbers(config, estimates, caches)
    return Prepared(numbers.within(config) if numbers else config, estimates, numbers)


def _checked(contents, caches):
    """Complete configuration, and its estimates. A known one without scans is not checked again.

    YAML reads some names as no text, which the check refuses and a key of what is kept cannot tell from text.
    """

    def check():
        """Check it now."""
        from stiction.config.validation import checked  # imports the physics

        return checked(contents, caches.folder and caches.folder / "scans")

    if scans.has_scans(contents) or process.has_scans(contents) or not _is_plain(contents):
        return check()
    return _cached(caches, "planning.json", "config/validation.py", [contents], check)


def _is_plain(value):
    """Whether a value and all in it have one meaning in JSON: names are text, and whole numbers short."""
    if isinstance(value, dict):
        return all(isinstance(key, str) and _is_plain(each) for key, each in value.items())
    if isinstance(value, list | tuple):
        return all(map(_is_plain, value))
    if isinstance(value, int):
        return abs(value) < LARGEST
    return value is None or isinstance(value, str | float)


def problems_of_samples(config: dict[str, Any], estimates: dict[str, dict], caches: Caches) -> list[Problem]:
    """Problems of a complete configuration in its first samples, which show that a job would fail."""

    def draw():
        """Draw them now."""
        from stiction import pilot  # imports the physics

        with caches.cache("pilot.json") as remember:
            code = fingerprint(PACKAGE / "pilot.py", caches.code)
            return list(map(astuple, pilot.problems(config, estimates, code, remember)))

    rows = _cached(caches, "samples.json", "pilot.py", [config, estimates], draw)
    return [Problem(tuple(path), message, tuple(map(tuple, keys))) for path, message, keys in rows]


def _numbers(config, estimates, caches):
    """Numbers for the errors of the devices of a complete configuration."""

    def decide():
        """Decide them now."""
        from stiction import accuracy  # imports the physics, as the pilot does

        with caches.cache("accuracy.json") as remember:
            code = fingerprint(PACKAGE / "accuracy.py", caches.code)
            numbers = accuracy.numbers(config, estimates, code, remember)
        return numbers and numbers.plain

    return Numbers.from_plain(_cached(caches, "numbers.json", "accuracy.py", [config, estimates], decide))


def _cached(caches: Caches, file: str, module: str, determined_by: list, compute: Callable[[], Any]) -> Any:
    """Result of a module, kept until a configuration, the module or one of its imports or libraries changes."""
    if caches.folder is None:
        return compute()
    code = fingerprint(PACKAGE / module, caches.code, silent=())
    texts = [PAPER.with_name(name).read_text(encoding="utf-8") for name in _TEXTS]
    libraries = [version_of(name) for name in ("numpy", "scipy", "numba")]
    with caches.cache(file) as remember:
        return remember([*determined_by, code, texts, libraries], compute)
