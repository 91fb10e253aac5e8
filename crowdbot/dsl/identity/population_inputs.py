"""What the drawing of a crowd depends on."""

from __future__ import annotations

import json

from crowdbot.dsl.scenario.agent_tables import table_hash
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.spawning import CLEAR_OF_ROBOT
from crowdbot.dsl.spec.areas import Area

#: What of a crowd has no part in its drawing; everything else of it, and the environment, has.
NOT_SAMPLED = ("policy", "policies", "costs", "robot_response", "groups")


def population_inputs(scenario: Scenario) -> str:
    """Hash of everything that the drawing of a scenario's crowd may depend on."""
    content = scenario.model_dump(mode="json", include={"environment", "crowd"})
    crowd = {k: v for k, v in (content["crowd"] or {}).items() if k not in NOT_SAMPLED}
    robots = {"robots": starts} if (starts := _starts_among_people(scenario)) else {}
    text = json.dumps({**content, "crowd": crowd, **robots}, sort_keys=True, separators=(",", ":"))
    return table_hash(text)


def _starts_among_people(scenario: Scenario) -> list[tuple[float, float]]:
    """Starts of robots that are so near to an area of people that they may move somebody."""
    crowd, zones = scenario.crowd, scenario.environment.zones
    if crowd is None:
        return []
    if crowd.streams:  # they may begin anywhere
        return sorted(robot.task.start[:2] for robot in scenario.robots.values())
    places = [*([crowd.flow.area] if crowd.flow else []), *(s.area for s in crowd.spawns.values())]
    areas = [Area.of(zones[p]) if isinstance(p, str) else p for p in places]
    starts = sorted(robot.task.start[:2] for robot in scenario.robots.values())
    return [xy for xy in starts if any(a.distance(*xy) < CLEAR_OF_ROBOT for a in areas)]
