"""A policy that goes on with a wider fan of velocities acts as before, at first."""

from __future__ import annotations

import sys
from typing import Any

import pytest

from tests.paths import ROOT

torch: Any = pytest.importorskip("torch", reason="torch is not installed")
pytest.importorskip("stable_baselines3", reason="Stable-Baselines3 is not installed")
pytest.importorskip("gymnasium", reason="the extra rl is not installed")


def test_directions_that_are_added_weigh_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    script: Any = __import__("train_ppo")
    sys.modules.pop("train_ppo")
    # Two speeds of three directions, then three more numbers; five directions afterwards.
    weight = torch.rand(4, 2 * 2 * 3 + 3)
    wider = script.widened(weight, 3, 5, 2)
    seen = torch.rand(2, 5, 2)
    rest = torch.rand(3)
    ours = wider @ torch.cat([seen.flatten(), rest])
    before = weight @ torch.cat([seen[:, 1:4].flatten(), rest])
    assert torch.allclose(ours, before)
