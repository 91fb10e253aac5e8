"""The cases of the decision table of fault: what robot and people do, and whose fault it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import crowdbot
from crowdbot.core.types.arrays import Array

T = np.arange(0.0, 8.001, 1.0 / 16.0)
ROBOT, PERSON = 0.18, 0.16
REACH = ROBOT + PERSON
#: A wheelchair-sized outline, m.
LONG = np.array([[0.6, 0.3], [-0.6, 0.3], [-0.6, -0.3], [0.6, -0.3]])
_ZERO = np.zeros_like(T)


@dataclass(frozen=True, slots=True, kw_only=True)
class Track:
    """Positions of a body, (N,) each, m; NaN where it is absent. ``theta`` (rad) of a robot."""

    x: Array
    y: Array
    theta: Array = field(default_factory=lambda: _ZERO)


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A meeting of a robot with people.

    Attributes:
        name: of its picture.
        told: what happens.
        fault: True if the contact with the first person is the robot's fault.
        rule: the line of the decision table that says so.
        robot, people: their tracks.
        shown: times that are drawn, s.
        outline: True for the long robot.
    """

    name: str
    told: str
    fault: bool
    rule: str
    robot: Track
    people: tuple[Track, ...]
    shown: tuple[float, ...]
    outline: bool = False

    def run(self, t: Array = T) -> crowdbot.Trajectories:
        """Return the case as a run, sampled at other times if they are given, (N,) s."""
        r, people = _at(self.robot, t), [_at(p, t) for p in self.people]
        robot: dict[str, Any] = {
            "robot_x": r.x, "robot_y": r.y, "robot_theta": r.theta,
            "robot_w": np.gradient(r.theta, t), "robot_radius": ROBOT, "robot_mass": 6.3,
            "robot_vx": np.gradient(r.x, t), "robot_vy": np.gradient(r.y, t),
            "robot_goal": (20.0, 0.0), "robot_speed_limit": 0.65,
        }  # fmt: skip
        if self.outline:
            robot["robot_footprint"] = LONG
        crowd: dict[str, Any] = {
            "agent_x": np.column_stack([p.x for p in people]),
            "agent_y": np.column_stack([p.y for p in people]),
            "agent_radius": PERSON, "agent_mass": 75.0,
        }  # fmt: skip
        return crowdbot.Trajectories.from_arrays(t=t, **robot, **crowd)


def _at(track: Track, t: Array) -> Track:
    """Return a track at other times, (N,) s."""
    if t is T:
        return track
    return Track(**{name: np.interp(t, T, getattr(track, name)) for name in ("x", "y", "theta")})


def _path(velocity: Callable[[Array], Array], start: float = 0.0) -> Array:
    """Return positions (N,) of a body with a velocity at the middle of each step, m."""
    steps = velocity((T[1:] + T[:-1]) / 2.0) * np.diff(T)
    return start + np.concatenate([[0.0], np.cumsum(np.broadcast_to(steps, len(T) - 1))])


def _still(x: float, y: float = 0.0) -> Track:
    return Track(x=_ZERO + x, y=_ZERO + y)


def _straight(x: float, y: float, vx: float, vy: float = 0.0) -> Track:
    return Track(x=x + vx * T, y=y + vy * T, theta=_ZERO)


def _shoved_by(robot: Track, x: float) -> Track:
    """Return a person at x until the robot comes, which pushes the person along."""
    return Track(x=np.maximum(x, robot.x + REACH - 0.005), y=_ZERO)


def _until(time: float, before: float, after: float) -> Callable[[Array], Array]:
    return lambda t: np.where(t < time, before, after)


def _braking(speed: float, begins: float, rate: float = 1.0) -> Track:
    return Track(x=_path(lambda t: np.clip(speed - rate * (t - begins), 0.0, speed)), y=_ZERO)


def _comes_until(robot: Track, start: float, speed: float) -> Track:
    """Return a person who comes along x and stops at the robot."""
    return Track(x=np.maximum(start - speed * T, robot.x + REACH - 0.005), y=_ZERO)


def _all() -> tuple[Case, ...]:
    slow = Track(x=_path(_until(3.0, 0.04, 0.5)), y=_ZERO)
    waits = Track(x=_path(_until(5.0, 0.0, 0.5)), y=_ZERO)
    parked = _still(0.0)
    creeps = _straight(0.0, 0.0, 0.04)
    late = Track(x=_path(_until(3.0, 0.0, 0.4)), y=_ZERO)
    leaves = Track(x=_path(_until(2.0, 0.0, 1.0), REACH - 0.005), y=_ZERO)
    brakes = _braking(0.5, 3.6)
    aside = Track(x=0.5 * T, y=_path(lambda t: np.where((t > 3.0) & (t < 4.6), 0.5, 0.0), -0.8))
    over = Track(x=0.5 * T, y=_path(lambda t: np.where((t > 4.0) & (t < 4.6), 0.5, 0.0), -0.48))
    meets = Track(x=0.5 * T, y=_path(lambda t: np.where((t > 4.0) & (t < 4.4), -0.6, 0.0)))
    slows = _braking(0.5, 2.0)
    shoved = Track(x=_path(_until(3.0, 0.0, 0.2)), y=_ZERO)
    turning = Track(x=_ZERO, y=_ZERO, theta=np.clip(T - 3.0, 0.0, 1.2))
    thrown = np.where(T < 4.0, 0.85, 0.05 + np.abs(0.8 - 2.5 * (T - 4.0)))
    return (
        Case(name="drives_into", told="drives into a person who stands", fault=True,
             rule="driven", robot=_straight(0, 0, 0.5), people=(_still(3.0),),
             shown=(2.0, 4.0, 5.3)),
        Case(name="head_on", told="drives on blindly at a person who comes towards it", fault=True,
             rule="driven", robot=_straight(0, 0, 0.5), people=(_straight(6.0, 0.0, -1.3),),
             shown=(1.5, 2.3, 3.1)),
        Case(name="comes_over", told="turns at once into a person who walks beside it", fault=True,
             rule="came_over", robot=over, people=(_straight(0.0, 0.0, 0.5),),
             shown=(3.0, 4.0, 4.4)),
        Case(name="meets_halfway", told="and a person beside it turn to each other at once",
             fault=False, rule="braked", people=(meets,),
             robot=Track(x=over.x, y=over.y - 0.1), shown=(3.0, 4.0, 4.3)),
        Case(name="reverses", told="reverses into a person behind it", fault=True, rule="driven",
             robot=Track(x=-0.4 * T, y=_ZERO), people=(_still(-2.0),), shown=(1.0, 3.0, 4.1)),
        Case(name="turns_into", told="turns on the spot, and its end sweeps into a person",
             fault=True, rule="driven", robot=turning, people=(_still(0.35, 0.62),),
             shown=(3.0, 3.3, 3.6), outline=True),
        Case(name="stands", told="stands, and a person walks into it", fault=False,
             rule="stands", robot=parked, people=(_comes_until(parked, 3.0, 1.0),),
             shown=(1.0, 2.0, 3.0)),
        Case(name="struck_from_behind", told="drives on, and a faster person walks into its back",
             fault=False, rule="stands", robot=_straight(0, 0, 0.5),
             people=(_straight(-3.0, 0.0, 1.3),), shown=(1.0, 2.0, 3.3)),
        Case(name="brakes", told="brakes as soon as the contact is foreseeable", fault=False,
             rule="braked", robot=brakes, people=(_comes_until(brakes, 8.0, 1.3),),
             shown=(3.0, 3.8, 4.4)),
        Case(name="thrown_against", told="a person is thrown against it from the side at once",
             fault=False, rule="braked", robot=_straight(0, 0, 0.5),
             people=(Track(x=0.28 + 0.5 * T, y=thrown),), shown=(3.6, 4.0, 4.2)),
        Case(name="lands", told="a person appears a hand's breadth before it, and it brakes",
             fault=False, rule="braked", robot=_braking(0.5, 4.3),
             people=(Track(x=np.where(T < 4.0, np.nan, 2.0 + REACH + 0.06), y=_ZERO),),
             shown=(3.0, 4.0, 4.7)),
        Case(name="gentle_then_shoves", told="touches a person gently, then shoves", fault=True,
             rule="pushed", robot=slow, people=(_shoved_by(slow, REACH + 0.1),),
             shown=(2.0, 4.0, 6.0)),
        Case(name="touched_then_drives", told="stands, is touched, and drives on", fault=True,
             rule="pushed", robot=waits,
             people=(_comes_until(waits, 3.0, 1.0),),
             shown=(2.0, 4.5, 7.0)),
        Case(name="creeps_on", told="creeps on for metres with a person before it", fault=True,
             rule="pushed", robot=creeps, people=(_shoved_by(creeps, REACH + 0.02),),
             shown=(0.5, 4.0, 8.0)),
        Case(name="touched_and_waits", told="stands, is touched, and waits", fault=False,
             rule="stands", robot=parked, people=(_comes_until(parked, 2.0, 0.5),),
             shown=(1.0, 3.0, 7.0)),
        Case(name="starts_in_touch", told="starts in touch and drives on", fault=True,
             rule="pushed", robot=late, people=(_shoved_by(late, REACH - 0.005),),
             shown=(1.0, 4.0, 6.0)),
        Case(name="starts_and_waits", told="starts in touch, and waits until the person has left",
             fault=False, rule="stands", robot=late, people=(leaves,), shown=(1.0, 3.0, 5.0)),
        Case(name="shoved", told="is shoved against one person by another", fault=False,
             rule="shoved", robot=shoved,
             people=(_shoved_by(shoved, REACH - 0.003),
                     Track(x=np.minimum(T - 3.0, shoved.x - REACH + 0.005), y=_ZERO)),
             shown=(1.0, 3.0, 5.0)),
        Case(name="shoved_into", told="stands, and one person shoves it into another",
             fault=False, rule="shoved", robot=shoved,
             people=(_shoved_by(shoved, REACH + 0.15),
                     Track(x=np.minimum(T - 3.0, shoved.x - REACH + 0.005), y=_ZERO)),
             shown=(1.0, 3.0, 5.0)),
        Case(name="rides_ahead", told="drives into one person while another touches its back",
             fault=True, rule="driven", robot=_straight(0, 0, 0.3),
             people=(_shoved_by(_straight(0, 0, 0.3), 1.5),
                     _straight(-REACH + 0.005, 0.0, 0.3)),
             shown=(1.0, 3.0, 5.0)),
        Case(name="cuts_in", told="cuts in before a faster person", fault=True, rule="cut_in",
             robot=aside, people=(_straight(-2.3, 0.0, 1.0),), shown=(2.5, 3.5, 4.4)),
        Case(name="slows_down", told="slows down on its way before a faster person", fault=False,
             rule="stands", robot=slows, people=(_straight(-2.0, 0.0, 1.0),),
             shown=(1.0, 2.0, 2.9)),
        Case(name="crosses", told="crosses close before a faster person", fault=True,
             rule="cut_in", robot=Track(x=_ZERO + 4.0, y=-1.4 + 0.5 * T, theta=_ZERO + np.pi / 2),
             people=(_straight(-0.35, 0.0, 1.3),), shown=(1.5, 2.2, 3.0)),
    )  # fmt: skip


CASES = _all()
