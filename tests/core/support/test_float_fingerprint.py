"""The fingerprint of rounding: the same in every process of one machine, and of every thread."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

from crowdbot.core.runs import provenance
from crowdbot.core.support import float_fingerprint as rounding
from crowdbot.core.support.float_fingerprint import fingerprint


def test_it_is_the_same_in_another_process() -> None:
    code = "from crowdbot.core.support.float_fingerprint import fingerprint; print(fingerprint())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == fingerprint()


def test_a_last_digit_changes_it(monkeypatch: pytest.MonkeyPatch) -> None:
    before = fingerprint()
    monkeypatch.setattr(np, "exp", lambda x: np.nextafter(np.power(math.e, x), np.inf))
    rounding.fingerprint.cache_clear()
    try:
        assert fingerprint() != before
    finally:
        monkeypatch.undo()
        rounding.fingerprint.cache_clear()
    assert fingerprint() == before


def test_runs_record_it() -> None:
    assert provenance.machine()["rounding"] == fingerprint()
    assert len(fingerprint()) == 16
