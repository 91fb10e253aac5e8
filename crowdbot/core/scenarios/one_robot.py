"""Scenarios for what drives one robot."""

from __future__ import annotations

from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError


def check_one_robot(scenario: Scenario, driver: str) -> None:
    """Refuse a scenario that has not exactly one robot.

    Args:
        driver: what would drive it, such as "a session".

    Raises:
        InputError: it names the robots, and says what drives several.
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
