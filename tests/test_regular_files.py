"""Only regular files are read: others may never end."""

import os

import pytest

from stiction.regular_files import require_regular


def test_a_regular_file_is_accepted_and_a_missing_one_is_reported_as_such(tmp_path):
    path = tmp_path / "file"
    path.touch()
    require_regular(path)
    with pytest.raises(FileNotFoundError):
        require_regular(tmp_path / "missing")


@pytest.mark.parametrize(("make", "words"), [(os.mkdir, "it is a folder"), (os.mkfifo, "it is a pipe")])
def test_what_is_no_regular_file_is_named(make, words, tmp_path):
    path = tmp_path / "other"
    make(path)
    with pytest.raises(OSError, match=f"{words}, must be a regular file"):
        require_regular(path)


def test_devices_and_names_with_a_null_character_are_refused():
    with pytest.raises(OSError, match="it is a device"):
        require_regular("/dev/zero")
    with pytest.raises(OSError, match="null character"):
        require_regular("a\0b")
