"""Settings of jobs by the names of their files."""

from stiction.plan.graph import Graph, Results

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
