"""People of a trial, agents and players whom the crowd sees, as rows of an agents table."""

from __future__ import annotations

import math
from collections.abc import Mapping

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Data, Draft
from crowdbot.core.exchange.trial.law import Motion, heading, place, read_law
from crowdbot.core.exchange.trial.replays import Replays
from crowdbot.core.exchange.trial.sims import Simulated, law_alone, read_sim

#: Height of a body without offset, m.
HEIGHT = 1.7
AGENT = RowTable(
    "TrialRegularAgent",
    (
        Row("@mesh", "", "bodies here have a radius and a height, no clothes"),
        Row("@radius", "crowd.agents.radius", "a control sim's radius counts where there is one",
            lambda item: item.number(1e-6, 100.0)),
        Row("@visualVariation", "", "bodies have no clothes"),
        Row("@animationOffset", "", "bodies are not animated"),
        Row("@heightOffset", "crowd.agents.height",
            read=lambda item: round(HEIGHT * (1.0 + item.number(-0.9, 9.0)), 9)),
    ),
)  # fmt: skip
POSE = RowTable("Position and Rotation", (
    Row("Position", "crowd.agents.x", "our x is its y, our y its x; heights do not count"),
    Row("Rotation", "crowd.agents.heading", "the turn about the upright axis, the other way round"),
))  # fmt: skip
PLAYER = RowTable(
    "TrialCamPlayer, TrialRegularPlayer",
    (
        Row("TrialCamPlayer in_sim=false", "", "the screen's camera: crowdbot view has its own"),
        Row("in_sim=true", "crowd.agents", "a person of its radius, who moves by its law"),
    ),
)
Policies = Mapping[int, tuple[Data, Item]]
_DRIVEN = (
    "LawControllerSpeedAngle",
    "LawControllerSpeedSideStep",
    "LawCamControlEditor",
    "LawFake",
)


def read_people(
    root: Item | None, policies: Policies, scene: Draft, replays: Replays, report: Report
) -> None:
    """Add all agents of a trial to a scene.

    Raises:
        SpecError: E402, a value is invalid.
    """
    for wrapper in root.every("agent") if root else []:
        for item in wrapper.every("TrialRegularAgent"):
            fields = report.take(item, AGENT)
            _add(item, fields, policies, scene, replays, report)


def read_player(
    root: Item | None, policies: Policies, scene: Draft, replays: Replays, report: Report
) -> None:
    """Add a player as a person, if the crowd sees one.

    Raises:
        SpecError: E402, a value is invalid.
    """
    for item in root.every("TrialCamPlayer", "TrialRegularPlayer") if root else []:
        given = item.find("@in_sim")
        seen = given.truth() if given else item.name == "TrialRegularPlayer"
        if not seen:
            report.left_out(item, PLAYER.rows[0].note)
            continue
        radius = item.find("@radius")
        fields: Data = {"radius": radius.number(1e-6, 100.0)} if radius else {}
        if (mesh := item.find("@mesh")) is not None:
            report.left_out(mesh, AGENT.rows[0].note)
        report.interpreted(item, "crowd.agents", PLAYER.rows[1].note)
        _add(item, fields, policies, scene, replays, report)


def _add(
    item: Item, fields: Data, policies: Policies, scene: Draft, replays: Replays, report: Report
) -> None:  # fmt: skip
    start, facing = _pose(item, report)
    motion = read_law(item.find("controlLaw"), start, facing, report)
    wrapper = item.find("controlSim")
    sim = read_sim(wrapper, policies, report) if wrapper else None
    row = {"x": start[0], "y": start[1], "heading": facing, "radius": 0.33, **fields}
    row |= _speeds(motion, sim)
    if motion.heading is not None:
        row["heading"] = motion.heading
    row |= {"goals": motion.goals, "at_goal": motion.at_goal}
    if motion.file is not None:
        row |= {"policy": replays.add(motion, row, scene, report)}
        report.interpreted(motion.file, "crowd.policies.replay.file",
                           "copied to a table of t, id, x, y in our frame")  # fmt: skip
    else:
        policy, name, at = (sim.policy, sim.name, sim.item) if sim else _alone(item)
        row["policy"] = scene.policy(policy, name, at.mark)
    if motion.kind in _DRIVEN:
        report.interpreted(motion.item or item, "crowd.agents.goals", "no one drives it: stands")
    scene.agent(row, item.mark)


def _alone(item: Item) -> tuple[Data, str, Item]:
    return law_alone(), "law_alone", item


def _pose(item: Item, report: Report) -> tuple[list[float], float]:
    position = item.need("Position")
    start = place(position, report)
    rotation = item.find("Rotation")
    if rotation is None:
        return start, 0.0
    report.carried(rotation, "crowd.agents.heading")
    return start, heading(rotation)


def _speeds(motion: Motion, sim: Simulated | None) -> Data:
    """Return speeds and limits: those of the sim, else of the law."""
    data: Data = {"speed": motion.speed or 1.33}
    if motion.max_acceleration is not None:
        data["max_acceleration"] = motion.max_acceleration
    if sim is not None:
        data |= sim.fields
        if "max_speed" not in sim.fields:
            data["max_speed"] = max(data["speed"], 1.8)
    else:
        data["max_speed"] = max(data["speed"], 0.01)
    return {name: v for name, v in data.items() if not (isinstance(v, float) and math.isnan(v))}
