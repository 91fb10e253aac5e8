"""A bundle names a planner; a place on the organiser's disk is not a name."""

from __future__ import annotations

from typing import Any

import pytest

from crowdbot.core.bundle.check_planner import planner_problems

SHA = "a" * 64


@pytest.mark.parametrize(
    "planner",
    [
        {"kind": "dwa"},
        {"kind": "acme.go", "speed": 0.5},
        {"kind": "mine.py:Mine", "sha256": SHA},
        {"kind": "planner.yaml:my-planner", "sha256": SHA},
        {"kind": "dwa", "name": "dwa", "label": "dwa+1f3a+privileged"},
        {"kind": "mine.py:Mine", "sha256": SHA, "name": "Mine", "label": "Mine"},
        {"kind": "policy.onnx", "sha256": SHA, "name": "policy", "label": "policy"},
        {"kind": "teleop", "name": "Anna", "label": "Anna"},
        {"kind": "fleet", "robots": {"a": {"kind": "dwa"}, "b": {"kind": "m.py:M", "sha256": SHA}}},
    ],
)
def test_names_are_fine(planner: dict[str, Any]) -> None:
    assert list(planner_problems(planner)) == []


@pytest.mark.parametrize(
    "planner",
    [
        {},
        {"kind": ""},
        {"kind": 3},
        {"kind": "/srv/sent_along.yaml"},
        {"kind": "sent_along.yaml"},
        {"kind": "sent.py"},
        {"kind": "sent.py:Mine"},
        {"kind": "../sent.py:Mine", "sha256": SHA},
        {"kind": "a=/tmp/x.yaml"},
        {"kind": "a=dwa,b=dwa"},
        {"kind": "dwa\n"},
        {"kind": "mine.py:Mine", "sha256": "short"},
        {"kind": "fleet", "robots": {"a": {"kind": "/srv/x.yaml"}}},
        {"kind": "fleet", "robots": {"a": "dwa"}},
        {"kind": "fleet"} | {"robots": {"a": {"kind": "x.py:X"}}},
    ],
)
def test_places_are_not(planner: dict[str, Any]) -> None:
    assert list(planner_problems(planner))


@pytest.mark.parametrize(
    "planner",
    [
        {"kind": "mine.py:Mine", "sha256": SHA, "name": "dwa", "label": "dwa"},
        {"kind": "mine.py:Mine", "sha256": SHA, "name": "Mine", "label": "dwa"},
        {"kind": "mine.py:Mine", "sha256": SHA, "name": "Mine", "label": "Minery"},
        {"kind": "stand_still", "name": "dwa", "label": "dwa"},
        {"kind": "policy.onnx", "sha256": SHA, "name": "dwa", "label": "dwa"},
        {"kind": "fleet", "robots": {"a": {"kind": "stand_still", "name": "dwa"}}},
        {"kind": "mine.py:Mine", "sha256": SHA, "parameters": ["x"]},
    ],
)
def test_a_planner_does_not_pass_for_another_one(planner: dict[str, Any]) -> None:
    assert list(planner_problems(planner))
