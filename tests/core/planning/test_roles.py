"""Roles: which planners are floors, baselines and ceilings, and who may say so."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.planning.resolve import kinds_of_role, resolve_planner
from crowdbot.core.registry.registry import discover
from crowdbot.errors import InputError

REGISTRY = discover(allow=())

PLANNER = """
class Mine:
    role = {role!r}
    def __init__(self, gain: float = 1.0): pass
    def reset(self, task, limits, sensors, seed): pass
    def step(self, obs): return 0.0, 0.0
"""


def test_the_roles_of_those_that_come_along() -> None:
    assert kinds_of_role("floor", REGISTRY) == [
        "goal_seek", "stand_still", "stop_and_go", "wall_hug",
    ]  # fmt: skip
    assert kinds_of_role("baseline", REGISTRY) == ["dwa"]
    assert kinds_of_role("ceiling", REGISTRY) == ["oracle"]
    assert len(kinds_of_role("adversary", REGISTRY)) == 15


def test_the_ceiling_says_that_it_knows() -> None:
    assert resolve_planner("oracle", REGISTRY).label == "oracle+privileged"


def test_with_other_parameters_it_is_an_candidate_like_any_other() -> None:
    assert resolve_planner("goal_seek", REGISTRY).role == "floor"
    assert resolve_planner("goal_seek", REGISTRY, ["speed=0.5"]).role == "candidate"
    assert resolve_planner("goal_seek", REGISTRY, ["speed=1"]).role == "floor"


def test_a_file_may_declare_one(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(PLANNER.format(role="floor"))
    assert resolve_planner(f"{file}:Mine", REGISTRY).role == "floor"
    assert resolve_planner(f"{file}:Mine", REGISTRY, ["gain=2"]).role == "candidate"


def test_a_wrong_role_is_named_with_the_nearest(tmp_path: Path) -> None:
    file = tmp_path / "wrong.py"
    file.write_text(PLANNER.format(role="flooor"))
    with pytest.raises(InputError, match=r"no role 'flooor'; did you mean 'floor'"):
        resolve_planner(f"{file}:Mine", REGISTRY)
