"""A session drives several robots at once."""

from __future__ import annotations

from pathlib import Path

import pytest

import crowdbot
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.provenance import trajectory_hash
from crowdbot.core.sim.session import Session
from tests.core.sim.fleets import PEOPLE, robot, run, scenario

TWO = {"a": robot(-6.0, 0.5, 0.0, "east", 1.0), "b": robot(6.0, 0.0, 180.0, "west", 2.0)}


@pytest.mark.slow
def test_the_same_logic_gives_the_same_trajectories(tmp_path: Path) -> None:
    """Each robot by its own planner, whose robot sees the other one and people."""
    registry = discover()
    made = scenario(tmp_path, registry, TWO, PEOPLE)
    expected = run(made, registry, tmp_path / "runs", planner="dwa", seed=3)
    choice = resolve_planner("dwa", registry)
    planners = {name: choice.build() for name in TWO}
    file = tmp_path / "run.mcap"
    with Session(made, seed=3, sensors=choice.needs, recording=file) as session:
        seen = session.reset_all()
        for name, one in session.robots.items():
            planners[name].reset(one.task, one.limits, one.sensors, one.planner_seed)
        while not session.done:
            seen = session.step_all({name: planners[name].step(seen[name]) for name in seen})
            assert session.going_on in (("a", "b"), ("b",), ())
    assert session.t == 2.0
    assert session.statuses == {"a": "timeout", "b": "timeout"}
    for name in TWO:
        mine = session.trajectories_of(name)
        theirs = Recording(expected.directory / "run.mcap").trajectories(name)
        assert trajectory_hash(mine) == trajectory_hash(theirs)


def test_what_is_asked_of_the_wrong_number_of_robots_is_refused(tmp_path: Path) -> None:
    registry = discover()
    session = Session(scenario(tmp_path, registry, TWO), sensors=[], registry=registry)
    with pytest.raises(
        crowdbot.CrowdbotError, match=r"Session.reset is for one, Session.reset_all"
    ):
        session.reset()
    with pytest.raises(crowdbot.CrowdbotError, match=r"Session.task is for one, Session.robots"):
        _ = session.task
    seen = session.reset_all()
    assert [*seen] == ["a", "b"]
    assert seen["a"].pose != seen["b"].pose
    for commands, expected in (
        ({"a": (0.1, 0.0)}, "robot 'b' goes on and has no command"),
        ({"a": (0.1, 0.0), "b": (0.1, 0.0), "c": (0.1, 0.0)}, "no robot 'c'; there are a, b"),
        ({"a": (0.1, 0.0), "b": "go"}, "a command is"),
        ([(0.1, 0.0)], "commands are a dict"),
    ):
        with pytest.raises(crowdbot.CrowdbotError, match=expected):
            session.step_all(commands)  # type: ignore[arg-type]
    assert {obs.t for obs in session.step_all({"a": (0.1, 0.0), "b": (0.2, 0.0)}).values()} == {
        0.0625
    }
    session.close()
    assert session.status == "interrupted"
    assert session.statuses == {"a": "interrupted", "b": "interrupted"}
