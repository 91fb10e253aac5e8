"""What nobody can get to, or stand in, is an error with its place, before anything is built."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())
#: A hall of 20 m by 10 m with a wall from side to side at x = 10 m.
DOCUMENT = """\
crowdbot: 1
scenario:
  id: hall
  extends: ["builtin:parts/turtlebot2.yaml"]
  environment:
    kind: floor
    area: {x: [0 m, 20 m], y: [0 m, 10 m]}
    walls: {middle: {start: [10 m, 0 m], end: [10 m, 10 m], thickness: 0.2 m}}
    zones:
      left: {x: [0 m, 9 m], y: [0 m, 10 m]}
      right: {x: [11 m, 20 m], y: [0 m, 10 m]}
      goal: {x: [6 m, 8 m], y: [4 m, 6 m]}
    portals:
      a: {x: [0 m, 2 m], y: [0 m, 10 m]}
      b: {x: [18 m, 20 m], y: [0 m, 10 m]}
      within: {x: [9.9 m, 10.1 m], y: [0 m, 10 m]}
  robots.robot.task: {start: [1 m, 5 m, 0 deg], goal: {zone: goal}, time_limit: 60 s}
  crowd:
    speed: {mean: 1.3 m/s, std: 0.1 m/s}
    policy: {kind: velocity_space}
    costs: {avoid: {kind: ttca_dca, weight: 20, range: 5 m}}
    goal_areas: {here: {area: left}, there: {area: right}}
"""
MESH = "    routing: {kind: mesh}\n"
STREAM = "    streams: {one: {%s}}\n"
FLOW = "    flow: {density: 0.1 1/m^2, area: left, portals: [%s, %s], direction: in}\n"
QUEUE = "kind: queue, line: [[%s], [%s]], count: 3, destination: left"
THROUGH = "kind: through, origin: left, destination: %s, count: 3, at_destination: %s"


def _errors(tmp_path: Path, text: str) -> tuple[Diagnostic, ...]:
    path = tmp_path / "hall.yaml"
    path.write_text(text, encoding="utf-8")
    try:
        open_spec(str(path), REGISTRY)
    except SpecError as error:
        return error.diagnostics
    return ()


def _pointed_at(text: str, found: Diagnostic) -> str:
    return text.splitlines()[found.mark.line][found.mark.column :]


@pytest.mark.parametrize(
    ("crowd", "message", "where"),
    [
        (MESH + STREAM % (THROUGH % ("right", "leave")),
         "no way leads stream 'one' from (4.5, 5) to (15.5, 5)", "right, count"),
        (MESH + STREAM % (THROUGH % ("goal, via: [right]", "leave")),
         "no way leads stream 'one' from (4.5, 5) to (15.5, 5)", "right], count"),
        (MESH + STREAM % (THROUGH % ("left, start: right", "return")),
         "no way leads stream 'one' from (15.5, 5) to (4.5, 5)", "left, start"),
        (MESH + STREAM % "kind: wandering, area: left, areas: [here, there], count: 3",
         "no way leads stream 'one' from (4.5, 5) to (15.5, 5)", "there], count"),
        (MESH + STREAM % (QUEUE % ("15 m, 5 m", "19 m, 5 m")),
         "no way leads stream 'one' from (15, 5) to (4.5, 5)", "left}}"),
        (STREAM % (QUEUE % ("8.5 m, 5 m", "19 m, 5 m")),
         "people cannot stand in the queue 'one' at (10.3, 5)", "[[8.5 m"),
        (STREAM % "kind: directions, area: {centre: [10 m, 5 m], size: [0.7 m, 0.7 m]}, count: 1",
         "people of stream 'one' cannot come in around (10, 5)", "{centre"),
        (FLOW % ("a", "within"), "people cannot walk through portal 'within' around (10, 5)",
         "within], direction"),
        (MESH + FLOW % ("a", "b"), "no way leads from portal 'a' around (1, 5) to (19, 5)",
         "[a, b]"),
        ("    agents: [{id: 0, x: 5 m, y: 5 m, portals: [within, a]}]\n",
         "people cannot walk through portal 'within' around (10, 5)", "within, a]"),
    ],
)  # fmt: skip
def test_people(crowd: str, message: str, where: str, tmp_path: Path) -> None:
    text = DOCUMENT + crowd
    (found,) = _errors(tmp_path, text)
    assert (found.code, found.message) == ("E143", message)
    assert _pointed_at(text, found).startswith(where)


@pytest.mark.parametrize(
    "crowd",
    [
        MESH + STREAM % (THROUGH % ("goal", "return")),
        STREAM % (THROUGH % ("right", "leave")),  # who walks straight is stopped by the wall
        STREAM % (QUEUE % ("8.5 m, 5 m", "1 m, 5 m")),
        FLOW % ("a", "b"),
    ],
)
def test_what_is_possible_is_not_refused(crowd: str, tmp_path: Path) -> None:
    assert _errors(tmp_path, DOCUMENT + crowd) == ()


def test_robots(tmp_path: Path) -> None:
    people = STREAM % (THROUGH % ("goal", "return"))
    text = DOCUMENT.replace("goal: {zone: goal}", "goal: {zone: right}") + people
    (found,) = _errors(tmp_path, text)
    assert found.message == "no way leads robot 'robot' from (1, 5) to zone 'right'"
    assert _pointed_at(text, found).startswith("right}, time_limit")
    text = DOCUMENT.replace("[1 m, 5 m, 0 deg]", "[10 m, 5 m, 0 deg]") + people
    (found,) = _errors(tmp_path, text)
    assert found.message == "robot 'robot' starts in a wall, a block or a pillar, at (10, 5)"


@pytest.mark.parametrize("start", ["[7 m, 5 m, 0 deg]", "[6 m, 4 m, 90 deg]"])  # inside; a corner
@pytest.mark.parametrize("border", ["walls", "torus"])
def test_a_start_in_the_goal(start: str, border: str, tmp_path: Path) -> None:
    text = DOCUMENT.replace("[1 m, 5 m, 0 deg]", start) + FLOW % ("a", "b")
    if border == "torus":
        text = text.replace("kind: floor\n", "kind: floor\n    border: torus\n")
    found = next(e for e in _errors(tmp_path, text) if e.code == "E145")
    assert found.message.startswith("robot 'robot' starts in its goal: (")
    assert found.message.endswith("lies in zone 'goal'")
    assert _pointed_at(text, found).startswith(start)


@pytest.mark.parametrize(
    ("kind", "gap", "passes"),
    [("turtlebot2", 0.5, True), ("turtlebot2", 0.3, False), ("qolo", 0.6, False),
     ("qolo", 1.0, True)],
)  # fmt: skip
def test_a_gap_as_wide_as_the_robot(kind: str, gap: float, passes: bool, tmp_path: Path) -> None:
    walls = "walls: {low: {start: [10 m, 0 m], end: [10 m, 5 m], thickness: 0.2 m}, "
    walls += f"high: {{start: [10 m, {5 + gap} m], end: [10 m, 10 m], thickness: 0.2 m}}}}"
    begin, end = DOCUMENT.index("walls: {middle"), DOCUMENT.index("    zones:")
    text = f"{DOCUMENT[:begin]}{walls}\n{DOCUMENT[end:]}" + FLOW % ("a", "b")
    text = text.replace("goal: {zone: goal}", "goal: {zone: right}")
    text = text.replace(
        "  robots.robot.task", f"  robots.robot.model: {{kind: {kind}}}\n  robots.robot.task"
    )
    codes = [e.code for e in _errors(tmp_path, text)]
    assert codes == ([] if passes else ["E143"])


def test_a_wide_robot_beside_a_wall(tmp_path: Path) -> None:
    text = DOCUMENT.replace("[1 m, 5 m, 0 deg]", "[1 m, 0.15 m, 0 deg]") + FLOW % ("a", "b")
    (found,) = _errors(tmp_path, text)
    assert found.message == "robot 'robot' starts in a wall, a block or a pillar, at (1, 0.15)"
    assert found.hint == "there is 0.028 m too little room"


def test_a_goal_behind_a_kerb(tmp_path: Path) -> None:
    text = """\
crowdbot: 1
scenario:
  id: street
  extends: ["builtin:parts/turtlebot2.yaml"]
  environment: {kind: street, kerbs: step, crossings: CROSSINGS}
  robots.robot.task: {start: [0 m, -4.5 m, 0 deg], goal: {zone: roadway}, time_limit: 60 s}
"""
    closed = text.replace("CROSSINGS", "{}")
    (found,) = _errors(tmp_path, closed)
    assert found.message == "no way leads robot 'robot' from (0, -4.5) to zone 'roadway'"
    assert _pointed_at(closed, found).startswith("roadway}, time_limit")
    assert _errors(tmp_path, text.replace("CROSSINGS", "{c: {at: 5 m}}")) == ()


def test_robots_drive_under_what_hangs(tmp_path: Path) -> None:
    text = DOCUMENT.replace("goal: {zone: goal}", "goal: {zone: right}")
    text = text.replace("thickness: 0.2 m", "thickness: 0.2 m, base: 1.2 m, height: 2 m")
    assert _errors(tmp_path, text + STREAM % (THROUGH % ("goal", "return"))) == ()


# ------------------------------------------------------------------------ floor plans
def _plan(zones: str, **fields: object) -> str:
    words = "".join(f"    {key}: {json.dumps(value)}\n" for key, value in fields.items())
    head, _, tail = DOCUMENT.partition("    kind: floor\n")
    tail = tail[tail.index("  robots.robot") : tail.index("    goal_areas")]
    return f"{head}    kind: floor_plan\n{words}    zones: {zones}\n{tail}" + (
        "    streams: {one: {kind: through, origin: goal, destination: goal, count: 1}}\n"
    )


def test_swapped_axes(tmp_path: Path) -> None:
    wkt = "POLYGON ((0 0, 6 0, 6 20, 0 20, 0 0))"  # x and y of the zones are the other way round
    text = _plan("{left: {x: [1, 3], y: [1, 3]}, goal: {x: [15, 18], y: [2, 4]}}", wkt=wkt)
    zone, *_ = _errors(tmp_path, text)
    assert (zone.code, zone.message) == ("E132", "zone 'goal' lies outside of the environment")
    assert zone.hint == "it reaches from (0, 0) to (6, 20); are x and y swapped?"
    assert _pointed_at(text, zone).startswith("{x: [15")


@pytest.mark.parametrize(
    ("size", "unit", "message"),
    [
        ("20000 10000", "m", "wkt: the plan is 20000 m × 10000 m, more than 5000 m; its numbers "
         "count as m: see 'unit'"),
        ("20 10", "mm", "wkt: there is neither a floor nor a wall in it; all of it is 0.02 m × "
         "0.01 m and left away: see 'unit'"),
    ],
)  # fmt: skip
def test_wrong_units(size: str, unit: str, message: str, tmp_path: Path) -> None:
    x, y = size.split()
    wkt = f"POLYGON ((0 0, {x} 0, {x} {y}, 0 {y}, 0 0))"
    zones = "{left: {x: [1, 3], y: [1, 9]}, goal: {x: [5, 8], y: [2, 4]}}"
    (found,) = _errors(tmp_path, _plan(zones, wkt=wkt, unit=unit))
    assert (found.code, found.message) == ("E144", message)


def test_a_bow_tie_without_area_is_said_to_cross_itself(tmp_path: Path) -> None:
    block = "[[1 m, 1 m], [4 m, 4 m], [4 m, 1 m], [1 m, 4 m]]"
    text = DOCUMENT.replace(
        "    zones:\n", f"    blocks: {{b: {{corners: {block}}}}}\n    zones:\n"
    )
    (found,) = _errors(tmp_path, text + FLOW % ("a", "b"))
    assert "the side from (1, 1) to (4, 4) meets the one from (4, 1) to (1, 4)" in found.message


#: A floor of 10 m by 10 m without its upper right quarter.
CORNER = """\
crowdbot: 1
scenario:
  id: corner
  extends: ["builtin:parts/turtlebot2.yaml"]
  environment:
    kind: floor_plan
    wkt: "POLYGON ((0 0, 10 0, 10 5, 5 5, 5 10, 0 10, 0 0))"
    zones: {goal: {x: [7 m, 9 m], y: [1 m, 3 m]}}
  robots.robot.task: {start: [%s m, 0 deg], goal: {zone: goal}, time_limit: 60 s}
  crowd:
    policy: {kind: velocity_space}
    costs: {avoid: {kind: ttca_dca, weight: 20, range: 5 m}}
    routing: {kind: mesh}
    agents: [{id: 4, x: %s m, y: %s m, speed: 1 m/s, goals: [[%s]]}]
"""


@pytest.mark.parametrize(
    ("start", "agent", "expected"),
    [
        ("1 m, 8", ("1", "1", "1, 4"), ""),
        ("8 m, 8", ("1", "1", "1, 4"),
         "the start (8, 8) of robot 'robot' lies outside the walls that enclose zone 'goal'"),
        ("1 m, 8", ("8", "8", "1, 4"),
         "the place (8, 8) of agent 4 lies outside the walls that enclose (1, 4)"),
        ("1 m, 8", ("1", "1", "1, 4], [7, 8"),
         "the goal (7, 8) of agent 4 lies outside the walls that enclose (1, 4)"),
    ],
)  # fmt: skip
def test_a_place_in_the_corner_that_a_floor_leaves_out_is_outside(
    start: str, agent: tuple[str, str, str], expected: str, tmp_path: Path
) -> None:
    found = _errors(tmp_path, CORNER % (start, *agent))
    assert [(d.code, d.message) for d in found] == ([("E132", expected)] if expected else [])
