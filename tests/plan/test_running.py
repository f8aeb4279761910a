"""One job of the workflow: its inputs have the structure of the declaration, and its dataset names them."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from docutils import core
from hostile import HOSTILE, MADE, Reading
from jinja2 import Template

from stiction.config.files import paper
from stiction.plan import running
from stiction.plan.stage import Shown, Stage
from stiction.run import labels, storage
from stiction.run.atomic import DataError

pytestmark = pytest.mark.usefixtures("any_variable")


def dataset(value):
    return xr.Dataset({"x": ("sample", np.full(3, float(value)))})


@pytest.fixture
def files(tmp_path):
    """Two datasets of stage forces and one of stage heights."""
    made = {}
    for name, stage, value in (("a", "forces", 1), ("b", "forces", 2), ("B2", "heights", 3)):
        made[name] = str(tmp_path / f"{name}.nc")
        storage.save(dataset(value), made[name], stage, {"value": value})
    return made


def job(stage, inputs, structure, output, **more):
    """A job as Snakemake describes it to a script."""

    class Named(dict):
        def __iter__(self):
            return iter(self.values())

    params = SimpleNamespace(module="here", stage=stage.name, inputs=structure, settings={"factor": 10})
    renamed = f"stiction_{stage.name}"  # by a workflow that uses this one as a module
    return SimpleNamespace(rule=renamed, input=inputs, output=Named(output), params=params, wildcards=Named(), **more)


def run(monkeypatch, stage, *described):
    monkeypatch.setattr(running, "stages_of", lambda module: (stage,))
    running.run(job(stage, *described))


def test_inputs_come_by_key_in_an_order_or_alone(files, tmp_path, monkeypatch):
    def compute(data, settings):
        seen.update(data)
        return dataset(settings["factor"] * data["all"]["b", 0.5].x[0])

    seen, stage = {}, Stage.writing("sums", "sums", message="", compute=compute)
    inputs = {"all": [files["a"], files["b"]], "row": [files["b"], files["a"]], "one": files["B2"], "text": "plain.csv"}
    inputs["named"] = files["B2"]
    structure = {
        "all": ["forces", [["a", 0.4], ["b", 0.5]]],
        "named": ["heights", ["B2"]],
        "row": ["forces", True],
        "one": ["heights", None],
        "text": [None, None],
        "none": [None, []],
    }
    run(monkeypatch, stage, inputs, structure, {"dataset": str(tmp_path / "sums.nc")})
    assert {key: float(one.x[0]) for key, one in seen["all"].items()} == {("a", 0.4): 1, ("b", 0.5): 2}
    assert [*seen["named"]] == ["B2"]
    assert [float(one.x[0]) for one in seen["row"]] == [2, 1]
    assert (float(seen["one"].x[0]), seen["text"], seen["none"]) == (3, "plain.csv", {})
    assert float(storage.load(tmp_path / "sums.nc", "sums").x[0]) == 20


def test_the_label_names_the_settings_of_the_job_and_of_every_dataset_that_it_read(files, tmp_path, monkeypatch):
    stage = Stage.writing("sums", "sums", message="", compute=lambda data, at, settings: data["one"], label="forces")
    inputs = {"one": files["B2"], "text": "plain.csv"}
    structure = {"one": ["heights", None], "text": [None, None]}
    run(monkeypatch, stage, inputs, structure, {"dataset": str(tmp_path / "sums.nc")})
    label = labels.read(tmp_path / "sums.nc")
    assert (label.stage, label.settings) == ("forces", {"factor": 10})
    assert label.before == {files["B2"]: {"value": 3}}


def test_a_dataset_of_another_stage_is_refused(files, tmp_path, monkeypatch):
    stage = Stage.writing("sums", "sums", message="", compute=lambda data, at, settings: data["one"])
    with pytest.raises(DataError, match="not spectrum of B2"):
        run(monkeypatch, stage, {"one": files["B2"]}, {"one": ["spectrum", None]}, {"dataset": str(tmp_path / "s.nc")})


def test_a_stage_with_ends_writes_its_datasets_in_their_order(files, tmp_path, monkeypatch):
    stage = Stage.writing(
        "two", "two_{each}", message="", each=lambda plan: plan, compute=lambda: [dataset(4), dataset(5)]
    )
    outputs = {end: str(tmp_path / f"two_{end}.nc") for end in ("less", "more")}
    run(monkeypatch, stage, {"one": files["B2"]}, {"one": ["heights", None]}, outputs)
    assert [float(storage.load(path, "two").x[0]) for path in outputs.values()] == [4, 5]


def test_a_caption_has_the_settings_of_its_job_and_what_the_figure_adds(files, tmp_path, monkeypatch):
    drawn = SimpleNamespace(get_label=lambda: "(1) Too wet.")
    shown = Shown(file="png", title="Sheet: {surface}", category="")
    (tmp_path / "sheet.rst").write_text("Times\n{{ snakemake.params.settings['factor'] }}.\n")
    stage = Stage(name="sheet", files={}, message="", compute=lambda *_: drawn, save=lambda *_: None, shown=shown)
    inputs = {"one": files["B2"], "caption": str(tmp_path / "sheet.rst")}
    described = job(stage, inputs, {"one": ["heights", None]}, {})
    described.output, described.wildcards = Outputs(txt=tmp_path / "sheet.txt"), {"surface": "B2"}
    monkeypatch.setattr(running, "stages_of", lambda module: (stage,))
    running.run(described)
    assert (tmp_path / "sheet.txt").read_text() == "Sheet: B2\n\nTimes 10.\n\n(1) Too wet.\n"


CAPTIONS = sorted((Path(__file__).parents[2] / "workflow" / "report").glob("*.rst"))
WITH_HUMIDITY = [path for path in CAPTIONS if '["humidity"]' in path.read_text(encoding="utf-8")]


@pytest.mark.parametrize("path", CAPTIONS, ids=lambda path: path.stem)
def test_names_in_the_caption_of_a_figure_are_no_part_of_its_template(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where the hostile template would make a folder
    params = SimpleNamespace(settings={"pair": HOSTILE, "humidity": 0.5, "moments": [HOSTILE]})
    config = paper() | {"pairs": {HOSTILE: {"beam": HOSTILE}}}
    figure = SimpleNamespace(params=params, config=config, wildcards=SimpleNamespace(surface=HOSTILE))
    caption = Template(path.read_text(encoding="utf-8")).render(snakemake=figure)
    shown = Reading(core.publish_parts(caption, writer="html", settings_overrides={"report_level": 5})["body"])
    assert shown.code == []
    assert not (tmp_path / MADE).exists()


@pytest.mark.parametrize("path", WITH_HUMIDITY, ids=lambda path: path.stem)
def test_no_caption_of_a_figure_in_dry_air_has_a_humidity(path):
    said = {}
    for stated, shown in ((0.0, 0.0), (0.0, "dry"), (0.65, 0.65)):
        params = SimpleNamespace(settings={"pair": "b", "humidity": stated})
        figure = SimpleNamespace(params=params, config={"figures": {"humidity": shown}})
        said[shown] = Template(path.read_text(encoding="utf-8")).render(snakemake=figure)
    assert said[0.0] == said["dry"]
    assert re.search(r"relative\s+humidity 0\.65", said[0.65])
    assert "0.0" not in said["dry"].replace("0.01", "")
    assert "dry air" in said["dry"]


class Outputs(dict):
    """Files of a job, which Snakemake also gives as attributes."""

    __getattr__ = dict.__getitem__


def test_what_is_no_dataset_is_written_by_the_stage_itself(files, monkeypatch):
    written = {}
    stage = Stage(
        name="page",
        files={"text": "page.txt"},
        message="",
        compute=lambda data, at, settings: "text",
        save=lambda result, paths: written.update({paths["text"]: result}),
    )
    run(monkeypatch, stage, {"one": files["B2"]}, {"one": ["heights", None]}, {"text": "page.txt"})
    assert written == {"page.txt": "text"}
