"""Configurations that together have a job of every stage, planned in seconds without any file of a scan."""

from collections.abc import Iterator
from pathlib import Path

import yaml

from stiction.config.files import joined, load
from stiction.config.validation import normalised
from stiction.plan.devices import MANY
from stiction.plan.graph import Graph, Job, stages
from stiction.plan.plan import Plan
from stiction.plan.planner import RESULTS
from stiction.plan.stage import File

ROOT = Path(__file__).parents[1]
#: The paper, and the devices of the examples, which need every stage that no measured surface needs.
EXAMPLES = [
    yaml.safe_load((ROOT / "examples" / f"{name}.yaml").read_text()) for name in ("devices", "test_beams", "roughness")
]
SECTIONS = [{key: example[key] for key in ("test_beams", "devices") if key in example} for example in EXAMPLES]
#: Counts beside the crack lengths of an array of the examples.
COUNTS = [{"humidity": 0.67, "length_um": 300, "stuck": 3, "of": 20}]
#: Islands as a variant, which the paper does not run.
ISLANDS = {"variants": {"asperity": ["island"]}}
#: Voltage, dimples and tilt, which the devices of the examples do not have.
BIASED = {"voltage_V": 5, "dielectric": {"thickness_nm": 100, "permittivity": 3.9}}
DIMPLED = {
    "length_um": 250,
    "uncertainty": {"edge_radius_um": 0.03},
    "dimples": {"number": 2, "at_um": [200], "height_um": 1, "contact_um": [2, 2]},
}
#: Process of a device of the examples, which have none of their own but one of drawn scans.
ETCHED = [{"value": value, "rms_nm": value / 20, "uncertainty": {"rms_nm": 0.1}} for value in (30, 60, 90)]
ETCH = {"variable": "etch_time_s", "surface": "B2", "settings": ETCHED}
MORE = {"devices": {"C1": BIASED | DIMPLED, "S1": BIASED | {"tilt_deg": [0, 0.1]}, "Lever": {"process": "etch"}}}
MORE["devices"]["Probe"] = {"kind": "probe", "pair": "b", "radius_um": 5, "humidities": [0.6], "restoring_force_uN": 1}
MORE["devices"]["Bump"] = {"process": "etch", "second_process": "deposition"}
DEPOSITION = ETCH | {"variable": "deposition_time_min", "surface": "Sub1"}
MORE |= {"studies": ISLANDS, "process": {"etch": ETCH, "deposition": DEPOSITION}}


def of_paper_and_devices() -> Plan:
    """Plan of the paper with its studies, and of devices of the examples with voltage, dimples, tilt and a process."""
    return Plan(load(*SECTIONS, {"test_beams": {"paperB": {"stuck": COUNTS}}} | MORE))


def of_scans() -> Plan:
    """Plan of a measured surface whose files do not exist: its jobs have names and inputs, and no settings."""
    files = {"surfaces": {"Etched": {"scans": {"files": ["etched_1.gwy", "etched_2.gwy"]}}}}
    config = normalised(joined(files, {"pairs": {"b": {"beam": "Etched"}}, "run": {"pairs": ["b"]}}))
    return Plan(config, {"Etched": {"feasible": (-0.76, 3.9)}})


def of_others() -> list[Plan]:
    """Plans of compared values, dry air, many cantilevers on a patch, full contact, attraction of touching summits."""
    compared = {"pairs.b.gap_um": [20, 30], "devices.S1.restoring_force_uN": [1, 2], "devices.C1.gap_um": [2, 3]}
    stopper = {"kind": "stopper", "pair": "b", "contact_um": [1, 1], "restoring_force_uN": 0.2}
    rough = {"requirement": {"share": 0.05}, "roughness": {"surface": "B2", "rms_nm": [2, 8]}}
    lever = SECTIONS[2]["devices"]["Lever"] | {"humidities": ["dry", 0.6]}
    dry = {"S": stopper | rough | {"humidities": ["dry", 0.6]}, "Lever": lever}
    many = {f"C{k}": SECTIONS[0]["devices"]["C1"] | {"gap_um": 20 + k / 100} for k in range(MANY)}
    full = {"run": {"studies": ["full_contact"]}}
    return [
        Plan(load(SECTIONS[0], {"compare": compared})),
        Plan(load({"devices": dry, "attraction": {"reach": "all"}})),
        Plan(load({"devices": many})),
        Plan(load(SECTIONS[0], full, {"pairs": {"b": {"attraction": "all"}}})),
        Plan(load(SECTIONS[0], full, {"attraction": {"reach": "touching"}, "surfaces": {"B2": {"psd": "identified"}}})),
    ]


def wanted(plan: Plan) -> list[str]:
    """Files that the targets want, by the names of `Graph.job`."""
    return [
        name.format(**at)
        for stage, _ in stages().values()
        for at in stage.jobs_of_targets(plan)
        for name in stage.files.values()
    ]


def behind(graph: Graph) -> Iterator[Job]:
    """Yield the job of every file that the targets want, and of every result behind it."""
    waiting, seen = wanted(graph.plan), set()
    while waiting:
        if (name := waiting.pop()) not in seen:
            seen.add(name)
            yield (job := graph.job(name))
            waiting += [result for names in job.inputs.values() for result in results(names)]


def results(names) -> Iterator[str]:
    """Yield the results among the names of an input: datasets, and files below results/."""
    for name in [names] if isinstance(names, str) else names.values() if isinstance(names, dict) else names:
        if not isinstance(name, File):
            yield name
        elif name.startswith(RESULTS):
            yield name.removeprefix(RESULTS)
