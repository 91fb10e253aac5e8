"""The control law of a person of a trial: goal and speed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable, not_negative
from crowdbot.core.exchange.umans.agents import limited

#: Distance of the goal of those who only walk straight on, m.
FAR = 1000.0
_STEER = "people here turn as their policy says"
_STICK = "no joystick drives a person here: stands still"

_WALK = (
    Row("@speedCurrent", "", "people start at rest", unless="0"),
    Row("@speedDefault", "crowd.agents.speed",
        "where a control sim has a preferred speed, that counts", limited),
    Row("@accelerationMax", "crowd.agents.max_acceleration",
        "where a control sim has a largest acceleration, that counts", limited),
    Row("@angularSpeed", "", _STEER),
    Row("@reachedDist", "", "a goal is reached at the crowd's own distance", not_negative),
    Row("@isLooping", "crowd.agents.at_goal",
        read=lambda item: "loop" if item.truth() else "stop"),
)  # fmt: skip
CONTROL_LAWS: Mapping[str, RowTable] = {
    "LawGoals": RowTable("LawGoals", (*_WALK, Row("Goals/Goal", "crowd.agents.goals"))),
    "LawWaypoints": RowTable(
        "LawWaypoints", (*_WALK, Row("Waypoints/Waypoint", "crowd.agents.goals"))
    ),
    "LawStanding": RowTable(
        "LawStanding",
        (
            Row("@animationType", "", "bodies are not animated"),
            Row("LookAt", "crowd.agents.heading"),
        ),
    ),
    "LawMoveStraight": RowTable("LawMoveStraight", _WALK[:3]),
    "LawFileData": RowTable(
        "LawFileData",
        (
            Row("@timeColumn", "crowd.policies.replay", read=lambda item: item.whole(-99, 99)),
            Row("@xColumn", "crowd.policies.replay", read=lambda item: item.whole(-99, 99)),
            Row("@yColumn", "", "the floor is flat"),
            Row("@zColumn", "crowd.policies.replay", read=lambda item: item.whole(-99, 99)),
            Row("dataFile", "crowd.policies.replay.file"),
        ),
    ),
    "LawFake": RowTable("LawFake", ()),
    "LawCamControlEditor": RowTable(
        "LawCamControlEditor",
        tuple(Row(f"@{n}", "", "the screen's camera: crowdbot view and replay have their own")
              for n in ("lookSpeedH", "lookSpeedV", "zoomSpeed", "dragSpeed")),
    ),
    **{
        name: RowTable(name, tuple(Row(f"@{n}", "", _STICK) for n in names))
        for name, names in {
            "LawControllerSpeedAngle": ("speedCurrent", "speedDefault", "speedVariation",
                                        "angularSpeed", "accelerationMax", "timeBeforeControl"),
            "LawControllerSpeedSideStep": ("speedCurrent", "speedDefault", "speedVariation",
                                           "sideSpeed", "accelerationMax", "timeBeforeControl"),
        }.items()
    },
}  # fmt: skip


@dataclass(slots=True)
class Motion:
    """The planned motion of one person or robot.

    Attributes:
        kind: tag of the law.
        item: its element.
        goals: points of the route, m; those who stand have their start.
        at_goal: as in `crowd.agents`.
        speed: m/s; None if the law has none.
        max_acceleration: m/s^2; None if the law has none.
        heading: rad; None to leave it as it is.
        columns: of a replayed file: our name -> column.
        file: the item that names the replayed file.
    """

    kind: str
    item: Item | None
    goals: list[list[float]]
    at_goal: str = "stop"
    speed: float | None = None
    max_acceleration: float | None = None
    heading: float | None = None
    columns: dict[str, int] = field(default_factory=dict)
    file: Item | None = None

    @property
    def walks(self) -> bool:
        """Return True if it goes somewhere."""
        return self.kind in ("LawGoals", "LawWaypoints", "LawMoveStraight")


def place(item: Item, report: Report | None = None) -> list[float]:
    """Return crowdbot's x and y of an element with a trial's x, y and z, m.

    Raises:
        SpecError: E402, one is missing or is not a number.
    """
    x, y = item.need("@x").number(), item.need("@y").number()
    height = item.find("@z")
    if height is not None:
        height.number()
    if report is not None:
        report.carried(item, "x, y")
    return [y + 0.0, x + 0.0]


def heading(item: Item) -> float:
    """Return the heading in crowdbot's frame of a ``Rotation`` in degrees, rad in [-pi, pi)."""
    for name in ("@x", "@y"):
        if (part := item.find(name)) is not None:
            part.number()
    turned = math.radians(-item.need("@z").number())
    return (turned + math.pi) % (2.0 * math.pi) - math.pi + 0.0


def only_child(wrapper: Item, known: Mapping[str, object]) -> Item:
    """Return the one concrete element in a wrapper such as ``controlLaw``.

    Raises:
        SpecError: E402, there is none, or more than one, or it is unknown.
    """
    elements = [c for c in wrapper.children if not c.name.startswith("@")]
    if len(elements) != 1:
        wrapper.refuse(f"'{wrapper.name}' has {len(elements)} elements, and needs exactly one")
    if elements[0].name not in known:
        elements[0].refuse(f"no {wrapper.name} '{elements[0].name[:60]}'", list(known))
    elements[0].used = True
    return elements[0]


def read_law(wrapper: Item | None, start: list[float], facing: float, report: Report) -> Motion:
    """Return the motion of a ``controlLaw``; without one, that of a standing person.

    Args:
        wrapper: the element, if there is one.
        start: our x and y, m.
        facing: our heading, rad.
        report: where each part is recorded.

    Raises:
        SpecError: E402, the law is unknown or one of its values is invalid.
    """
    if wrapper is None:
        return Motion("", None, [start])
    item = only_child(wrapper, CONTROL_LAWS)
    table = CONTROL_LAWS[item.name]
    parts = [row for row in table.rows if row.theirs.startswith("@")]
    fields = report.take(item, RowTable(table.element, parts))
    report.carried(item, "crowd.agents")
    motion = Motion(item.name, item, [start])
    if item.name in _READERS:
        motion.at_goal = fields.get("at_goal", "stop")
        motion.speed, motion.max_acceleration = fields.get("speed"), fields.get("max_acceleration")
        _READERS[item.name](motion, item, (start, facing), report)
    return motion


#: Our start (m) and heading (rad).
_Pose = tuple[list[float], float]


def _goals(motion: Motion, item: Item, at: _Pose, report: Report) -> None:
    del at
    list_name, name = ("Goals", "Goal") if motion.kind == "LawGoals" else ("Waypoints", "Waypoint")
    listed = item.find(list_name)
    found = [place(goal, report) for goal in listed.every(name)] if listed else []
    motion.speed = 1.33 if motion.speed is None else motion.speed
    if found:
        motion.goals = found
    else:
        motion.at_goal = "stop"
        report.interpreted(item, "crowd.agents.goals", "without goals: stands at the start")


def _straight(motion: Motion, item: Item, at: _Pose, report: Report) -> None:
    del item, report
    start, facing = at
    motion.speed = 1.33 if motion.speed is None else motion.speed
    motion.goals = [[start[0] + FAR * math.cos(facing), start[1] + FAR * math.sin(facing)]]


def _standing(motion: Motion, item: Item, at: _Pose, report: Report) -> None:
    start, _ = at
    look = item.find("LookAt")
    if look is not None:
        point = place(look, report)
        if math.dist(point, start) > 1e-9:
            motion.heading = math.atan2(point[1] - start[1], point[0] - start[0])


def _file(motion: Motion, item: Item, at: _Pose, report: Report) -> None:
    del at, report
    numbers = {"t": 1, "x": 0, "z": 0}
    for ours, theirs in (("t", "@timeColumn"), ("x", "@xColumn"), ("z", "@zColumn")):
        part = item.find(theirs)
        numbers[ours] = numbers[ours] if part is None else part.whole(-99, 99)
    motion.columns, motion.file = numbers, item.need("dataFile")


_READERS: Mapping[str, Callable[[Motion, Item, _Pose, Report], None]] = {
    "LawGoals": _goals,
    "LawWaypoints": _goals,
    "LawMoveStraight": _straight,
    "LawStanding": _standing,
    "LawFileData": _file,
}
