"""The standard services of simulators for ROS 2, as far as they make sense here.

Source: https://github.com/ros-simulation/simulation_interfaces, version 2.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from crowdbot.core.live.services import Fields, Service, Values, steps_taken, whole
from crowdbot.core.live.session import LiveSession
from crowdbot.errors import InputError

PACKAGE = "simulation_interfaces"
UNSUPPORTED, OK, INCORRECT_STATE, FAILED = 0, 1, 3, 4
STOPPED, PLAYING, PAUSED, QUITTING = 0, 1, 2, 3
#: Of SimulatorFeatures: reset, get and set the state, pause, take one step, or several.
FEATURES = (20, 24, 25, 26, 31, 32)
#: Scopes of a reset: the default, time, state, what was spawned, all. A part is not possible.
_WHOLE = (0, 255)
_STATE: Fields = {"state": f"{PACKAGE}/SimulationState"}
_RESULT: Fields = {"result": f"{PACKAGE}/Result"}


def simulation_services(session: LiveSession) -> dict[str, Service]:
    """The services, by name."""

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
        wanted = values.get("state")
        state = whole(dict(wanted) if isinstance(wanted, dict) else {}, "state", 0, 255)
        if state not in (PLAYING, PAUSED):
            return _result(UNSUPPORTED, "the simulation can be playing or paused")
        session.pause(state == PAUSED)
        return _result(OK)

    async def features(values: Values) -> Values:
        del values
        found = {"features": list(FEATURES), "spawn_formats": [], "custom_info": "crowdbot"}
        return {"features": found}

    return {
        "/reset_simulation": _service("ResetSimulation", {"scope": "uint8"}, _RESULT, reset),
        "/step_simulation": _service("StepSimulation", {"steps": "uint64"}, _RESULT, step),
        "/get_simulation_state": _service(
            "GetSimulationState", {}, {**_STATE, **_RESULT}, get_state
        ),
        "/set_simulation_state": _service("SetSimulationState", _STATE, _RESULT, set_state),
        "/get_simulator_features": _service(
            "GetSimulatorFeatures", {}, {"features": f"{PACKAGE}/SimulatorFeatures"}, features
        ),
    }


def _service(
    name: str, request: Fields, response: Fields, call: Callable[[Values], Awaitable[Values]]
) -> Service:
    """A service whose errors are results, as its type has them."""

    async def answer(values: Values) -> Values:
        try:
            return await call(values)
        except InputError as error:
            return _result(FAILED, str(error))

    kind = f"{PACKAGE}/srv/{name}"
    return Service(kind=kind, request=request, response=response, call=answer)


def _result(code: int, text: str = "") -> Values:
    return {"result": {"result": code, "error_message": text}}


def _state(session: LiveSession) -> int:
    if session.paused:
        return PAUSED
    return PLAYING if session.state in ("waiting", "running", "paused") else STOPPED
