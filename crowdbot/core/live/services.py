"""Services of a live run, for all protocols."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.live.session import LiveSession
from crowdbot.errors import InputError

Values = dict[str, Any]
#: Field -> type of a request or response.
Fields = Mapping[str, str]
_MOST_STEPS, _MOST_SEED = 10**6, 2**63 - 1
_LOOK, _LONGEST = 0.005, 3600.0
TRIGGER: Fields = {"success": "bool", "message": "string"}


@dataclass(frozen=True, kw_only=True)
class Service:
    """A service of a live run: types of request and response, and its function.

    Attributes:
        kind: ``package/srv/Name``.
        request, response: their fields.
        call: function; raises `InputError` if impossible.
    """

    kind: str
    request: Fields
    response: Fields
    call: Callable[[Values], Awaitable[Values]]


def services(session: LiveSession) -> dict[str, Service]:
    """Return crowdbot's services, by name."""

    def trigger(act: Callable[[], object]) -> Service:
        async def call(values: Values) -> Values:
            del values
            act()
            return {"success": True, "message": ""}

        return Service(kind="std_srvs/srv/Trigger", request={}, response=TRIGGER, call=call)

    async def step(values: Values) -> Values:
        count = whole(values, "steps", 1, _MOST_STEPS, default=1)
        await steps_taken(session, count)
        return {"success": True, "message": ""}

    async def set_seed(values: Values) -> Values:
        session.ask_for("reset", seed=whole(values, "seed", 0, _MOST_SEED))
        return {"success": True, "message": ""}

    return {
        "/crowdbot/reset": trigger(lambda: session.ask_for("reset")),
        "/crowdbot/next_scenario": trigger(lambda: session.ask_for("next")),
        "/crowdbot/pause": trigger(lambda: session.pause(True)),
        "/crowdbot/resume": trigger(lambda: session.pause(False)),
        "/crowdbot/step": Service(
            kind="crowdbot_msgs/srv/Step", request={"steps": "uint32"}, response=TRIGGER, call=step
        ),
        "/crowdbot/set_seed": Service(
            kind="crowdbot_msgs/srv/SetSeed", request={"seed": "int64"}, response=TRIGGER,
            call=set_seed,
        ),
    }  # fmt: skip


async def steps_taken(session: LiveSession, count: int) -> None:
    """Take this many planner steps, pause, and return when done or at the end of the run.

    Raises:
        InputError: the run ended before.
    """
    run, last = session.run, session.step(count)
    deadline = time.monotonic() + _LONGEST
    while session.run == run and session.counts.steps < last:
        if session.state not in ("waiting", "running", "paused") or time.monotonic() > deadline:
            break
        await asyncio.sleep(_LOOK)
    if session.run != run or session.counts.steps < last:
        raise InputError(f"the run ended after {session.counts.steps} steps")


def whole(values: Values, name: str, least: int, most: int, default: int | None = None) -> int:
    """Return a whole number from a request.

    Raises:
        InputError: it is not one, or out of range.
    """
    value = values.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise InputError(f"'{name}' must be a whole number from {least} to {most}")
    return value
