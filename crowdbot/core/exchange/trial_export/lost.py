"""Fields of a scenario that a trial cannot express."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import BaseModel

from crowdbot.core.exchange.report import Report
from crowdbot.dsl.scenario.scenario import Scenario

_NOTE = "left out: a trial has no word for it"
#: Field that holds parts -> their fields that are exported, or of which the report says more.
_EXPORTED: Mapping[str, frozenset[str]] = {
    "": frozenset({"id", "environment", "crowd", "robots", "contact", "rates"}),
    "environment": frozenset({"kind", "zones", "portals", "area", "border", "walls", "blocks",
                              "pillars", "wkt", "file"}),
    "crowd": frozenset({"flow", "streams", "spawns", "goal_areas", "agents", "speed", "body",
                        "people", "groups", "policy", "costs", "policies", "steering",
                        "robot_response", "routing", "seed"}),
    "crowd.body": frozenset({"radius", "mass", "max_speed", "max_acceleration", "height"}),
    "crowd.robot_response": frozenset({"kind", "margin", "reaction", "shown_to_policies",
                                       "velocity", "ignoring_fraction"}),
    "crowd.routing": frozenset({"kind"}),
    "robots": frozenset({"model", "sensors", "task"}),
    "robots.task": frozenset({"start", "goal", "time_limit"}),
}  # fmt: skip


def name_lost(scenario: Scenario, report: Report) -> None:
    """Record all non-default fields of a scenario that a trial cannot express."""
    parts: dict[str, BaseModel | None] = {"": scenario, "environment": scenario.environment}
    if scenario.crowd is not None:
        crowd = scenario.crowd
        parts |= {"crowd": crowd, "crowd.body": crowd.body, "crowd.routing": crowd.routing,
                  "crowd.robot_response": crowd.robot_response}  # fmt: skip
    for name, robot in scenario.robots.items():
        parts |= {f"robots.{name}": robot, f"robots.{name}.task": robot.task}
    for path, part in parts.items():
        for field in _set(part):
            if field not in _EXPORTED[_kind(path)]:
                report.added(f"{path}.{field}".lstrip("."), _NOTE)
    _common(scenario, report)


def _kind(path: str) -> str:
    """Return a path without the names of robots."""
    words = path.split(".")
    return ".".join([words[0], *words[2:]]) if words[0] == "robots" else path


def _set(part: BaseModel | None) -> list[str]:
    """Return the fields whose values differ from their defaults."""
    if part is None:
        return []
    fields = type(part).model_fields
    return [
        name
        for name in fields
        if name in part.model_fields_set
        and getattr(part, name) != fields[name].get_default(call_default_factory=True)
    ]


def _common(scenario: Scenario, report: Report) -> None:
    """Record behaviour that the original simulator fixes for all trials."""
    crowd = scenario.crowd
    if crowd is None:
        return
    solid = any(getattr(scenario.environment, kind, None) for kind in ("walls", "blocks"))
    finds_way = crowd.routing is not None and crowd.routing.kind == "mesh"
    if solid != finds_way:
        how = "round walls" if solid else "straight to their goals"
        report.added("crowd.routing", f"people walk {how}, as LawGoals leads them")
    response = crowd.robot_response
    if response is None or not scenario.robots:
        return
    if 0.0 < response.ignoring < 1.0:
        note = "all people react to the robot: a trial says it for all or for none"
        report.added("crowd.robot_response.ignoring_fraction", note)
    if response.velocity != "hidden":
        note = "people there are not told how the robot moves"
        report.added("crowd.robot_response.velocity", note)
