"""Standard simulator services for ROS 2, as far as applicable.

Source: https://github.com/ros-simulation/simulation_interfaces, version 2.1.0.
"""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable

from crowdbot.core.live.services import Service, Values, steps_taken, whole
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.simulation_types import PACKAGE, SERVICES
from crowdbot.core.recording.messages import half_turn
from crowdbot.core.recording.namespace import in_namespace
from crowdbot.errors import InputError

UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, FAILED = 0, 1, 2, 3, 4
#: Result code of LoadWorld: neither a resource nor a text is given.
NO_RESOURCE = 102
STOPPED, PLAYING, PAUSED, QUITTING = 0, 1, 2, 3
#: Supported SimulatorFeatures: entity state; reset; simulation state (get, set, pause); single and
#: multiple steps; worlds (load, get, list).
FEATURES = (10, 20, 24, 25, 26, 31, 32, 40, 43, 44)
#: Scopes of a reset: default, time, state, spawned entities, all. Partial resets are not supported.
_WHOLE = (0, 255)
#: Longest pattern of a single name.
_LONGEST_FILTER = 100
Call = Callable[[Values], Awaitable[Values]]


def simulation_services(session: LiveSession) -> dict[str, Service]:
    """Return the services, by name."""
    calls = {**_course(session), **_entities(session), **_worlds(session)}
    return {f"/{_snake(name)}": _service(name, call) for name, call in calls.items()}


def _course(session: LiveSession) -> dict[str, Call]:
    """Return the services for running a simulation."""

    async def reset(values: Values) -> Values:
        if whole(values, "scope", 0, 255, default=0) not in _WHOLE:
            return _result(UNSUPPORTED, "only the whole simulation can be reset")
        session.ask_for("reset")
        return _result(OK)

    async def step(values: Values) -> Values:
        if not session.paused:
            return _result(INCORRECT_STATE, "steps are taken while the simulation is paused")
        await steps_taken(session, whole(values, "steps", 1, 10**6, default=1))
        return _result(OK)

    async def get_state(values: Values) -> Values:
        del values
        return {"state": {"state": _state(session)}, **_result(OK)}

    async def set_state(values: Values) -> Values:
        state = whole(_inside(values, "state"), "state", 0, 255)
        if state not in (PLAYING, PAUSED):
            return _result(UNSUPPORTED, "the simulation can be playing or paused")
        session.pause(state == PAUSED)
        return _result(OK)

    async def features(values: Values) -> Values:
        del values
        found = {"features": list(FEATURES), "spawn_formats": [], "custom_info": "crowdbot"}
        return {"features": found}

    return {
        "ResetSimulation": reset,
        "StepSimulation": step,
        "GetSimulationState": get_state,
        "SetSimulationState": set_state,
        "GetSimulatorFeatures": features,
    }


def _entities(session: LiveSession) -> dict[str, Call]:
    """Return the services for entities: the robots' own knowledge, and no data about people."""

    async def entities(values: Values) -> Values:
        return {**_result(OK), "entities": _found(session, values)}

    async def states(values: Values) -> Values:
        found = _found(session, values)
        states = [_entity_state(session, name) for name in found]
        return {**_result(OK), "entities": found, "states": states}

    async def entity_state(values: Values) -> Values:
        name = values.get("entity", "")
        if name not in [robot.name for robot in session.here]:
            return _result(NOT_FOUND, f"no entity '{str(name)[:80]}'; people are not told")
        return {**_result(OK), "state": _entity_state(session, str(name))}

    return {
        "GetEntities": entities,
        "GetEntityState": entity_state,
        "GetEntitiesStates": states,
        "SpawnEntity": _never("the scenario says who is there; nothing can be spawned"),
        "DeleteEntity": _never("the scenario defines the entities; they cannot be deleted"),
        "SetEntityState": _never("the robot is moved by commands alone, people by their policies"),
    }


def _never(why: str) -> Call:
    """Return a service that only reports why it is not supported, so that clients do not wait."""

    async def answer(values: Values) -> Values:
        del values
        return _result(UNSUPPORTED, why)

    return answer


def _found(session: LiveSession, values: Values) -> list[str]:
    """Return the names of entities that match a request's filter."""
    pattern = _inside(values, "filters").get("filter", "")
    if not isinstance(pattern, str) or len(pattern) > _LONGEST_FILTER:
        raise InputError("'filter' must be a text of at most 100 characters")
    try:
        return [robot.name for robot in session.here if re.search(pattern, robot.name)]
    except re.error as error:
        raise InputError(f"'filter' is not a regular expression: {error}") from error


def _worlds(session: LiveSession) -> dict[str, Call]:
    """Return the services for worlds, which are a suite's scenarios."""

    async def available(values: Values) -> Values:
        if _inside(values, "filter").get("tags"):
            return _result(UNSUPPORTED, "scenarios have no tags")
        return {**_result(OK), "worlds": [_world(name) for name in session.scenarios]}

    async def current(values: Values) -> Values:
        del values
        return {**_result(OK), "world": _world(session.scenario)}

    async def load(values: Values) -> Values:
        resource = _inside(values, "world_resource")
        name = resource.get("uri", "")
        if not name:
            text = "'uri' is the id of a scenario; a world cannot be given as text"
            return _result(UNSUPPORTED if resource.get("resource_string") else NO_RESOURCE, text)
        if name not in session.scenarios:
            return _result(NOT_FOUND, f"no scenario '{str(name)[:80]}' in the suite")
        session.load(name)
        return {**_result(OK), "world": _world(name)}

    return {
        "GetAvailableWorlds": available,
        "GetCurrentWorld": current,
        "LoadWorld": load,
        "UnloadWorld": _never("there always is a scenario; load another one"),
    }


def _snake(name: str) -> str:
    return re.sub(r"(?<!^)([A-Z])", r"_\1", name).lower()


def _service(name: str, call: Call) -> Service:
    """Return a service that reports errors as results, as its type defines."""

    async def answer(values: Values) -> Values:
        try:
            return await call(values)
        except InputError as error:
            return _result(FAILED, str(error))

    request, response = SERVICES[name]
    kind = f"{PACKAGE}/srv/{name}"
    return Service(kind=kind, request=request, response=response, call=answer)


def _inside(values: Values, name: str) -> Values:
    """Return an object field; empty if it is not an object."""
    found = values.get(name)
    return dict(found) if isinstance(found, dict) else {}


def _result(code: int, text: str = "") -> Values:
    return {"result": {"result": code, "error_message": text}}


def _world(scenario: str) -> Values:
    return {
        "name": scenario,
        "world_resource": {"uri": scenario, "resource_string": ""},
        "description": "",
        "tags": [],
    }


def _entity_state(session: LiveSession, name: str) -> Values:
    """Return pose and twist by odometry in the frame ``odom``; accelerations are unknown."""
    space, robot = next((s, r) for s, r in session.robots.items() if r.name == name)
    x, y, yaw = robot.pose
    v, w, vy = robot.twist
    z, turn = half_turn(yaw)
    sec, nanosec = divmod(round(session.t * 1e9), 10**9)
    nothing = {"x": 0.0, "y": 0.0, "z": 0.0}
    return {
        "header": {
            "stamp": {"sec": sec, "nanosec": nanosec},
            "frame_id": in_namespace(space, "odom"),
        },
        "pose": {
            "position": {"x": x, "y": y, "z": 0.0},
            "orientation": {"x": 0.0, "y": 0.0, "z": z, "w": turn},
        },
        "twist": {"linear": {"x": v, "y": vy, "z": 0.0}, "angular": {**nothing, "z": w}},
        "acceleration": {"linear": nothing, "angular": nothing},
    }


def _state(session: LiveSession) -> int:
    if session.paused:
        return PAUSED
    return PLAYING if session.state in ("waiting", "running", "paused") else STOPPED
