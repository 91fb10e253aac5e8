"""Plain English for the words of a scenario's id, such as ``late`` of challenge-2026."""

from __future__ import annotations

import math
from collections.abc import Callable

from crowdbot.core.runs.run_record import RunRecord
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.robot_response import RobotResponse
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.matrix import DRAW

_ORDER = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth")


def scenario_words(record: RunRecord, scenario: Scenario) -> str:
    """Return one sentence on the meaning of a scenario's id; empty without known words.

    Args:
        record: of the run, with the labels of the suite's axes.
        scenario: what was run; numbers are read from it.
    """
    parts = []
    for axis, label in record.axes.items():
        if axis == DRAW:
            parts.append(f"{label}: {_draw(label)}")
        elif words := record.axis_words.get(axis):
            title, value = words
            parts.append(f"{label}: {_plain(title, axis, value, record, scenario)}")
    return f"In this scenario's name, {'; '.join(parts)}." if parts else ""


def _draw(label: str) -> str:
    number = int(label.lstrip("n")) if label.lstrip("n").isdecimal() else 0
    which = _ORDER[number - 1] if 0 < number <= len(_ORDER) else f"{number}th"
    return f"the {which} draw of people, others have other people"


def _plain(title: str, axis: str, value: str, record: RunRecord, scenario: Scenario) -> str:
    """Return what a label means, by the field that its axis varies."""
    tell = _TELLS.get(title)
    if tell is not None and scenario.crowd is not None and (text := tell(scenario, scenario.crowd)):
        realised = record.density if "per m²" in text else None
        return text if realised is None else f"{text}, {realised:.2g} in this run"
    if title in _WITH_VALUE:
        return _WITH_VALUE[title].format(value)
    same = title == axis.replace("_", " ")  # then it says nothing more than the value
    return value[:1].lower() + value[1:] if same else f"{title} {value}"


def _direction(scenario: Scenario, crowd: Crowd) -> str:
    """Return where people go as seen from the robot's start; without a robot, by portals."""
    if crowd.flow is None:
        return ""
    first, second = crowd.flow.portals
    if crowd.flow.direction == "both":
        return "people walk in both directions"
    if crowd.flow.direction == "counter":
        first, second = second, first
    ends = [scenario.environment.portals.get(name) for name in (first, second)]
    if len(scenario.robots) != 1 or None in ends:
        return f"people walk from portal {first} to portal {second}"
    (x0, y0), (x1, y1) = ((sum(e.x) / 2, sum(e.y) / 2) for e in ends if e is not None)
    heading = next(iter(scenario.robots.values())).task.start[2]
    along = (x1 - x0) * math.cos(heading) + (y1 - y0) * math.sin(heading)
    return "people walk the robot's way" if along > 0 else "people come towards the robot"


def _density(_: Scenario, crowd: Crowd) -> str:
    """Return people per area where they start, of the flow or of all streams together."""
    if crowd.flow is not None:
        return f"{crowd.flow.density:g} people per m² where they start"
    each = [stream.people_per_area for stream in crowd.streams.values()]
    if not each or None in each:
        return ""
    return f"{sum(d for d in each if d is not None):g} people per m² where they start"


def _speed(_: Scenario, crowd: Crowd) -> str:
    if crowd.speed is None:
        return ""
    return f"people like to walk at {crowd.speed.mean:g} ± {crowd.speed.std:g} m/s"


def _attention(_: Scenario, crowd: Crowd) -> str:
    """Return how many people take no notice of the robot, or notice it late."""
    response = crowd.robot_response
    if not isinstance(response, RobotResponse):
        return ""
    if response.reaction == "ignore":
        return "no one takes notice of the robot"
    late, ignoring = response.late, response.ignoring
    when = f"only {response.late_time:g} s before they would touch it"
    if not ignoring:
        return f"{late:.0%} of people notice the robot {when}" if late else _ALL_NOTICE
    while_it_moves = " while it moves" if response.reaction == "distracted" else ""
    text = f"{ignoring:.0%} of people take no notice of the robot{while_it_moves}"
    return f"{text}, {late:.0%} of the others notice it {when}" if late else text


_ALL_NOTICE = "all people notice the robot in time"

#: By the title that `crowdbot.dsl.suite.axis_words` gives to an axis.
_TELLS: dict[str, Callable[[Scenario, Crowd], str]] = {
    "flow direction": _direction,
    "flow density": _density,
    "streams density": _density,
    "robot response": _attention,
    "speed": _speed,
}

#: Sentences around the value that `crowdbot.dsl.suite.axis_words` gives, by its title.
_WITH_VALUE = {
    "ttca_dca weight": "avoiding others early has the weight {} (ttca_dca)",
    "ttca_dca range": "people avoid others early within {} (ttca_dca)",
    "joystick kind": "the driver is a {}",
}
