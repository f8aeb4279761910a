"""Settings of jobs by the names of their files."""

from stiction.plan.graph import Graph, Results


def job_settings(plan, name):
    """Plain settings of the job of a plan that writes a file."""
    return Graph(plan).job(name).settings


def surface_datasets(plan, name):
    """Datasets of stages heights and spectrum of a surface."""
    results = Results(Graph(plan))
    return results[f"heights/{name}"], results[f"spectrum/{name}"]
