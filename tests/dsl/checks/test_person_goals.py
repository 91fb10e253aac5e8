"""Goals that are people who do not exist, or do not fit the task, are errors with their place."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())
DOCUMENT = """\
crowdbot: 1
scenario:
  id: hall
  extends: ["builtin:parts/turtlebot2.yaml"]
  environment:
    kind: floor
    area: {x: [0 m, 20 m], y: [0 m, 10 m]}
    zones: {floor: {x: [0 m, 20 m], y: [0 m, 10 m]}, exit: {x: [15 m, 18 m], y: [4 m, 6 m]}}
    portals: {a: {x: [0 m, 2 m], y: [0 m, 10 m]}, b: {x: [18 m, 20 m], y: [0 m, 10 m]}}
  robots.robot.task: {start: [1 m, 5 m, 0 deg], time_limit: 60 s, goal: GOAL}
  crowd:
    speed: {mean: 1.3 m/s, std: 0.1 m/s}
    policy: {kind: velocity_space}
    costs: {avoid: {kind: ttca_dca, weight: 20, range: 5 m}}
    goal_areas: {there: {area: exit}}
    agents:
      - {id: 3, x: 5 m, y: 5 m, goals: [[5 m, 5 m]], group: 1}
      - {id: 4, x: 8 m, y: 5 m, goals: [[12 m, 5 m]]}
      - {id: 5, x: 8 m, y: 7 m, goals: [[12 m, 5 m]], start_time: 3 s}
      - {id: 6, x: 8 m, y: 8 m, portals: [a, b]}
    spawns:
      seats: {area: {centre: [4 m, 8 m], size: [2 m, 2 m]}, count: 2, standing: true}
      late: {area: {centre: [4 m, 2 m], size: [2 m, 2 m]}, count: 2, standing: true,
             start_time: 2 s}
      walkers: {area: {centre: [9 m, 2 m], size: [2 m, 2 m]}, count: 2, goals: {areas: [there]}}
      jumpers: {area: {centre: [13 m, 2 m], size: [2 m, 2 m]}, count: 2, portals: [a, b]}
    streams:
      north: {kind: through, origin: floor, destination: exit, count: 2}
      steady: {kind: through, origin: floor, destination: exit, arrivals: {every: 2 s,
                until: 9 s}}
"""


def _errors(tmp_path: Path, text: str) -> tuple[Diagnostic, ...]:
    path = tmp_path / "hall.yaml"
    path.write_text(text, encoding="utf-8")
    try:
        open_spec(str(path), REGISTRY)
    except SpecError as error:
        return error.diagnostics
    return ()


@pytest.mark.parametrize(
    ("goal", "code", "message", "at"),
    [
        ("approach, person: {agent: 9}", "E146", "there is no agent 9", "9}"),
        ("follow, person: {group: 2}", "E146", "no agent belongs to group 2", "2}"),
        ("follow, person: {agent: 5}", "E146", "agent 5 is not there at the start", "5}"),
        ("follow, person: {spawn: late}", "E146", "spawn 'late' is not there", "late"),
        ("follow, person: {stream: steady}", "E146", "stream 'steady' is not there", "steady"),
        ("approach, person: {spawn: hall}", "E130", "the crowd has no spawn 'hall'", "hall"),
        ("approach, person: {stream: south}", "E130", "the crowd has no stream 'south'", "south"),
        ("follow, person: {agent: 6}", "E147", "agent 6 goes through portals", "6}"),
        ("follow, person: {spawn: jumpers}", "E147", "spawn 'jumpers' goes through", "jumpers"),
        ("lead, zone: exit, person: {agent: 4}", "E147", "agent 4 has a way of its own", "{agent"),
        ("lead, zone: exit, person: {spawn: walkers}", "E147", "spawn 'walkers' has a", "{spawn"),
        ("lead, zone: exit, person: {stream: north}", "E147", "stream 'north' has a way", "{str"),
        ("lead, zone: exti, person: {agent: 3}", "E130", "no zone 'exti'", "exti"),
        ("lead, zone: floor, person: {agent: 3}", "E145", "starts in its goal", "[1 m, 5 m"),
        ("approach, person: {}", "E115", "not none", "{}"),
        ("approach, person: {agent: 3, spawn: seats}", "E115", "not 'agent' and 'spawn'", "{ag"),
        ("follow, person: {group: 1, whole_group: true}", "E115", "write 'group' instead", "{gr"),
        ("follow, person: {agent: 3}, tolerance: 2 m", "E115", "never in place", "{kind"),
        ("lead, zone: exit, person: {agent: 3}, keeps: 5 m", "E115", "never walk", "{kind"),
        ("fetch, person: {agent: 3}", "E120", "unknown component kind 'fetch'", "fetch"),
        ("approach, zone: exit, person: {agent: 3}", "E102", "unknown field 'zone'", "zone"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(
    goal: str, code: str, message: str, at: str, tmp_path: Path
) -> None:
    text = DOCUMENT.replace("GOAL", f"{{kind: {goal}}}")
    (found,) = _errors(tmp_path, text)
    assert (found.code, message in found.message) == (code, True), found.message
    assert text.splitlines()[found.mark.line][found.mark.column :].startswith(at)


def test_a_scenario_without_people(tmp_path: Path) -> None:
    text = DOCUMENT.replace("GOAL", "{kind: follow, person: {agent: 3}}")
    (found,) = _errors(tmp_path, text.partition("  crowd:")[0])
    assert found.code == "E146"
    assert found.message == "the goal of robot 'robot' is agent 3, and there are no people"


@pytest.mark.parametrize(
    ("start", "heading", "there"),
    [
        ("3 m, 5 m, 0 deg", "180 deg", True),
        ("3 m, 5.5 m, 20 deg", "150 deg", True),
        ("1 m, 5 m, 0 deg", "180 deg", False),  # too far
        ("4.2 m, 5 m, 0 deg", "180 deg", False),  # too near
        ("3 m, 5 m, 0 deg", "0 deg", False),  # behind the person
        ("3 m, 5 m, 180 deg", "180 deg", False),  # looks away
    ],
)
def test_a_start_in_place_before_a_person_who_stands(
    start: str, heading: str, there: bool, tmp_path: Path
) -> None:
    text = DOCUMENT.replace("GOAL", "{kind: approach, person: {agent: 3}}")
    text = text.replace("1 m, 5 m, 0 deg", start)
    text = text.replace("[[5 m, 5 m]], group: 1", f"[[5 m, 5 m]], heading: {heading}, group: 1")
    found = _errors(tmp_path, text)
    assert [d.code for d in found] == ["E145"] * there
    walks = text.replace("[[5 m, 5 m]]", "[[5 m, 5 m], [9 m, 5 m]]")
    assert not _errors(tmp_path, walks)


@pytest.mark.parametrize(
    "goal",
    [
        "approach, person: {agent: 3}",
        "approach, person: {group: 1}",
        "follow, person: {spawn: walkers}",
        "accompany, person: {stream: north, whole_group: true}, side: left, knows: told",
        "lead, zone: exit, person: {agent: 3}",
        "lead, zone: exit, person: {spawn: seats}",
    ],
)
def test_what_fits_is_not_refused(goal: str, tmp_path: Path) -> None:
    assert _errors(tmp_path, DOCUMENT.replace("GOAL", f"{{kind: {goal}}}")) == ()


@pytest.mark.parametrize("kind", ["approach", "follow", "accompany", "lead, zone: exit"])
def test_a_person_to_whom_no_way_leads(kind: str, tmp_path: Path) -> None:
    text = DOCUMENT.replace("GOAL", f"{{kind: {kind}, person: {{agent: 3}}}}")
    wall = "walls: {w: {start: [2 m, 0 m], end: [2 m, 10 m]}}\n    zones: {floor"
    walled = text.replace("zones: {floor", wall)
    found = _errors(tmp_path, walled)
    expected = "no way leads robot 'robot' from (1, 5) to agent 3"
    (error,) = [d for d in found if d.message == expected]
    assert error.code == "E143"
    line = walled.splitlines()[error.mark.line]
    assert line[error.mark.column :].startswith("{agent")
    gap = walled.replace("end: [2 m, 10 m]", "end: [2 m, 8 m]")
    assert _errors(tmp_path, gap) == ()


def test_a_person_who_comes_to_this_side_can_be_reached(tmp_path: Path) -> None:
    text = DOCUMENT.replace("GOAL", "{kind: follow, person: {agent: 4}}")
    walled = text.replace(
        "zones: {floor", "walls: {w: {start: [2 m, 0 m], end: [2 m, 10 m]}}\n    zones: {floor"
    )
    assert [d.code for d in _errors(tmp_path, walled)] == ["E143"]
    there = walled.replace(
        "x: 8 m, y: 5 m, goals: [[12 m, 5 m]]", "x: 8 m, y: 5 m, goals: [[1 m, 9 m]]"
    )
    assert "E143" not in {d.code for d in _errors(tmp_path, there) if "robot" in d.message}


def test_two_robots_cannot_lead_the_same_person(tmp_path: Path) -> None:
    goal = "{kind: lead, zone: exit, person: {agent: 3}}"
    other = (
        "  robots.other: {model: {kind: turtlebot2}, sensors: {}, "
        f"task: {{start: [1 m, 2 m, 0 deg], goal: {goal}}}}}\n"
    )
    text = DOCUMENT.replace("GOAL", goal).replace("  crowd:\n", f"{other}  crowd:\n")
    (found,) = _errors(tmp_path, text)
    assert (found.code, "both lead agent 3" in found.message) == ("E147", True)
