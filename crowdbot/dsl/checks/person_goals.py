"""Checks of goals that are people: the person, and the task's fit to that person."""

from __future__ import annotations

import math
from collections.abc import Iterator

from crowdbot.dsl.checks.facts import Facts, Path
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.person_goals import ApproachGoal, LeadGoal, PersonGoal
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.scenario.spawning import Agent
from crowdbot.dsl.text.diagnostics import Diagnostic


def check_person_goals(facts: Facts) -> Iterator[Diagnostic]:
    """Check the goal of each robot whose goal is a person."""
    led = dict[str, str]()
    for name, robot in facts.scenario.robots.items():
        goal, path = robot.task.person, ("robots", name, "task", "goal")
        if goal is None:
            continue
        if facts.scenario.crowd is None:
            text = f"the goal of robot '{name}' is {goal.person}, and there are no people"
            yield Diagnostic("E146", text, facts.mark(*path, "person"), "write a crowd")
            continue
        yield from _check_who(facts, goal, path)
        if isinstance(goal, LeadGoal):
            yield from _check_lead(facts, goal, path)
            other = led.setdefault(str(goal.person), name)
            if other != name:
                text = f"robots '{other}' and '{name}' both lead {goal.person}"
                yield Diagnostic("E147", text, facts.mark(*path, "person"))
        if isinstance(goal, ApproachGoal):
            yield from _check_not_there(facts, name, robot, goal)


def _check_not_there(
    facts: Facts, name: str, robot: Robot, goal: ApproachGoal
) -> Iterator[Diagnostic]:
    """Check that a robot does not already meet its `approach` goal of a standing agent."""
    for agent in agents_of(facts.crowd, goal):
        walks = any(point != (agent.x, agent.y) for point in agent.goals)
        if goal.person.agent is None or agent.heading is None or walks:
            continue
        x, y, yaw = robot.task.start
        dx, dy = x - agent.x, y - agent.y
        gap = math.hypot(dx, dy) - robot.model.half_width
        gap -= agent.radius or facts.crowd.body.radius
        aside = abs(math.remainder(math.atan2(dy, dx) - agent.heading, math.tau))
        turned = abs(math.remainder(math.atan2(-dy, -dx) - yaw, math.tau))
        if abs(gap - goal.distance) <= goal.tolerance and max(aside, turned) <= goal.angle:
            text = f"robot '{name}' starts in its goal: before {goal.person}, {gap:.2f} m away"
            hint = f"it would arrive after {goal.hold:g} s without a move; move the start"
            mark = facts.mark("robots", name, "task", "start")
            yield Diagnostic("E145", text, mark, hint)


def _check_who(facts: Facts, goal: PersonGoal, path: Path) -> Iterator[Diagnostic]:
    """Check that the person exists, is present at the start, and uses no portals."""
    person, crowd = goal.person, facts.crowd
    (field,) = person.written
    where = (*path, "person", field)
    for category, known in (("spawn", crowd.spawns), ("stream", crowd.streams)):
        if field == category and getattr(person, category) not in known:
            yield facts.unknown(category, getattr(person, category), known, *where)
            return
    found = agents_of(crowd, goal)
    if field in ("agent", "group") and not found:
        hint = _listed(crowd, field)
        text = "no agent belongs to group" if field == "group" else "there is no agent"
        yield Diagnostic("E146", f"{text} {getattr(person, field)}", facts.mark(*where), hint)
    late = [agent for agent in found if agent.start_time > 0.0]
    if late or _enters_later(crowd, goal):
        text = f"{person} is not there at the start, and the robot could not be shown to it"
        yield Diagnostic("E146", text, facts.mark(*where), "a goal has start_time 0")
    if any(agent.portals for agent in found) or _jumps(crowd, goal):
        text = f"{person} goes through portals, and would jump away from the robot"
        yield Diagnostic("E147", text, facts.mark(*where), "write goals instead of portals")


def agents_of(crowd: Crowd, goal: PersonGoal) -> list[Agent]:
    """Return the explicit agents that a goal names, if any."""
    person = goal.person
    if person.agent is not None:
        return [agent for agent in crowd.agents if agent.id == person.agent]
    return [a for a in crowd.agents if person.group is not None and a.group == person.group]


def _listed(crowd: Crowd, field: str) -> str:
    numbers = {a.id for a in crowd.agents} if field == "agent" else {a.group for a in crowd.agents}
    known = sorted(numbers - {-1})
    some = ", ".join(map(str, known[:8])) + (", …" if len(known) > 8 else "")
    return f"known: {some}" if known else f"no explicit agent has a number of a {field}"


def _enters_later(crowd: Crowd, goal: PersonGoal) -> bool:
    person = goal.person
    if person.spawn is not None:
        time = crowd.spawns[person.spawn].start_time
        return time.value - time.spread > 0.0
    return person.stream is not None and crowd.streams[person.stream].entering is not None


def _jumps(crowd: Crowd, goal: PersonGoal) -> bool:
    person = goal.person
    return person.spawn is not None and crowd.spawns[person.spawn].portals is not None


def _check_lead(facts: Facts, goal: LeadGoal, path: Path) -> Iterator[Diagnostic]:
    """Check that a person to be led stands, and has no route to follow."""
    person = goal.person
    found = agents_of(facts.crowd, goal)
    walks = any(a.goals and any(point != (a.x, a.y) for point in a.goals) for a in found)
    spawn = None if person.spawn is None else facts.crowd.spawns.get(person.spawn)
    if walks or person.stream is not None or (spawn is not None and not spawn.standing):
        text = f"{person} has a way of its own, and would not follow the robot"
        hint = "one who is led stands: goals is the start itself, or standing: true"
        yield Diagnostic("E147", text, facts.mark(*path, "person"), hint)
