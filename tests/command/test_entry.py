"""Entry of the command: estimates take their own way, and everything else is the whole command's."""

import sys

import pytest

from stiction.command import main as whole
from stiction.command.at_once import entry, estimate


@pytest.mark.parametrize(
    ("words", "way", "given"),
    [
        (["estimate", "--rms", "3"], "estimate", ["--rms", "3"]),
        (["check", "mine.yaml"], "whole", None),
        (["check", "estimate"], "whole", None),
        ([], "whole", None),
    ],
)
def test_only_estimates_take_their_own_way(monkeypatch, words, way, given):
    called = []
    monkeypatch.setattr(sys, "argv", ["stiction", *words])
    monkeypatch.setattr(estimate, "main", lambda words: called.append(("estimate", words)) or 4)
    monkeypatch.setattr(whole, "main", lambda: called.append(("whole", None)) or 5)
    assert entry.main() == (4 if way == "estimate" else 5)
    assert called == [(way, given)]
