"""The run that all pictures of metrics are drawn from, and what several of them draw."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

import crowdbot
from crowdbot.core.scoring.evaluate import Scores
from crowdbot.core.trajectories.encounters import (
    Encounter,
    approach,
    encounter,
    people,
    people_speeds,
    robot_velocities,
)
from crowdbot.core.trajectories.preprocess import truncate_at_arrival
from crowdbot.core.trajectories.questionnaires import TLX_SCALES
from crowdbot.core.trajectories.tracks import AgentTracks, RobotTrack
from crowdbot.core.types.person_task import PersonTask, TaskPerson
from scripts.metric_pictures.figure import PERSON, QUIET, ROBOT, Array, Figure, number

JUMP = 10.0
#: Answers are not in a recording: these are made up for the pictures.
ANSWERS: dict[str, object] = {
    "nasa_tlx": dict(zip(TLX_SCALES, (55, 20, 65, 35, 50, 40), strict=True)),
    "use": {
        "usefulness": [6, 5, 6, 5, 4, 6, 5, 6],
        "ease_of_use": [6, 6, 5, 6, 7, 6, 5, 6, 6, 7, 6],
        "ease_of_learning": [7, 6, 7, 7],
        "satisfaction": [5, 4, 5, 5, 4, 5, 4],
    },
}


@dataclass(frozen=True)
class World:
    """A run up to the robot's arrival, the two runs that it is compared with, and all scores.

    Attributes:
        whole: the run as it was recorded.
        run: up to the arrival.
        alone: the robot without people.
        crowd: the people without the robot.
        commands: the user's and the final ones.
        scores: of all metrics.
    """

    whole: crowdbot.Trajectories
    run: crowdbot.Trajectories
    alone: crowdbot.Trajectories
    crowd: crowdbot.Trajectories
    commands: crowdbot.Commands
    scores: Scores

    @classmethod
    def of(cls, made: crowdbot.Run) -> World:
        """Everything from one run directory.

        Raises:
            ValueError: a reference is missing, or the robot did not arrive.
        """
        whole, refs = with_made_up_person(made.trajectories), made.references
        alone, crowd = refs.robot_alone, refs.crowd_alone
        if alone is None or crowd is None or whole.robot is None or whole.robot.goal_time is None:
            raise ValueError("the pictures need a run that arrived, with both references")
        commands = made_up_commands(whole)
        scores = crowdbot.score(
            whole, alone, crowd, commands=commands, questionnaires=ANSWERS, metrics=all_metrics()
        )
        run = truncate_at_arrival(whole)
        return cls(whole, run, truncate_at_arrival(alone), crowd, commands, scores)

    @property
    def t(self) -> Array:
        """(N,) s."""
        return self.run.t

    @property
    def robot(self) -> RobotTrack:
        """The robot in the crowd."""
        assert self.run.robot is not None
        return self.run.robot

    @property
    def lone(self) -> RobotTrack:
        """The robot without people."""
        assert self.alone.robot is not None
        return self.alone.robot

    @property
    def agents(self) -> AgentTracks:
        """The people around the robot."""
        return people(self.run)

    @cached_property
    def pair(self) -> Encounter:
        """Every person relative to the robot."""
        return encounter(self.run, JUMP)

    @cached_property
    def gap(self) -> Array:
        """(N,) m from the robot to the nearest person."""
        return np.asarray(np.nanmin(self.pair.gap, axis=1), dtype=float)

    @cached_property
    def distance(self) -> Array:
        """(N,) m from the robot's centre to the nearest person's."""
        return np.asarray(np.nanmin(self.pair.distance, axis=1), dtype=float)

    @cached_property
    def time_to_collision(self) -> Array:
        """(N,) s, to whom the robot would touch first."""
        return np.asarray(approach(self.run, JUMP, 1e-9, 1e-9)[0].min(axis=1), dtype=float)

    @cached_property
    def speed(self) -> Array:
        """(N,) m/s of the robot."""
        return np.hypot(*robot_velocities(self.run, JUMP))

    @cached_property
    def walking(self) -> Array:
        """(N, M) m/s of people."""
        return people_speeds(self.run, JUMP)

    @cached_property
    def near(self) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """(N, M) whose centre is within 3 m of the robot's."""
        return np.nan_to_num(self.pair.distance, nan=np.inf) <= 3.0

    def to_zone(self, run: crowdbot.Trajectories) -> Array:
        """(N,) m from the robot to the goal zone, straight."""
        robot, zone = run.robot, run.goal_zone
        assert robot is not None
        assert zone is not None
        low, high = zone.min(axis=0), zone.max(axis=0)
        dx = np.maximum(np.maximum(low[0] - robot.x, robot.x - high[0]), 0.0)
        dy = np.maximum(np.maximum(low[1] - robot.y, robot.y - high[1]), 0.0)
        return np.asarray(np.hypot(dx, dy), dtype=float)

    def title(self, metric: str) -> str:
        """Name, symbol and the value of the first variant that people are told."""
        of_metric = [s for s in self.scores if s.metric == metric]
        first = ("rate", "corrected", "avg", "mean", "robot")
        shown = min(of_metric, key=lambda s: first.index(s.variant) if s.variant in first else 9)
        if shown.value is None:
            shown = next((s for s in of_metric if s.value is not None), shown)
        value = f"{shown.status}: {shown.reason}" if shown.value is None else number(shown.value)
        unit = "" if shown.unit in ("1", "") or shown.value is None else f" {shown.unit}"
        return f"{metric.replace('_', ' ')}: {shown.symbol} = {value}{unit} ({shown.variant})"

    # ------------------------------------------------------------ figures to begin with
    def over_time(self, metric: str, label: str, low: float, high: float) -> Figure:
        """Axes over the time of the run."""
        ends = (float(self.t[0]), float(self.t[-1]))
        return Figure(self.title(metric), ("time in s", *ends), (label, low, high))

    def lines(self, metric: str, label: str, rows: list[tuple[Array, Array, str, str]]) -> Figure:
        """Several lines over time: times, values, colour, name; the axis begins at 0 or below."""
        values = np.concatenate([r[1][np.isfinite(r[1])] for r in rows])
        low, high = min(0.0, float(values.min())), float(values.max())
        end = max(float(r[0][-1]) for r in rows)
        room = 0.06 * (high - low)
        figure = Figure(
            self.title(metric),
            ("time in s", float(self.t[0]), end),
            (label, low - (room if low else 0), high + room),
        )
        for t, y, colour, name in rows:
            figure.line(t, y, colour, name)
        return figure

    def plane(self, metric: str) -> Figure:
        """The corridor from above with its walls."""
        assert self.run.walls is not None
        walls = self.run.walls
        xs, ys = walls[:, [0, 2]], walls[:, [1, 3]]
        figure = Figure(
            self.title(metric),
            ("x in m", max(0.0, float(xs.min())), min(14.0, float(xs.max()))),
            ("y in m", float(ys.min()) - 0.1, float(ys.max()) + 0.1),
            equal=True,
        )
        for x0, y0, x1, y1 in walls:
            figure.line(np.array([x0, x1]), np.array([y0, y1]), "#333", wide=1.2)
        return figure

    def bodies(self, figure: Figure, k: int, *, who: Callable[[int], bool] | None = None) -> Figure:
        """Everybody at sample k, with the way of the next second; those of ``who`` in full."""
        agents, robot = self.agents, self.robot
        for j in range(agents.x.shape[1]):
            x, y = agents.x[k, j], agents.y[k, j]
            if not math.isfinite(x):
                continue
            full = who is None or who(j)
            colour = PERSON if full else QUIET
            figure.disc(float(x), float(y), float(agents.radius[j]), colour, full=full)
            ahead = np.array([0.0, 1.0])
            figure.line(x + agents.vx[k, j] * ahead, y + agents.vy[k, j] * ahead, colour)
        figure.disc(float(robot.x[k]), float(robot.y[k]), robot.radius, ROBOT)
        return figure


def all_metrics() -> list[str]:
    """Names of crowdbot's own metrics that have no successor."""
    from crowdbot.core.registry.registry import discover

    found = discover(entry_points=False).components("metric")
    return sorted(name for name, c in found.items() if not c.successor)


def made_up_commands(run: crowdbot.Trajectories) -> crowdbot.Commands:
    """What the robot did as the final command, and a user who would have gone straight on.

    Nobody steered the run; the user is made up for the pictures: he corrects late and in steps.
    """
    robot = run.robot
    assert robot is not None
    t = np.arange(float(run.t[0]), float(run.t[-1]), 0.15)
    v, w = np.interp(t, run.t, robot.v), np.interp(t, run.t, robot.w)
    late = np.interp(t - 0.3, t, w)
    return crowdbot.Commands.from_arrays(
        t=t - t[0], v_user=np.round(0.5 + 0.1 * np.sin(0.9 * t), 1), w_user=np.round(late * 1.4, 1),
        v_sc=v, w_sc=w, v_max=0.65, w_max=3.14, t_end=float(t[-1] - t[0]) + 0.15,
    )  # fmt: skip


def with_made_up_person(run: crowdbot.Trajectories) -> crowdbot.Trajectories:
    """The run as if the robot were to come to the front of the person whom it comes nearest."""
    gap = encounter(run, JUMP).gap
    nearest = int(np.argmin(np.nanmin(np.where(np.isnan(gap), np.inf, gap), axis=0)))
    task = PersonTask(kind="approach", distance=1.5, tolerance=1.0, angle=0.8, hold=2.0)
    who = TaskPerson(task=task, id=people(run).id[[nearest]], facing=np.zeros(1))
    return replace(run, person=who)


def mean_of(values: Array) -> Array:
    """Mean of each row over what is there."""
    there = np.isfinite(values)
    count = there.sum(axis=1)
    total = np.where(there, values, 0.0).sum(axis=1)
    mean: Array = np.divide(total, count, out=np.full(len(total), np.nan), where=count > 0)
    return mean
