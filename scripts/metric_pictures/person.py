"""Pictures of metrics about the person of a task. The run has none: one is made up."""

from __future__ import annotations

import numpy as np

from crowdbot.core.trajectories.person_track import PersonStance, person_stance
from scripts.metric_pictures.figure import BAD, ROBOT, Figure
from scripts.metric_pictures.registry import draws
from scripts.metric_pictures.world import JUMP, World, with_made_up_person


def _stance(world: World) -> PersonStance:
    run = world.run if world.run.person is not None else with_made_up_person(world.run)
    found = person_stance(run, JUMP)
    assert isinstance(found, PersonStance)
    return found


def _gap(world: World, metric: str) -> Figure:
    found = _stance(world)
    figure = world.over_time(metric, "gap in m", min(-0.1, float(np.nanmin(found.gap))), 6.0)
    return figure.line(world.t, found.gap, ROBOT, "gap to the person")


@draws("time_in_place", "Gap to the person; the time in which the robot is in its place.")
def _time_in_place(world: World, metric: str) -> Figure:
    return _gap(world, metric).spans(world.t, _stance(world).in_place, "in place")


@draws("time_to_place", "Gap to the person; the first time at which the robot is in its place.")
def _time_to_place(world: World, metric: str) -> Figure:
    found = _stance(world)
    k = int(np.argmax(found.in_place))
    figure = _gap(world, metric).spans(world.t, found.in_place, "in place")
    return figure.dots([world.t[k]], [found.gap[k]], BAD, "first time")


@draws("assisted", "Gap to the person, the robot's place, and the least gap that is allowed.")
def _assisted(world: World, metric: str) -> Figure:
    figure = _gap(world, metric).spans(world.t, _stance(world).in_place, "in place")
    return figure.level(0.45, "least gap", BAD)


@draws(
    "person_distance_error",
    "Gap to the person and the wanted one; the mean difference is the score.",
)
def _distance_error(world: World, metric: str) -> Figure:
    return _gap(world, metric).level(_stance(world).task.distance, "wanted", BAD)


@draws("person_angle_error", "Direction from the person to the robot, off the wanted one.")
def _angle_error(world: World, metric: str) -> Figure:
    found = _stance(world)
    rows = [(world.t, found.aside, ROBOT, "angle off the wanted direction")]
    return world.lines(metric, "angle in rad", rows)


@draws("person_comfort", "Discomfort of the person; half its mean and half its peak are lost.")
def _comfort(world: World, metric: str) -> Figure:
    gap = np.maximum(_stance(world).gap, 0.0)
    speed = np.maximum(_stance(world).advance, 1e-9)
    felt = np.clip(np.maximum(1.0 - gap / 0.45, 1.0 - gap / speed), 0.0, 1.0)
    return world.lines(metric, "discomfort", [(world.t, felt, ROBOT, "discomfort")])
