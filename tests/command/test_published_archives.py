"""Archives that a container is not: drawn damage, bombs and slow servers end in one sentence and leave no file."""

import io
import os
import random
import shutil
import time
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
import pytest
import yaml
from hostile import places
from server import OK, page, server
from topographies import SurfaceTopography

from stiction.command import container, main, published
from stiction.command.last_lines import FAULT, Status
from stiction.config import files
from stiction.config.messages import schema_problems
from stiction.config.relations import schema
from stiction.scans import published as containers
from stiction.scans.reading import read

#: What a place in metadata can hold instead of what it should.
ODD = [None, 5, -1.0, True, "", "x" * 3000, "a\nb: [", "\x1b[31m\x00", [], {}, ["a"], {"name": 1}, [[[]]], "2020-01-01"]


def sound():
    """Files of a sound container of two surfaces, by name, without its metadata."""
    heights = 3e-3 * np.random.default_rng(1).standard_normal((48, 36))
    stored = {}
    for name in ("a.nc", "b.nc"):
        path = Path(f"{name}.draft")
        SurfaceTopography.Topography(heights, (4.8, 3.6), unit="µm").to_netcdf(str(path))
        stored[name] = path.read_bytes()
        path.unlink()
    return stored


def metadata():
    """Metadata of the container."""
    maps = [
        {"name": file, "datafile": {"squeezed-netcdf": file}, "size": [4.8, 3.6], "unit": "µm"}
        for file in ("a.nc", "b.nc")
    ]
    return {"surfaces": [{"name": "Si", "topographies": [maps[0]]}, {"name": "Au", "topographies": [maps[1]]}]}


def archived(stored, text):
    """Content of an archive."""
    packed = io.BytesIO()
    with ZipFile(packed, "w", ZIP_DEFLATED) as archive:
        archive.writestr("meta.yml", text)
        for name, content in stored.items():
            archive.writestr(name, content)
    return packed.getvalue()


def with_odd(draw):
    """Metadata with an odd value at a drawn place, and sometimes without the place."""
    changed = metadata()
    *above, last = draw.choice([path for path in places(changed) if path])
    parent = changed
    for key in above:
        parent = parent[key]
    if draw.random() < 0.2:
        del parent[last]
    else:
        parent[last] = draw.choice(ODD)
    return changed


def drawn(number):
    """Drawn archives: odd metadata, odd files, damaged bytes."""
    draw, stored = random.Random(number), sound()
    if number % 3 == 0:
        return archived(stored, yaml.safe_dump(with_odd(draw)))
    content = bytearray(archived(stored, yaml.safe_dump(metadata())))
    if number % 3 == 1:
        for _ in range(draw.randint(1, 30)):
            content[draw.randrange(len(content))] = draw.randrange(256)
        return bytes(content)
    name, damaged = draw.choice(list(stored)), bytearray(stored["a.nc"])
    for _ in range(draw.randint(1, 200)):
        damaged[draw.randrange(min(600, len(damaged)))] = draw.randrange(256)
    return archived(stored | {name: bytes(damaged[: draw.randrange(len(damaged))])}, yaml.safe_dump(metadata()))


def outcome(folder, capsys, source="archive.zip"):
    """Status of the command and its only sentence; a refusal leaves no file, and stiction accepts a study."""
    before = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    status = main.main(["published", source, "--directory", str(folder)])
    said = capsys.readouterr()
    assert FAULT not in said.err
    assert len((said.out + said.err).splitlines()) == 1
    after = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    if status == Status.DONE:
        config = files.joined(str(folder / "published.yaml"))
        assert not schema_problems(config, schema())
        assert all(read(path).scan.heights.size for path in folder.glob("*.nc"))
    else:
        assert (status, after) == (Status.REFUSED, before)
    return status, said.out + said.err


@pytest.mark.slow
@pytest.mark.parametrize("kind", range(3))
def test_drawn_archives_give_a_study_or_one_sentence(tmp_path, monkeypatch, capsys, kind):
    monkeypatch.chdir(tmp_path)
    seen = set()
    for number in range(kind, 120, 3):
        Path("archive.zip").write_bytes(drawn(number))
        folder = tmp_path / f"new{number}"
        seen.add(outcome(folder, capsys)[0])
        seen |= {len(list(folder.glob("*.nc")))} if folder.is_dir() else set()
    assert {Status.DONE, 1} <= seen, "some draws are sound, and of some a map is damaged"


#: Each alias repeats nine others: 9^9 entries in a few lines.
LAUGHS = "a0: &a0 [0]\n" + "".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 10))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (LAUGHS + "surfaces: [{name: a, topographies: [], more: *a9}]", "has more than 500000 entries in meta.yml"),
        ("surfaces: &a [{name: a, topographies: *a}]", "has more than 500000 entries"),
        ("[" * 10**6, "is no container of contact.engineering, or damaged"),
        ("x" * 6 * 2**20, "has more than 5 MiB in meta.yml"),
    ],
    ids=["aliases", "cycle", "nested", "long"],
)
def test_metadata_that_expand_without_end_are_refused(tmp_path, monkeypatch, capsys, text, said):
    monkeypatch.chdir(tmp_path)
    Path("archive.zip").write_bytes(archived(sound(), text))
    began = time.process_time()
    assert said in outcome(tmp_path / "new", capsys)[1]
    assert time.process_time() - began < 5


def test_aliases_of_moderate_metadata_are_read(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    shared = metadata()
    shared["surfaces"][0]["topographies"] *= 2  # safe_dump writes an alias
    assert "*id001" in yaml.safe_dump(shared)
    Path("archive.zip").write_bytes(archived(sound(), yaml.safe_dump(shared)))
    assert outcome(tmp_path / "new", capsys)[0] == Status.DONE
    assert len(list((tmp_path / "new").glob("*.nc"))) == 3


def test_an_archive_that_unpacks_without_limit_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(containers, "LARGEST_FILES", 1)
    Path("archive.zip").write_bytes(archived(sound() | {"zeros": bytes(2**20)}, yaml.safe_dump(metadata())))
    assert Path("archive.zip").stat().st_size < 10**5
    assert "holds more than 1 MiB" in outcome(tmp_path / "new", capsys)[1]


@pytest.mark.parametrize("how", ["external", "virtual", "link"])
def test_a_map_that_reads_other_files_is_refused(tmp_path, monkeypatch, capsys, how):
    h5py = pytest.importorskip("h5py")
    monkeypatch.chdir(tmp_path)
    Path("secret").write_bytes(np.arange(48.0 * 36).tobytes())
    with h5py.File("a.h5", "w") as file:
        if how == "external":
            file.create_dataset("z", (48, 36), "f8", external=[("secret", 0, 48 * 36 * 8)])
        elif how == "virtual":
            layout = h5py.VirtualLayout((48, 36), "f8")
            layout[:] = h5py.VirtualSource("secret", "z", (48, 36))
            file.create_virtual_dataset("z", layout)
        else:
            file.create_group("group")["z"] = h5py.ExternalLink("secret", "z")
    stored = sound() | {"a.nc": Path("a.h5").read_bytes()}
    Path("archive.zip").write_bytes(archived(stored, yaml.safe_dump(metadata())))
    assert "holds a.nc, which reads files outside of it" in outcome(tmp_path / "new", capsys)[1]


def endless(request):
    """Send a container without end."""
    if not page(request):
        request.wfile.write(OK)
        while True:
            request.wfile.write(bytes(2**16))


def endless_page(request):
    """Send a page without end."""
    request.wfile.write(OK + b"[")
    while True:
        request.wfile.write(b"1," * 2**15)


def slow(request):
    """Send a container byte by byte."""
    if not page(request):
        request.wfile.write(OK)
        slowly(request)


def slow_head(request):
    """Send the head of an answer byte by byte."""
    request.wfile.write(b"HTTP/1.0 200 OK\r\nA: ")
    slowly(request)


def slowly(request):
    """Send single bytes for a minute."""
    for _ in range(600):
        request.wfile.write(b"a")
        request.wfile.flush()
        time.sleep(0.1)


def in_circles(request):
    """Send to the same page again."""
    request.wfile.write(b"HTTP/1.0 302 Found\r\nLocation: /go/abc\r\n\r\n")


@pytest.mark.parametrize(
    ("send", "said"),
    [
        (endless, "sends more than 1 MiB"),
        (endless_page, "sends more than 1 MiB"),
        (slow, "it takes more than 0.5 s"),
        (slow_head, "it takes more than 0.5 s"),
        (in_circles, "TooManyRedirects"),
    ],
)
def test_a_server_without_end_is_left(tmp_path, monkeypatch, capsys, send, said):
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    monkeypatch.setattr(container, "LARGEST", 1)
    if "takes" in said:
        monkeypatch.setattr(container, "LONGEST", 0.5)
    began = time.monotonic()
    with server(send) as address:
        assert said in outcome(tmp_path / "new", capsys, address)[1]
    assert time.monotonic() - began < 20


def write(name="archive.zip"):
    """Write a sound archive, and return its name."""
    Path(name).write_bytes(archived(sound(), yaml.safe_dump(metadata())))
    return name


@pytest.mark.parametrize("line_break", ["\n", "\r", "\x85", "\u2028"])
def test_a_source_is_a_comment_of_the_study_whatever_its_name(tmp_path, monkeypatch, capsys, line_break):
    monkeypatch.chdir(tmp_path)
    name = write(f"a{line_break}seed: 7 #.zip")
    assert outcome(tmp_path / "new", capsys, name)[0] == Status.DONE
    assert set(yaml.safe_load((tmp_path / "new" / "published.yaml").read_text(encoding="utf-8"))) == {"surfaces"}


def test_a_source_that_is_no_file_is_not_waited_for(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    for source in ("pipe", ".", "a\0b"):
        assert outcome(tmp_path / "new", capsys, source)[0] == Status.REFUSED


@pytest.mark.parametrize("name", ["published.yaml", "Si_1.nc", "Au_1.nc"])
@pytest.mark.parametrize("kind", ["link", "folder", "file"])
def test_nothing_is_written_over_or_through(tmp_path, monkeypatch, capsys, name, kind):
    monkeypatch.chdir(tmp_path)
    write()
    target, outside = tmp_path / "new" / name, tmp_path / "outside"
    target.parent.mkdir()
    {"link": lambda: target.symlink_to(outside), "folder": target.mkdir, "file": target.touch}[kind]()
    assert "exists already: nothing was written" in outcome(tmp_path / "new", capsys)[1]
    assert not outside.exists()


@pytest.mark.parametrize("number", range(3))
def test_a_process_that_is_killed_between_two_files_does_not_block_the_next(tmp_path, monkeypatch, capsys, number):
    monkeypatch.chdir(tmp_path)
    write()
    whole, moves, replace = tmp_path / "whole", [], Path.replace
    published.written("archive.zip", whole)

    def stop(path, target):
        moves.append(target)
        if len(moves) > number:
            raise SystemExit
        return replace(path, target)

    with monkeypatch.context() as killed:
        killed.setattr(Path, "replace", stop)
        killed.setattr(shutil, "rmtree", lambda *_, **__: None)
        with pytest.raises(SystemExit):
            published.written("archive.zip", tmp_path / "new")
    assert not (tmp_path / "new" / "published.yaml").exists()
    assert outcome(tmp_path / "new", capsys)[0] == Status.DONE
    contents = [{path.name: path.read_bytes() for path in folder.iterdir()} for folder in (tmp_path / "new", whole)]
    assert contents[0] == contents[1]
