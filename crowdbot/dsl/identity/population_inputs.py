"""The inputs for sampling a crowd."""

from __future__ import annotations

import json

from crowdbot.dsl.scenario.agent_tables import table_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.spawning import CLEAR_OF_ROBOT
from crowdbot.dsl.spec.areas import Area

#: Fields of a crowd that do not affect its sampling; all others, and the environment, do.
NOT_SAMPLED = ("policy", "policies", "costs", "robot_response", "groups")


def population_inputs(scenario: Scenario) -> str:
    """Return the hash of everything that may affect the sampling of a scenario's crowd."""
    content = scenario.model_dump(mode="json", include={"environment", "crowd"})
    crowd = {k: v for k, v in (content["crowd"] or {}).items() if k not in NOT_SAMPLED}
    robots = {"robots": starts} if (starts := _starts_among_people(scenario)) else {}
    text = json.dumps({**content, "crowd": crowd, **robots}, sort_keys=True, separators=(",", ":"))
    return table_hash(text)


def _starts_among_people(scenario: Scenario) -> list[tuple[float, float]]:
    """Return robots' starts (x, y; m) so near to an area of people that they affect sampling."""
    crowd, zones = scenario.crowd, scenario.environment.zones
    if crowd is None:
        return []
    if crowd.streams:  # they may start anywhere
        return sorted(robot.task.start[:2] for robot in scenario.robots.values())
    places = [*([crowd.flow.area] if crowd.flow else []), *(s.area for s in crowd.spawns.values())]
    areas = [Area.of(zones[p]) if isinstance(p, str) else p for p in places]
    starts = sorted(robot.task.start[:2] for robot in scenario.robots.values())
    return [xy for xy in starts if any(a.distance(*xy) < CLEAR_OF_ROBOT for a in areas)]
