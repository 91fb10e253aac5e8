"""RunLog: converts states to the rows of a recording: samples, trips, contacts.

The recording defines the run: scores, replay and hashes are computed from its contents.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import state as s
from crowdbot.core.planning.drawn import Drawn
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotState


class RunLog:
    """Records samples, trips and contacts, each event once, in the order of agents."""

    def __init__(
        self,
        writer: RecordingWriter,
        agent_id: NDArray[np.int64],
        *,
        sideways: bool = False,
        people: bool = True,
        robot: int | None = 0,
        goal_column: int = s.GOAL_X,
        on_sample: Callable[[float, Sequence[float] | None, Array | None], None] | None = None,
        on_drawing: Callable[[float, Drawn], None] | None = None,
    ) -> None:
        """Start a log.

        Args:
            agent_id: (N,) numbers of the people.
            sideways: True if the robot's velocity may differ from its heading.
            people: True to record people and their trips, False to record only contacts with them:
                people near a fleet are recorded once for all robots.
            robot: its number among those of the crowd's state; None records no contacts.
            goal_column: first of the two columns of the crowd's state with people's waypoints.
            on_sample: callback for each sample: time (s), the robot's row, people.
            on_drawing: callback for each drawing of the planner: time (s), drawing.
        """
        self._on_sample, self._on_drawing = on_sample, on_drawing
        self.writer = writer
        self._sideways, self._keeps_people, self._robot = sideways, people, robot
        self._id = agent_id
        self._goal_column = goal_column
        self._jumps = np.zeros(len(agent_id))  # at the latest sample
        self._arrivals = np.zeros(len(agent_id))  # already recorded
        self._agent_contacts = np.zeros(len(agent_id))
        self.contacts = 0
        self.trips = 0
        self.clamped = 0
        self._steps = 0
        self._step_sum = self._step_max = 0.0

    def sample(self, t: float, robot: RobotState | None, crowd: Array | None) -> None:
        """Record one sample: the robot's state and the flat crowd state, either may be missing."""
        agents = jump = goals = None
        if crowd is not None and self._keeps_people:
            _, people = s.view(crowd)
            count = len(people)
            agents, goals = np.empty((4, count)), np.empty((2, count))
            jump = np.empty(count, np.bool_)
            _take_sample(people, self._goal_column, self._jumps, agents, goals, jump)
        row = None if robot is None else self._row(robot)
        self.writer.state(t, row, agents, jump, goals=goals)
        if robot is not None:
            self.writer.wheels(t, (robot.left_angle, robot.right_angle))
        if self._on_sample is not None:
            self._on_sample(t, row, agents)

    def has_recorded(self, events: Array) -> bool:
        """Return True if all trips and contacts that have ended are recorded.

        Args:
            events: (1 + R,) number of trips, and of contacts with each robot, that have ended.
        """
        trips = not self._keeps_people or events.item(0) == self.trips
        return trips and (self._robot is None or events.item(1 + self._robot) == self.contacts)

    def record_events(self, crowd: Array) -> None:
        """Record trips and contacts that ended since the last call; call every tick."""
        if self._keeps_people and int(crowd[s.TRIPS]) != self.trips:
            self._record_trips(s.view(crowd)[1])
            self.trips = int(crowd[s.TRIPS])
        if self._robot is None:
            return
        felt, touches = s.contact_with(crowd, self._robot)
        if int(felt[s.CONTACTS]) != self.contacts:
            for i in np.flatnonzero(touches[:, s.TOUCHES] != self._agent_contacts):
                self._contact(touches, i)
            self._agent_contacts = touches[:, s.TOUCHES].copy()
            self.contacts = int(felt[s.CONTACTS])

    def command(self, t: float, command: Command, seconds: float, clamped: bool) -> None:
        """Record one step of the planner."""
        self.clamped += clamped
        self._steps += 1
        self._step_sum += seconds
        self._step_max = max(self._step_max, seconds)
        self.writer.command(t, command)
        self.writer.planner_time(t, seconds)

    def wants_drawing(self, t: float, name: str) -> bool:
        """Return True if `drawing` would keep a drawing of this name."""
        return self._on_drawing is not None or self.writer.wants_drawing(t, name)

    def drawing(self, t: float, drawn: Drawn) -> None:
        """Record a drawing of the planner."""
        self.writer.drawing(t, drawn)
        if self._on_drawing is not None:
            self._on_drawing(t, drawn)

    def step_times(self) -> dict[str, float]:
        """Return mean and largest wall time of a planner step, s."""
        mean = self._step_sum / self._steps if self._steps else 0.0
        return {"mean": round(mean, 6), "max": round(self._step_max, 6)}

    def finish(self, t: float, crowd: Array | None) -> None:
        """Record unfinished trips and contacts at the end."""
        if crowd is None:
            return
        self.record_events(crowd)
        _, people = s.view(crowd)
        active = (
            self._keeps_people & (people[:, s.ON_TRIP] != 0.0) & (people[:, s.WAITING] == s.PRESENT)
        )
        for i in np.flatnonzero(active):
            self.writer.trip(int(self._id[i]), float(people[i, s.TRIP_START]), t, False)
        if self._robot is None:
            return
        _, touches = s.contact_with(crowd, self._robot)
        for i in np.flatnonzero(touches[:, s.TOUCHING] != 0.0):
            self._contact(touches, i)
            self.contacts += 1

    def _row(self, robot: RobotState) -> tuple[float, ...]:
        forward = robot.vx * math.cos(robot.yaw) + robot.vy * math.sin(robot.yaw)
        row = (robot.x, robot.y, robot.yaw, forward, robot.w)
        velocity = (robot.vx, robot.vy) if self._sideways else ()
        return *row, *velocity

    def _record_trips(self, people: Array) -> None:
        """Record trips: an agent has at most one arrival between two ticks."""
        for i in np.flatnonzero(people[:, s.ARRIVALS] != self._arrivals):
            start, end = people[i, s.LAST_START], people[i, s.ARRIVED]
            self.writer.trip(int(self._id[i]), float(start), float(end), True)
        self._arrivals = people[:, s.ARRIVALS].copy()

    def _contact(self, touches: Array, i: np.signedinteger[Any]) -> None:
        row = touches[i]
        self.writer.contact(
            t0=float(row[s.TOUCH_START]),
            t1=float(row[s.TOUCH_END]),
            agent=int(self._id[i]),
            impulse=float(row[s.TOUCH_IMPULSE]),
            peak_force=float(row[s.TOUCH_PEAK]),
            relative_speed=float(row[s.TOUCH_SPEED]),
            bearing=float(row[s.TOUCH_SIDE]),
        )


@kernel
def _take_sample(
    people: Array,
    goal_column: int,
    jumps: Array,
    agents: Array,
    goals: Array,
    jump: NDArray[np.bool_],
) -> None:
    """Write the columns of a sample in one pass over the crowd.

    Args:
        people: (M, C) rows of the crowd's state.
        goal_column: first column of people's waypoints.
        jumps: (M,) counts until the last sample, updated to this one.
        agents, goals, jump: (4, M), (2, M), (M,) results, arguments of `RecordingWriter.state`.
    """
    for i in range(people.shape[0]):
        present = people[i, s.WAITING] == s.PRESENT
        for c in range(4):
            agents[c, i] = people[i, s.X + c] if present else math.nan
        goals[0, i], goals[1, i] = people[i, goal_column], people[i, goal_column + 1]
        jump[i] = people[i, s.JUMPS] != jumps[i]
        jumps[i] = people[i, s.JUMPS]
