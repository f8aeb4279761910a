"""CPU time of jobs, estimated from the numbers in their settings and from measured times.

ASSUME: a run consists of fields of random surfaces in contact and of beams; all else is a fixed time for each job.
``docs/performance.md`` says how well that agrees with measured runs.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from stiction.config.units import NM_PER_UM
from stiction.contact.air import is_humid

#: CPU time [s] of a job apart from the following, of one point of a field of a sample in contact, and of one beam, on
#: one core of an AMD EPYC: 7 ms for 2.5 µm x 31 µm at 10 nm, and 0.24 s for 100 beams (docs/tables/bench.md).
PER_JOB, PER_POINT, PER_BEAM = 0.7, 7e-3 / (250 * 3100), 2.4e-3
#: The same of one point of a tilted strip at one slope, and of each nanometre that its forces reach. Tips 20 µm wide
#: on Sub1 take 0.16 ms at one slope at 3.4 nm rms, 6.9 ms at 35 nm and 34 ms at 80 nm; their length grows with the rms.
PER_SLOPE, PER_REACH = 0.5e-9, 0.048e-9
#: The same of a strip of the paper in full elastic contact at one humidity (docs/tables/full_contact_times.md), and in
#: dry air, where strips of surfaces like those of the paper take 2 s, and smooth ones up to 150 s.
PER_STRIP, PER_DRY_STRIP = 2.0, 10.0
#: The same of a tip at one slope: 0.1 to 4 s.
PER_TIP = 1.0
#: Time that every job reserves [min], that of the profiles for rules without resources.
USUAL_MINUTES = 10
#: Units of time [s].
_TIMES = ((86_400, "days"), (3600, "h"), (60, "min"), (1, "s"))
#: Sections of the settings of a job that draws surface pairs.
_DRAWN = {"sampling", "contact", "beam"}
#: Keys of the settings of a job in full elastic contact.
_FULL = {"strips", "humidities"}


def job_cost(settings: Mapping[str, Any], wildcards: Mapping[str, str], datasets: int = 1) -> float:
    """CPU time of a job [s], from its settings in the units of the configuration.

    A job that writes several ``datasets`` computes as many contacts, a chunk of them its part of the samples.

    Examples
    --------
    >>> beam, sampling = {"width_um": 30}, {"spacing_nm": 10, "strip_length_um": 1.5, "margin_um": 1}
    >>> settings = {"sampling": sampling, "beam": beam, "contact": {"samples": 5000}}
    >>> round(job_cost(settings, {})), round(job_cost(settings, {"chunk": "0", "number": "5"}), 1)
    (36, 7.7)
    """
    chunks, sections = int(wildcards["number"]) if "chunk" in wildcards else 1, list(_sections(settings))
    contacts = sum(map(_contact_time, sections)) * datasets / chunks
    full = (section for section in sections if section.keys() >= _FULL)
    strips = sum(section["strips"] * _strip_time(section) for section in full)
    return PER_JOB + contacts + strips + PER_BEAM * sum(map(_beams, sections))


def minutes(seconds: float, longest: int) -> int:
    """Time to reserve for a job of this CPU time [min]: ten times as much, from the usual time to the longest.

    A group of jobs reserves the sum of their times. ASSUME: with its start, on a slow machine, a job takes at most
    ten times the estimate; one that takes longer is tried again with twice the time. A job without contacts and beams,
    of which the estimate knows nothing, reserves the longest time.

    Examples
    --------
    >>> minutes(24.7, 120), minutes(180.7, 120), minutes(7200.7, 120), minutes(PER_JOB, 120)
    (10, 31, 120, 120)
    """
    enough = max(USUAL_MINUTES, math.ceil(10 * seconds / 60)) if seconds > PER_JOB else longest
    return min(longest, enough)


def _sections(settings: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Settings, and all sections in them."""
    yield settings
    for value in settings.values():
        if isinstance(value, Mapping):
            yield from _sections(value)


def _contact_time(section):
    """CPU time of the samples of surface pairs in a section [s]."""
    samples = section["contact"].get("samples") if section.keys() >= _DRAWN else None
    if not samples:
        return 0.0
    sampling = section["sampling"]
    sides = [side + sampling["margin_um"] for side in (sampling["strip_length_um"], section["beam"]["width_um"])]
    return samples * (math.prod(sides) * PER_POINT + _tilted_time(section)) * (NM_PER_UM / sampling["spacing_nm"]) ** 2


def _tilted_time(section):
    """CPU time of a tilted strip at all slopes [s], with one point per square micrometre."""
    if not (tilt := section.get("tilt")):
        return 0.0
    area = section["sampling"]["strip_length_um"] * section["beam"]["width_um"]
    return area * len(tilt["slopes"]) * (PER_SLOPE + PER_REACH * tilt["reach_nm"])


def _strip_time(section):
    """CPU time of a strip in full elastic contact at all humidities, of a tip at all slopes [s]."""
    humidities = section["humidities"]
    if tilt := section.get("tilt"):
        return PER_TIP * len(tilt["slopes"]) * len(humidities)
    return sum(PER_STRIP if is_humid(humidity) else PER_DRY_STRIP for humidity in humidities)


def _beams(section):
    """Number of beams in a section: of devices, of all sizes of a chart, or samples of a beam."""
    if section.get("by_sizes"):  # of which another job has the lengths; one, because a job without beams is unknown
        return 1
    sizes = math.prod(len(section.get(key, [0])) for key in ("thicknesses_um", "gaps_um"))
    has_elements = isinstance(section.get("beam"), Mapping) and "elements" in section["beam"]
    number = section.get("beams", section.get("samples") if has_elements else None)
    return number * sizes if isinstance(number, int) else 0


def in_words(seconds: float, megabytes: float) -> str:
    """CPU time and memory of a run in words.

    Examples
    --------
    >>> in_words(40, 800), in_words(20000, 1600)
    ('about 40 s of CPU time and 800 MB for each job', 'about 5.6 h of CPU time and 1600 MB for each job')
    """
    size, unit = next(((size, unit) for size, unit in _TIMES if seconds >= 1.5 * size), (1, "s"))
    return f"about {seconds / size:.2g} {unit} of CPU time and {megabytes:.0f} MB for each job"
