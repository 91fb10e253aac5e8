"""Agents of UMANS as rows of an agents table."""

from __future__ import annotations

from collections.abc import Mapping

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, not_negative
from crowdbot.core.exchange.scene import Data, Draft
from crowdbot.core.exchange.umans.presets import PRESETS, preset

#: Speed and acceleration that stand for "no limit", such as the largest float32.
UNLIMITED = 1e3


def limited(item: Item) -> float:
    """Return a limit; values that mean "no limit" become `UNLIMITED`."""
    return min(item.number(1e-9, 3.5e38), UNLIMITED)


AGENT = RowTable(
    "Agent",
    (
        Row("@id", "crowd.agents.id", read=lambda item: item.whole(0, 2147483647)),
        Row("@rad", "crowd.agents.radius", read=lambda item: item.number(1e-6, 100.0)),
        Row("@pref_speed", "crowd.agents.speed", read=limited),
        Row("@max_speed", "crowd.agents.max_speed", read=limited),
        Row("@max_acceleration", "crowd.agents.max_acceleration", read=limited),
        Row("@start_time", "crowd.agents.start_time", read=not_negative),
        Row("@remove_at_goal", "crowd.agents.at_goal",
            read=lambda item: "remove" if item.truth() else "stop"),
        Row("@mass", "crowd.policies.contact_stiffness",
            "a factor of contact forces there, not kg: the agent's policy is a copy whose contact, "
            "and forces of gradient policies, are divided by it", lambda item: item.number(1e-6)),
        Row("pos", "crowd.agents.x", read=lambda item: point(item)),
        Row("goal", "crowd.agents.goals", read=lambda item: point(item)),
    ),
)  # fmt: skip
DEFAULTS: Data = {"radius": 0.24, "speed": 1.4, "max_speed": 1.8, "max_acceleration": 5.0}
#: Costs that are forces, which the mass divides.
_FORCES = ("goal_reaching_force", "social_forces_avoidance", "power_law")


def point(item: Item) -> list[float]:
    """Return ``x`` and ``y`` of an element, m.

    Raises:
        SpecError: E402, one is missing or is not a number.
    """
    return [item.need("@x").number(), item.need("@y").number()]


def read_agents(
    root: Item, policies: Mapping[int, tuple[Data, Item]], scene: Draft, report: Report
) -> None:
    """Add all agents of an ``Agents`` element to a scene.

    Raises:
        SpecError: E402, an agent names a policy that is not there, or a value is invalid.
    """
    for item in root.every("Agent"):
        fields = {**DEFAULTS, **report.take(item, AGENT)}
        if item.find("pos") is None:
            item.refuse("an Agent without pos")
        place, mass = fields.pop("x"), fields.pop("contact_stiffness", 1.0)
        goal = fields.pop("goals", place)
        used = _policy(item, policies, report)
        name = scene.policy(_with_mass(used[0], mass), used[1], used[2].mark)
        row = {"x": place[0], "y": place[1], **fields, "goals": [goal], "policy": name}
        scene.agent(row, item.mark)


def _policy(
    item: Item, policies: Mapping[int, tuple[Data, Item]], report: Report
) -> tuple[Data, str, Item]:
    element = item.find("Policy")
    ident = element.need("@id") if element else None
    number = ident.whole(0) if ident else 0
    at = ident or item
    if number in policies:
        if ident:
            report.carried(ident, "crowd.agents.policy")
        return policies[number][0], f"policy_{number}", policies[number][1]
    if policies:
        known = ", ".join(map(str, policies))
        at.refuse(f"no policy {number}; there are: {known}")
    if number in PRESETS:
        report.interpreted(at, "crowd.policy", f"no file of policies: preset {number} of UMANS")
        return preset(number), f"preset_{number}", at
    report.interpreted(at, "crowd.policy", "no file of policies: preset 0 of UMANS")
    return preset(0), "preset_0", at


def _with_mass(used: Data, mass: float) -> Data:
    """Return a policy with forces divided by the agents' mass (kg), as UMANS does."""
    if mass == 1.0:
        return used
    policy, costs = dict(used["policy"]), {name: dict(c) for name, c in used["costs"].items()}
    policy["contact_stiffness"] /= mass
    if policy["method"] == "gradient":
        for cost in costs.values():
            if cost["kind"] in _FORCES:
                cost["weight"] /= mass
    return {"policy": policy, "costs": costs}
