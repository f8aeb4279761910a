"""Results that planning keeps between runs."""

from types import SimpleNamespace

import pytest

from stiction.run import disk_cache
from stiction.run import fingerprint as fingerprints
from stiction.run.disk_cache import DiskCache, SharedCache
from stiction.run.fingerprint import fingerprint


def never():
    pytest.fail("computed although it is known")


def test_a_result_is_computed_once_for_equal_arguments_and_again_for_others(tmp_path):
    remember = DiskCache(tmp_path / "kept.json")
    assert remember({"b": 1, "a": [2]}, lambda: "first") == "first"
    assert remember({"a": [2], "b": 1}, never) == "first"
    assert remember({"a": [3], "b": 1}, lambda: "second") == "second"


def test_a_result_is_the_same_whether_it_is_computed_or_known(tmp_path):
    for _ in range(2):
        remember = DiskCache(tmp_path / "kept.json")
        assert repr(remember("a", lambda: {"x": (1, 2.5), 3: None})) == "{'x': [1, 2.5], '3': None}"
        remember.save()


def test_the_next_run_knows_the_results_that_were_used_and_no_others(tmp_path):
    path = tmp_path / "folder" / "kept.json"
    for used in (["a", "b"], ["b"]):
        remember = DiskCache(path)
        for key in used:
            remember(key, lambda key=key: key.upper())
        remember.save()
    last = DiskCache(path)
    assert last("b", never) == "B"
    assert last("a", lambda: "computed again") == "computed again"


def test_an_error_is_not_kept(tmp_path):
    remember = DiskCache(tmp_path / "kept.json")
    with pytest.raises(ZeroDivisionError):
        remember("a", lambda: 1 / 0)
    assert remember("a", lambda: 2) == 2


@pytest.mark.parametrize("content", ["", "{", "[1]", "null"])
def test_a_damaged_file_counts_as_empty(tmp_path, content):
    path = tmp_path / "kept.json"
    path.write_text(content)
    remember = DiskCache(path)
    assert remember("a", lambda: 1) == 1
    remember.save()
    assert DiskCache(path)("a", never) == 1


def test_a_file_that_cannot_be_written_stops_nothing(tmp_path):
    (tmp_path / "file").touch()
    remember = DiskCache(tmp_path / "file" / "kept.json")
    remember("a", lambda: 1)
    remember.save()


def test_fingerprints_are_the_same_with_and_without_memory_and_follow_the_content(tmp_path):
    script, kept = tmp_path / "script.py", tmp_path / "kept.json"
    found = []
    for text in ("import stiction.streams\n", "import stiction.streams\nx = 1\n"):
        script.write_text(text)
        for _ in range(2):
            remember = DiskCache(kept)
            found.append(fingerprint(script, remember))
            remember.save()
        assert found[-1] == found[-2] == fingerprint(script)
    assert found[0]["script.py"] != found[2]["script.py"]
    assert found[0]["stiction.streams"] == found[2]["stiction.streams"]


def test_one_version_of_python_does_not_read_what_another_one_kept(tmp_path, monkeypatch):
    script, found = tmp_path / "script.py", []
    script.write_text("x = 1\n")
    for tag, hashed in (("one", "a"), ("one", "read from the file"), ("two", "b")):
        monkeypatch.setattr(fingerprints, "sys", SimpleNamespace(implementation=SimpleNamespace(cache_tag=tag)))
        monkeypatch.setattr(fingerprints, "_parsed", lambda _, hashed=hashed: [hashed, []])
        remember = DiskCache(tmp_path / "kept.json")
        found.append(fingerprint(script, remember)["script.py"])
        remember.save()
    assert found == ["a", "a", "b"]


def test_what_one_folder_knows_another_one_knows_and_so_does_another_machine(tmp_path, monkeypatch):
    for machine, folder in (("one", "a"), ("one", "b"), ("two", "b"), ("two", "c")):
        monkeypatch.setattr(disk_cache, "own_folder", lambda machine=machine: tmp_path / machine)
        remember = SharedCache(tmp_path / folder / "kept.json")
        assert remember("key", never if (machine, folder) != ("one", "a") else lambda: (1, 2)) == [1, 2]
        remember.save()
    monkeypatch.setattr(disk_cache, "own_folder", lambda: tmp_path / "three")
    assert SharedCache(tmp_path / "d" / "kept.json")("key", lambda: "computed") == "computed"  # control


@pytest.mark.parametrize("unused", [0, 1, 5])
def test_the_latest_results_that_a_process_does_not_use_are_kept(tmp_path, unused):
    path = tmp_path / "kept.json"
    for key in "abc":
        remember = DiskCache(path, unused)
        remember(key, lambda key=key: key)
        remember.save()
    remember, computed = DiskCache(path), []
    for key in "abc":
        remember(key, lambda key=key: computed.append(key))
    assert computed == list("abc")[: max(2 - unused, 0)]
