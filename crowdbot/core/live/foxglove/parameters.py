"""Parameters of a live run in Foxglove: facts about the run, and three that can be set."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from crowdbot.core.live.services import whole
from crowdbot.core.live.session import LiveSession
from crowdbot.errors import InputError

_MOST_SEED = 2**63 - 1


def parameters(session: LiveSession, names: Iterable[str] = ()) -> list[Any]:
    """Return parameters for foxglove-sdk; all if no names are given."""
    from foxglove.websocket import Parameter

    values: dict[str, Any] = {
        "scenario": session.scenario,
        "seed": session.seed,
        "paused": session.paused,
        "state": session.state,
        "robot": ", ".join(robot.name for robot in session.here),
    }
    requested = list(names) or list(values)
    return [Parameter(name, value=values[name]) for name in requested if name in values]


def set_parameters(session: LiveSession, given: Iterable[Any]) -> str:
    """Apply parameters: ``paused``, ``seed`` (restarts), ``scenario`` (starts another).

    Returns:
        Errors, or an empty text.
    """
    problems = []
    for parameter in given:
        try:
            _set(session, str(parameter.name), parameter.get_value())
        except InputError as error:
            problems.append(str(error))
    return "; ".join(problems)


def _set(session: LiveSession, name: str, value: object) -> None:
    if name == "paused":
        if not isinstance(value, bool):
            raise InputError("'paused' is true or false")
        session.pause(value)
    elif name == "seed":
        number = int(value) if isinstance(value, float) and value.is_integer() else value
        session.ask_for("reset", seed=whole({"seed": number}, "seed", 0, _MOST_SEED))
    elif name == "scenario":
        if not isinstance(value, str) or value not in session.scenarios:
            raise InputError(f"no scenario '{str(value)[:80]}' in the suite")
        session.load(value)
    else:
        raise InputError(f"'{name[:80]}' cannot be set; paused, seed and scenario can")
