"""Settings of jobs by the names of their files, and a plan of an example."""

from pathlib import Path

import yaml

from stiction.config.files import load
from stiction.config.merging import merged
from stiction.plan.graph import Graph, Results
from stiction.plan.plan import Plan

#: Surface of Gaussian heights with the spectrum of B2.
LIKE_B2 = {
    "rms_nm": 3.4,
    "skewness": 0,
    "kurtosis": 3,
    "psd": "published",
    "published_psd": {"corner_rad_per_um": 12, "cutoff_rad_per_um": 125, "floor_nm4": 0.3, "plateau_nm4": 14380},
}


def job_settings(plan, name):
    """Plain settings of the job of a plan that writes a file."""
    return Graph(plan).job(name).settings


def surface_datasets(plan, name):
    """Datasets of stages heights and spectrum of a surface."""
    results = Results(Graph(plan))
    return results[f"heights/{name}"], results[f"spectrum/{name}"]


def plan_of_copy(contact, beams, replica):
    """Plan of the example of a copy on summits, with few samples and with changes of its contact and its replica."""
    example = yaml.safe_load(Path(__file__).parents[1].joinpath("examples/replica.yaml").read_text(encoding="utf-8"))
    small = {
        "contact": {"distance_step_nm": 0.2, "model": "summits"} | contact,
        "chaos": {"order": 2},
        "design": {"beams": beams, "shares": [0.05]},
        "pairs": {"copied": {"replica": replica}},
    }
    return Plan(load({key: value for key, value in merged(example, small).items() if key != "compare"}))
