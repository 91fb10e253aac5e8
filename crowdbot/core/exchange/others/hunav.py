"""HuNavSim: agents.yaml, the parameters of its loader."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.others.usual import social_forces
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, not_negative, positive
from crowdbot.core.exchange.scene import Data, Draft, id_of
from crowdbot.errors import nearest

#: Behaviours by number: name, and our like of it.
_BEHAVIOURS = {
    1: ("regular", "the robot is one of the people"),
    2: ("impassive", "the robot is an obstacle to them: here they pay it the least attention"),
    3: ("surprised", "people stop and look at the robot: here they evade it"),
    4: ("scared", "people keep far from the robot: here they evade it"),
    5: ("curious", "people approach the robot: here they evade it"),
    6: ("threatening", "people block the robot: here they evade it"),
}


def _behaviour(item: Item) -> int:
    """Return the number of a behaviour; files for Isaac Sim have its name."""
    kind = item.find("type") or item
    text = kind.text().strip().lower().removeprefix("beh_")
    if text.lstrip("+-")[:1].isdigit():
        return kind.whole(1, 6)
    numbers = {name: number for number, (name, _) in _BEHAVIOURS.items()}
    if text not in numbers:
        message = (
            f"'{kind.text()[:60]}' is not a behaviour; they are {', '.join(numbers)}, or 1 to 6"
        )
        kind.refuse(message, nearest(text, numbers))
    return numbers[text]


AGENT = RowTable(
    "agent",
    (
        Row("id", "crowd.agents.id", read=lambda item: item.whole(0, 2147483647)),
        Row("skin", "", "bodies have no clothes"),
        Row("group_id", "crowd.agents.group", read=lambda item: item.whole(-1, 2147483647)),
        Row("max_vel", "crowd.agents.speed", "the speed at which they walk, and their largest",
            positive),
        Row("radius", "crowd.agents.radius", read=lambda item: item.number(0.01, 100.0)),
        Row("goal_radius", "", "a goal is reached at the crowd's own distance", not_negative),
        Row("cyclic_goals", "crowd.agents.at_goal",
            read=lambda item: "loop" if item.truth() else "stop"),
    ),
)  # fmt: skip
MORE = RowTable(
    "agent",
    (
        Row(
            "behavior", "crowd.agents.attention", "2, impassive: the least attentive; see the note"
        ),
        Row("init_pose", "crowd.agents.x, y, heading"),
        Row("goals", "crowd.agents.goals"),
        Row("init_pose z, goal h", "", "heights and headings at goals"),
    ),
)
LOADER = RowTable(
    "hunav_loader",
    (
        Row("map", "", "give the floor with environment.kind: floor_plan and the map.yaml"),
        Row("simulator", "", "the simulator is crowdbot"),
        Row("publish_people", "", "recordings have people"),
        Row("yaml_base_name", "", "a name of this file"),
    ),
)


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each file.

    Raises:
        SpecError: E402, an agent is missing or a value is invalid.
    """
    return [_scene(file, context.report) for file in files]


def _parameters(file: OpenedScene) -> Item:
    loader = file.roots[0].need("hunav_loader")
    return loader.need("ros__parameters")


def _scene(file: OpenedScene, report: Report) -> Draft:
    parameters, scene = _parameters(file), Draft(id_of(file.path.stem))
    scene.notes.append(f"Imported from HuNavSim: {file.path.name}.")
    report.take(parameters, LOADER)
    policy = scene.policy(social_forces(), "social_forces", parameters.mark)
    report.interpreted(parameters, "crowd.policy", "its social force model is ours of 1995")
    names = parameters.need("agents").every()
    for name in names:
        _agent(name, parameters, policy, scene, report)
    _others(file, parameters, report)
    if not names:
        parameters.need("agents").refuse("no agent is named here")
    _ignoring(scene)
    return scene


def _others(file: OpenedScene, parameters: Item, report: Report) -> None:
    """Record agents that the list does not name, and parameters of other nodes."""
    for item in parameters.children:
        if not item.used and any(part.name == "init_pose" for part in item.children):
            report.left_out(item, "the list 'agents' does not name it: HuNavSim ignores it, too")
        elif not item.used and item.name == "global_goals":
            report.left_out(item, "no agent goes there")
    for item in file.roots[0].children:
        if not item.used and any(part.name == "ros__parameters" for part in item.children):
            report.left_out(item, "parameters of another program")
    for goals in (p for p in parameters.children if p.name == "global_goals" and p.used):
        for goal in goals.children:
            if not goal.used:
                report.left_out(goal, "no agent goes there")


def _agent(name: Item, parameters: Item, policy: str, scene: Draft, report: Report) -> None:
    item = parameters.need(name.text())
    report.carried(name, "crowd.agents")
    fields: Data = {"speed": 1.5, "radius": 0.35, **report.take(item, AGENT)}
    fields["max_speed"] = fields["speed"]
    pose = item.need("init_pose")
    row = {"x": pose.need("x").number(), "y": pose.need("y").number(), **fields, "policy": policy}
    heading = pose.find("h")
    if heading is not None:
        row["heading"] = heading.number()
    report.carried(pose, "crowd.agents.x, y, heading")
    report.others(pose, MORE.rows[3].note, "z")
    row["goals"] = _goals(item, parameters, report) or [[row["x"], row["y"]]]
    _behave(item, row, report)
    scene.agent(row, item.mark)


def _goals(item: Item, parameters: Item, report: Report) -> list[list[float]]:
    listed, shared = item.find("goals"), parameters.find("global_goals")
    goals = []
    for name in listed.every() if listed else []:
        goal = (shared.find(name.text()) if shared else None) or item.need(name.text())
        goals.append([goal.need("x").number(), goal.need("y").number()])
        report.carried(name, "crowd.agents.goals")
        report.carried(goal, "crowd.agents.goals")
        report.others(goal, MORE.rows[3].note, "h", "z")
    return goals


def _behave(item: Item, row: Data, report: Report) -> None:
    given = item.find("behavior")
    if given is None:
        return
    kind = _behaviour(given)
    name, like = _BEHAVIOURS[kind]
    row["attention"] = 0.0 if kind == 2 else 0.5
    report.interpreted(given.find("type") or given, "crowd.agents.attention", f"{name}: {like}")
    report.others(given, "parameters of that behaviour")


def _ignoring(scene: Draft) -> None:
    """Make people with attention 0 ignore robots."""
    count = sum(1 for agent in scene.agents if agent.get("attention") == 0.0)
    if count:
        share = round(count / len(scene.agents), 6)
        share = min(share, 0.999999)
        scene.crowd["robot_response"] = {"reaction": "mixed", "ignoring_fraction": share}


HUNAV = SceneFormat(
    "hunav",
    "HuNavSim agents.yaml",
    lambda file: file.kind == "data" and "hunav_loader" in file.tags,
    read,
    (LOADER, AGENT, MORE),
    "the map, behaviours near the robot but for ignoring it",
)
