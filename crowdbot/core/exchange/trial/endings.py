"""End conditions of a trial as limits of the robot's task."""

from __future__ import annotations

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Draft

_ROOT = "the original tests a point that never moves; meant is the robot's place, as it is here"


def read_endings(root: Item | None, scene: Draft, report: Report) -> None:
    """Set time limits and goal zones of a scene's robots; each condition alone ends a trial.

    Raises:
        SpecError: E402, a condition is not known.
    """
    for item in root.every("condition") if root else []:
        parameter = item.need("@parameter").word("time", "x", "y")
        test = item.need("@test").word("greater", "less")
        value = item.need("@value").number()
        if parameter == "time":
            _time(item, test, value, scene, report)
        elif scene.robots:
            _place(item, parameter, test, value, scene)
            report.interpreted(item, "robots.task.goal", _ROOT)
        else:
            report.left_out(item, "there is no robot whose place could end the run")


def _time(item: Item, test: str, value: float, scene: Draft, report: Report) -> None:
    if test == "less" and value <= 0.0:
        report.carried(item, "(never ends the trial)")
    elif test == "less":
        item.refuse("a trial that ends before it begins: time less than a positive number")
    elif not scene.robots:
        report.left_out(item, f"people alone walk as long as simulate --duration {value:g} says")
    elif value <= 0.0:
        item.refuse("a trial that ends at once: time greater than 0 or less")
    else:
        for robot in scene.robots.values():
            task = robot["task"]
            task["time_limit"] = min(value, task.get("time_limit", value))
        report.carried(item, "robots.task.time_limit")


def _place(item: Item, parameter: str, test: str, value: float, scene: Draft) -> None:
    """Make the goal zones of all robots the part of the floor beyond a line."""
    area = scene.data()["environment"]["area"]
    # x is Unity's, -1 times our y; y is Unity's Z, our x
    axis, bound = ("y", -value) if parameter == "x" else ("x", value)
    low, high = area[axis]
    above = (test == "greater") == (parameter == "y")
    span = [max(bound, low), high] if above else [low, min(bound, high)]
    if not span[0] < span[1]:
        item.refuse(f"no part of the floor has {parameter} {test} than {value:g}")
    other = "y" if axis == "x" else "x"
    for robot in scene.robots.values():
        name = robot["task"]["goal"]["zone"]
        scene.environment["zones"][name] = {axis: span, other: list(area[other])}
        scene.origins["environment", "zones", name] = item.mark
