"""A check for features that support only one robot."""

from __future__ import annotations

from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError


def check_one_robot(scenario: Scenario, driver: str) -> None:
    """Refuse a scenario that does not have exactly one robot.

    Args:
        driver: the driver, such as "a session".

    Raises:
        InputError: with the robots' names, and what supports several.
    """
    robots = list(scenario.robots)
    if not robots:
        raise InputError(f"{scenario.id} has no robot, and {driver} drives one")
    if len(robots) > 1:
        each = ",".join(f"{name}=PLANNER" for name in robots)
        raise InputError(
            f"{scenario.id} has {len(robots)} robots, {', '.join(robots)}, and {driver} drives "
            f"one; 'crowdbot simulate --planner {each}' drives all"
        )
