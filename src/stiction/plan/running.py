"""Run one job of the workflow: load its inputs, compute, save."""

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from stiction.plan.stage import At, Stage, stages_of
from stiction.run import labels, storage
from stiction.run.atomic import save_text
from stiction.run.logs import log_of, note_origin, recorded_origin


def run(job: Any) -> None:
    """Run a job as Snakemake describes it to a script."""
    (stage,) = (stage for stage in stages_of(job.params.module) if stage.name == job.params.stage)
    plain = job.params.settings
    settings = stage.converted(plain)
    first = stage.running.first(settings) if stage.running.first else {}
    data = {name: _load_input(job.input.get(name, []), *how, first, stage) for name, how in job.params.inputs.items()}
    at = At(**job.wildcards)
    result = stage.result(data, at, settings)
    if stage.save is not None:
        stage.save(result, dict(job.output.items()))
        if template := job.input.get("caption"):
            save_text(_caption(stage, job, template, result.get_label()), job.output.txt)
        note_origin(labels.origin(plain, _behind(stage, job)))
        return
    datasets = _inputs(job, of_datasets=True)
    for dataset, path in zip(stage.datasets(result, at), job.output, strict=True):
        storage.save(dataset, path, stage.stage, plain, datasets)


def _inputs(job, of_datasets) -> list[str]:
    """Paths of the inputs of a job that are datasets, or of all others."""
    names = (name for name, (label, _) in job.params.inputs.items() if bool(label) == of_datasets)
    return [path for name in names for path in _as_list(job.input.get(name, []))]


def _behind(stage, job) -> dict[str, str]:
    """Digests of all results behind a job, by file, as `stiction.run.labels.origin` takes them."""
    datasets = labels.made_from(_inputs(job, of_datasets=True), stage.stage, "", {}).before
    noted = {path: recorded_origin(log_of(path)) for path in _inputs(job, of_datasets=False)}
    return {path: labels.digest(settings) for path, settings in datasets.items()} | {
        path: origin for path, origin in noted.items() if origin
    }


def _caption(stage, job, template, more) -> str:
    """Text beside a figure: its title, its caption as in the report, and additions by the figure itself."""
    from jinja2 import StrictUndefined, Template  # comes with Snakemake

    caption = Template(Path(template).read_text(encoding="utf-8"), undefined=StrictUndefined).render(snakemake=job)
    paragraphs = [textwrap.fill(paragraph, 100) for paragraph in caption.strip().split("\n\n")]
    return "\n\n".join(filter(None, [stage.shown.title.format(**job.wildcards), *paragraphs, more])) + "\n"


def _as_list(paths) -> list[str]:
    """Paths of an input as a list. Snakemake gives a single one as text."""
    return [paths] if isinstance(paths, str) else list(paths)


def _load_input(paths: Any, label: str | None, keys: Any, first: dict, stage: Stage) -> Any:
    """Data of an input, structured as it was declared. Paths of files other than datasets stay paths.

    ``keys`` are those of a dict, ``True`` for an order, and ``None`` for one dataset.
    """
    paths = _as_list(paths)
    values: Iterator = (storage.load(path, label, **first) for path in paths) if label else iter(paths)
    if keys is None:
        return next(values)
    if keys is True:
        return values if stage.running.streamed else list(values)
    return {tuple(key) if isinstance(key, list) else key: value for key, value in zip(keys, values, strict=True)}
