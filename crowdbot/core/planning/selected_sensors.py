"""The sensors that a planner gets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError


def select_sensors(
    needs: Sequence[str] | None,
    sensors: Mapping[str, SensorInfo],
    planner: str,
    *,
    privileged: bool = False,
) -> tuple[str, ...]:
    """Return the names of the sensors that a planner gets, in the robot's order.

    Args:
        needs: names or categories; None: all that it may have. One that ends with ``?`` is taken
            where the robot has it.
        sensors: the robot's sensors.
        planner: name for messages.
        privileged: True if it may have privileged sensors.

    Raises:
        InputError: no sensor matches a need, or only a privileged one.
    """
    if needs is None:
        return tuple(n for n, s in sensors.items() if privileged or not s.privileged)
    offered = {*sensors, *(s.category for s in sensors.values())}
    required = {need.removesuffix("?") for need in needs}
    for need in needs:
        if need not in offered and not need.endswith("?"):
            has = ", ".join(sorted(offered)) or "none"
            raise InputError(f"planner '{planner}' needs '{need}'; the robot's sensors: {has}")
    found = tuple(n for n, s in sensors.items() if n in required or s.category in required)
    for name in found:
        if sensors[name].privileged and not privileged:
            raise InputError(
                f"planner '{planner}' needs '{name}', which is privileged: "
                "a planner that reads it must say 'privileged = True'"
            )
    return found
