"""People as agents of a trial: the drawn ones, each with a law and a sim."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from xml.etree import ElementTree as Xml

from crowdbot.core.environments.build import build_environment
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.trial.people import HEIGHT
from crowdbot.core.exchange.trial_export.elements import add, limit, number, place, turn
from crowdbot.core.exchange.trial_export.policies import Policies
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.scenario.crowd import Crowd, NamedPolicy
from crowdbot.dsl.scenario.scenario import Scenario

_LOOPS = {"loop": "true", "portal": "true", "return": "true", "onward": "true"}
_ENDINGS = {
    "portal": "walk back and forth between the portals instead of coming in again",
    "return": "walk back and forth instead of coming in again",
    "onward": "walk their first ways again and again",
    "remove": "stop at the end instead of leaving",
}


#: Distance before a portal, which may lie behind a wall, at which people turn round, m.
_BEFORE = 1.0


@dataclass(slots=True)
class _Losses:
    """Reasons, with the number of people whom each concerns."""

    counts: dict[str, int] = field(default_factory=dict)

    def note(self, reason: str) -> None:
        self.counts[reason] = self.counts.get(reason, 0) + 1


def add_people(
    root: Xml.Element, scenario: Scenario, people: Realisation, registry: Registry, report: Report
) -> str:
    """Append all people of a scenario; return the file of their policies, if one is needed."""
    crowd = scenario.crowd
    if crowd is None:
        return ""
    policies, losses = Policies(report), _Losses()
    groups: Mapping[str, Crowd | NamedPolicy] = {"": crowd, **crowd.policies}
    mine = [policies.number_of(name, groups[name]) for name in people.policy]
    numbers, text = policies.numbers()
    portals = build_environment(registry, scenario.environment).portals
    for k in range(len(people)):
        route = _route(people, k, portals)
        ident = mine[k]
        _agent(root, people, k, route, None if ident is None else numbers[ident])
        _lose(people, k, crowd, losses)
    for reason, count in losses.counts.items():
        report.added("agents", f"{count} people: {reason}")
    _crowd(crowd, report)
    return text


def _route(
    people: Realisation, k: int, portals: Mapping[str, tuple[float, ...]]
) -> list[tuple[float, float]]:
    goals = [(float(x), float(y)) for x, y in people.goals[k]]
    if goals:
        return goals
    boxes = [portals[name] for name in people.portals[k] if name in portals]
    return [_before(box, float(people.x[k]), float(people.y[k])) for box in reversed(boxes)]


def _before(box: tuple[float, ...], x: float, y: float) -> tuple[float, float]:
    """Return the point `_BEFORE` a box x0, x1, y0, y1 on the way from a place to it, m."""
    nearest = min(max(x, box[0]), box[1]), min(max(y, box[2]), box[3])
    far = math.dist(nearest, (x, y))
    share = min(1.0, _BEFORE / far) if far > 0.0 else 0.0
    return (
        nearest[0] + share * (x - nearest[0]),
        nearest[1] + share * (y - nearest[1]),
    )


def _agent(
    root: Xml.Element, people: Realisation, k: int, route: list[tuple[float, float]],
    policy: int | None,
) -> None:  # fmt: skip
    height = float(people.height[k]) if people.height[k] > 0.0 else HEIGHT
    agent = add(
        add(root, "agent"), "TrialRegularAgent", mesh="Male_Adult_01",
        radius=number(people.radius[k]), visualVariation="0", animationOffset="0",
        heightOffset=number(round(height / HEIGHT - 1.0, 12)),
    )  # fmt: skip
    x, y, heading = float(people.x[k]), float(people.y[k]), float(people.heading[k])
    place(agent, "Position", x, y)
    turn(agent, heading)
    law = add(agent, "controlLaw")
    looping = _LOOPS.get(people.at_goal[k], "false")
    stays = len(route) == 1 and math.dist(route[0], (x, y)) < 1e-9 and looping == "false"
    if not route or stays:
        standing = add(law, "LawStanding", animationType="1")
        place(standing, "LookAt", x + math.cos(heading), y + math.sin(heading))
    else:
        goals = add(
            add(
                law, "LawGoals", speedCurrent="0", speedDefault=number(people.speed[k]),
                accelerationMax=limit(people.max_acceleration[k]), angularSpeed="36000",
                reachedDist="0.5", isLooping=looping,
            ),
            "Goals",
        )  # fmt: skip
        for goal in route:
            place(goals, "Goal", *goal)
    if policy is not None:
        add(
            add(agent, "controlSim"), "UMANSconfig", SimulationID="0", PolicyID=str(policy),
            radius=number(people.radius[k]), prefered_speed=number(people.speed[k]),
            max_speed=limit(people.max_speed[k]),
            max_acceleration=limit(people.max_acceleration[k]),
        )  # fmt: skip


def _lose(people: Realisation, k: int, crowd: Crowd, losses: _Losses) -> None:
    if people.at_goal[k] in _ENDINGS:
        losses.note(_ENDINGS[people.at_goal[k]])
    if people.start_time[k] > 0.0:
        losses.note("are there from the beginning, since trials know no time of entry")
    if people.group[k] >= 0:
        losses.note("walk alone, since UMANS knows no groups")
    if people.mass[k] != crowd.body.mass:
        losses.note("have no mass of their own")
    if any(people.pauses[k]):
        losses.note("do not linger at their goals")
    if people.look[k] not in ("", "adult"):
        losses.note("look like adults")


def _crowd(crowd: Crowd, report: Report) -> None:
    drawn = [n for n in ("flow", "streams", "spawns") if getattr(crowd, n)]
    if drawn:
        report.added("agents", f"the people that crowd.{', crowd.'.join(drawn)} draw, one by one")
    for name in ("steering", "people"):
        if getattr(crowd, name):
            report.added(f"crowd.{name}", "left out: trials have nothing like it")
