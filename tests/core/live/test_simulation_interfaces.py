"""The standard services of simulators: what they answer, and what they do."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.simulation_interfaces import simulation_services
from crowdbot.core.types.ending import Ending


def _call(session: LiveSession, name: str, values: dict[str, Any] | None = None) -> dict[str, Any]:
    service = simulation_services(session)[name]

    async def wait() -> dict[str, Any]:
        return await service.call(values or {})

    answer = asyncio.run(wait())
    assert set(answer) <= set(service.response)
    return answer


def _code(answer: dict[str, Any]) -> int:
    return int(answer["result"]["result"])


def test_the_state_can_be_set_and_read() -> None:
    session = LiveSession()
    assert _code(_call(session, "/set_simulation_state", {"state": {"state": 2}})) == 1
    assert session.paused
    assert _call(session, "/get_simulation_state")["state"] == {"state": 2}
    _call(session, "/set_simulation_state", {"state": {"state": 1}})
    assert not session.paused
    assert _call(session, "/get_simulation_state")["state"] == {"state": 1}
    session.finish("arrived")
    assert _call(session, "/get_simulation_state")["state"] == {"state": 0}


@pytest.mark.parametrize("scope", [0, 255])
def test_a_reset_is_of_the_whole(scope: int) -> None:
    session = LiveSession()
    assert _code(_call(session, "/reset_simulation", {"scope": scope})) == 1
    assert session.take_request() == "reset"


def test_what_is_not_possible_is_told() -> None:
    session = LiveSession()
    assert _code(_call(session, "/reset_simulation", {"scope": 2})) == 0
    assert session.take_request() == ""
    assert _code(_call(session, "/set_simulation_state", {"state": {"state": 3}})) == 0
    assert _code(_call(session, "/set_simulation_state", {"state": "x"})) == 4
    assert _code(_call(session, "/step_simulation", {"steps": 1})) == 3
    session.pause(True)
    assert _code(_call(session, "/step_simulation", {"steps": -1})) == 4
    session.finish(Ending.TIMEOUT)
    assert _code(_call(session, "/step_simulation", {"steps": 1})) == 4


def test_features_are_listed() -> None:
    found = _call(LiveSession(), "/get_simulator_features")["features"]
    assert found["features"] == [10, 20, 24, 25, 26, 31, 32, 40, 43, 44]


def test_entities_are_the_robot_alone() -> None:
    robot = LiveRobot(name="robot")
    session = LiveSession(robots={"": robot})
    assert _call(session, "/get_entities")["entities"] == ["robot"]
    assert _call(session, "/get_entities", {"filters": {"filter": "^rob"}})["entities"] == ["robot"]
    assert _call(session, "/get_entities", {"filters": {"filter": "x"}})["entities"] == []
    assert _code(_call(session, "/get_entities", {"filters": {"filter": "("}})) == 4
    robot.pose, robot.twist, session.t = (1.0, 2.0, 0.0), (0.5, 0.1, 0.0), 1.5
    answer = _call(session, "/get_entity_state", {"entity": "robot"})
    assert answer["state"]["pose"]["position"] == {"x": 1.0, "y": 2.0, "z": 0.0}
    assert answer["state"]["header"]["stamp"] == {"sec": 1, "nanosec": 500_000_000}
    assert _code(_call(session, "/get_entity_state", {"entity": "person"})) == 2
    assert _code(_call(session, "/spawn_entity", {"name": "x"})) == 0


def test_entities_are_all_robots_of_the_run() -> None:
    robots = {"": LiveRobot(), "a": LiveRobot(name="a"), "b": LiveRobot(name="b", pose=(3, 0, 0))}
    session = LiveSession(robots=robots)
    assert _call(session, "/get_entities")["entities"] == ["a", "b"]
    state = _call(session, "/get_entity_state", {"entity": "b"})["state"]
    assert state["header"]["frame_id"] == "b/odom"
    assert state["pose"]["position"]["x"] == 3
    assert _code(_call(session, "/get_entity_state", {"entity": ""})) == 2


def test_worlds_are_the_scenarios() -> None:
    session = LiveSession(scenarios=["one", "two"], scenario="one")
    worlds = _call(session, "/get_available_worlds")["worlds"]
    assert [w["world_resource"]["uri"] for w in worlds] == ["one", "two"]
    assert _call(session, "/get_current_world")["world"]["name"] == "one"
    assert _code(_call(session, "/load_world", {"world_resource": {"uri": "none"}})) == 2
    assert _code(_call(session, "/load_world", {})) == 102
    assert session.take_request() == ""
    assert _code(_call(session, "/load_world", {"world_resource": {"uri": "two"}})) == 1
    assert (session.take_request(), session.requested) == ("load", "two")


def test_states_are_listed_for_who_fits_the_filter() -> None:
    session = LiveSession(robots={"": LiveRobot(name="robot", pose=(1.0, 2.0, 0.0))}, t=1.5)
    found = _call(session, "/get_entities_states")
    assert found["entities"] == ["robot"]
    (state,) = found["states"]
    assert state == _call(session, "/get_entity_state", {"entity": "robot"})["state"]
    none = _call(session, "/get_entities_states", {"filters": {"filter": "person"}})
    assert (none["entities"], none["states"]) == ([], [])
    assert _code(_call(session, "/get_entities_states", {"filters": {"filter": "("}})) == 4


@pytest.mark.parametrize(
    "name", ["/spawn_entity", "/delete_entity", "/set_entity_state", "/unload_world"]
)
def test_what_a_scenario_decides_cannot_be_changed(name: str) -> None:
    session = LiveSession(robots={"": LiveRobot(name="robot")})
    answer = _call(session, name, {"entity": "robot"})
    assert _code(answer) == 0
    assert answer["result"]["error_message"]
    assert session.take_request() == ""
