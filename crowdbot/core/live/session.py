"""A live session: shared state of the simulation and its clients.

The simulation and the connections have separate threads; one lock protects all state.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from crowdbot.core.live.commands import joy
from crowdbot.core.live.counts import LiveCounts
from crowdbot.core.live.live_robot import LiveRobot, PendingStep
from crowdbot.core.live.robot_topics import command_topics, joy_topics, namespaces
from crowdbot.core.types.ending import Ending
from crowdbot.core.types.motion import Command

Request = Literal["", "reset", "next", "load"]
State = Literal["waiting", "running", "paused", "ended"] | Ending
#: Interval at which a wait checks for interruptions, s.
_LOOK = 0.05
#: A command with a stamp older than the current step by more than this belongs to another step.
_ROUNDING = 1_000


@dataclass
class LiveSession:
    """State shared by the simulation and its connections.

    Attributes:
        interrupted: True if the user stopped the run.
        counts: counters of the current run.
        state, scenario, run, seed, t: facts about it.
        robots: the robots of all scenarios, by the namespace of their topics, which is empty for
            the only robot of a scenario.
        scenarios: ids of the available scenarios; ``requested`` is the one to load.
    """

    interrupted: Callable[[], bool] = lambda: False
    counts: LiveCounts = field(default_factory=LiveCounts)
    state: State = "waiting"
    scenario: str = ""
    run: int = 0
    seed: int = 0
    t: float = 0.0
    robots: Mapping[str, LiveRobot] = field(default_factory=lambda: {"": LiveRobot()})
    scenarios: Sequence[str] = ()
    requested: str = ""
    _changed: threading.Condition = field(default_factory=threading.Condition)
    _paused: bool = False
    _steps: int = 0
    _clock: float = -math.inf
    _clock_keeper: Hashable | None = None
    _request: Request = ""
    _listeners: bool = False

    # ------------------------------------------------------------------ the simulation asks
    def begin(self, scenario: str, seed: int, robots: Sequence[str]) -> None:
        """Start a run of robots, given by name."""
        with self._changed:
            self.scenario, self.seed, self.t = scenario, seed, 0.0
            if self.run:  # requests from before the first run are kept
                self._clock = -math.inf
                for robot in self.robots.values():
                    robot.latest, robot.fresh = None, False
            self.run += 1
            self.counts, self.state = LiveCounts(), "waiting"
            for robot in self.robots.values():
                robot.name, robot.pending = "", None
            for name, space in namespaces(robots).items():
                self.robots[space].name = name
            self._request = ""

    def finish(self, state: State) -> None:
        """End the run."""
        with self._changed:
            self.state = state
            self._changed.notify_all()

    @property
    def must_stop(self) -> bool:
        """Return True if the run has to stop early."""
        return bool(self._request) or self.interrupted()

    def ask(self, ns: int, robots: Sequence[str] = ("",)) -> None:
        """Assign all following commands to the step at ``ns``; robots are given by namespace."""
        with self._changed:
            self._listeners = False
            for robot in robots:
                self.robots[robot].pending = PendingStep(ns)

    def answer(
        self, budget: float, listened: Callable[[], None], robot: str = ""
    ) -> Command | None:
        """Wait for the command of the current step; return None if there is none in time.

        Args:
            budget: s to wait.
            listened: callback for new subscribers during the wait.
            robot: namespace of the robot.
        """
        until = time.monotonic() + budget
        while True:
            with self._changed:
                request = self.robots[robot].pending
                assert request is not None
                self._wait(lambda: request.answer is not None or self._listeners, until)  # noqa: B023
                if request.answer is not None or not self._listeners:
                    self.robots[robot].pending = None
                    return request.answer
                self._listeners = False
            listened()

    def wait_for_driver(self, patience: float) -> bool:
        """Wait until each robot is driven, at most this many seconds; return True if so."""
        with self._changed:
            self._wait(lambda: self.driven, time.monotonic() + patience)
            return self.driven

    def newest(self, robot: str = "") -> tuple[Command | None, bool]:
        """Return a robot's latest command, and True if it is new since the last call."""
        with self._changed:
            one = self.robots[robot]
            fresh, one.fresh = one.fresh, False
            return one.latest, fresh

    def wait_while_paused(self) -> None:
        """Return when the next step may be taken."""
        with self._changed:
            self._wait(lambda: not self._paused or self._steps > 0, math.inf)
            self._steps = max(self._steps - 1, 0)
            self.state = "paused" if self._paused else "running"
            self._changed.notify_all()

    def wait_for_clock(self, t: float) -> None:
        """Return when the external clock is at least ``t``, s."""
        with self._changed:
            self._wait(lambda: self._clock >= t - 1e-9, math.inf)

    def sleep(self, until: float) -> None:
        """Sleep until a time of `time.monotonic`, or until the run has to end."""
        with self._changed:
            self._wait(lambda: False, until)

    def wait_for_request(self) -> Request:
        """Wait for a request for another run; return nothing when the user stops."""
        with self._changed:
            self._wait(lambda: False, math.inf)
            return self.take_request()

    def take_request(self) -> Request:
        """Return the pending request and forget it; empty if there is none."""
        with self._changed:
            request, self._request = self._request, ""
            return request

    def _wait(self, done: Callable[[], bool], until: float) -> None:
        """Wait for a condition, a time, or the end of the run; requires the lock."""
        while not done() and not self.must_stop:
            left = until - time.monotonic()
            if left <= 0.0:
                return
            self._changed.wait(min(left, _LOOK))

    # ------------------------------------------------------------------ connections tell
    @property
    def commands(self) -> dict[str, str]:
        """Return the topics of commands: topic -> namespace of the robot."""
        return command_topics(self.robots)

    @property
    def joysticks(self) -> dict[str, str]:
        """Return the topics of joysticks: topic -> namespace of the robot."""
        return joy_topics(self.robots)

    def joystick(self, client: Hashable, message: Any, robot: str) -> str:
        """Take a client's sensor_msgs/Joy; return why it is refused, empty if accepted.

        Raises:
            InputError: it is not one.
        """
        limits = self.robots[robot].limits
        if limits is None:
            self.refuse()
            return "the run has not begun, so the robot's limits are not known"
        return self.command(client, joy(message, limits), None, robot)

    def drive(self, client: Hashable, robot: str = "") -> bool:
        """Return True if this client may drive a robot; the first one does until it leaves."""
        with self._changed:
            one = self.robots[robot]
            if one.driver is None:
                one.driver = client
                self._changed.notify_all()
            return one.driver == client

    def leave(self, client: Hashable, robot: str | None = None) -> None:
        """Handle a client that stopped driving a robot, or, without a robot, disconnected."""
        with self._changed:
            for one in self.robots.values() if robot is None else [self.robots[robot]]:
                if one.driver == client:
                    one.driver = None
            if robot is None and self._clock_keeper == client:
                self._clock_keeper = None
            self._changed.notify_all()

    def leave_clock(self, client: Hashable) -> None:
        """Handle a client that no longer drives the external clock."""
        with self._changed:
            if self._clock_keeper == client:
                self._clock_keeper = None

    def drives(self, client: Hashable) -> bool:
        """Return True if this client drives a robot or the external clock."""
        return self._clock_keeper == client or any(r.driver == client for r in self.robots.values())

    @property
    def here(self) -> list[LiveRobot]:
        """Return the robots of the current run by namespace."""
        return [robot for robot in self.robots.values() if robot.name]

    @property
    def driven(self) -> bool:
        """Return True if a client drives each robot of the run."""
        return all(robot.driver is not None for robot in self.here or self.robots.values())

    def is_driven(self, robot: str) -> bool:
        """Return True if a client drives this robot."""
        return self.robots[robot].driver is not None

    def command(
        self, client: Hashable, command: Command, stamp: int | None = None, robot: str = ""
    ) -> str:
        """Take a client's command.

        Args:
            client: the client.
            command: m/s, rad/s.
            stamp: stamp of the message, ns; None or 0 if it has none.
            robot: namespace of the robot.

        Returns:
            Why the command is refused; empty if accepted.
        """
        why = self._taken(client, command, stamp, robot)
        if why:
            self.refuse()
        return why

    def refuse(self) -> None:
        """Count a refused command."""
        with self._changed:
            self.counts.refused += 1

    def _taken(self, client: Hashable, command: Command, stamp: int | None, robot: str) -> str:
        if not all(math.isfinite(x) for x in command):
            return "a command must be finite"
        if self.run and not self.robots[robot].name:
            return "the run has no robot with this topic"
        if not self.drive(client, robot):
            return "another client drives; its commands count until it leaves"
        with self._changed:
            one = self.robots[robot]
            request = one.pending
            if request is not None and stamp and stamp < request.ns - _ROUNDING:
                return "the command's stamp is older than the step that waits for one"
            one.latest, one.fresh = command, True
            if request is not None and request.answer is None:
                request.answer = command
            self._changed.notify_all()
        return ""

    def listened(self) -> None:
        """Handle a new subscriber."""
        with self._changed:
            self._listeners = True
            self._changed.notify_all()

    def clock(self, t: float, client: Hashable) -> bool:
        """Set the external clock to ``t``, s; it never goes back.

        Returns:
            False if another client keeps the clock: the first one does until it leaves.
        """
        with self._changed:
            if self._clock_keeper is None:
                self._clock_keeper = client
            if self._clock_keeper != client:
                return False
            if t > self._clock and math.isfinite(t):
                self._clock = t
                self._changed.notify_all()
        return True

    def pause(self, paused: bool) -> None:
        """Pause the run before its next step, or resume it."""
        with self._changed:
            self._paused, self._steps = paused, 0
            self._changed.notify_all()

    def step(self, count: int) -> int:
        """Take this many steps and pause again; return the number of the last one."""
        with self._changed:
            self._paused = True
            self._steps += count
            self._changed.notify_all()
            return self.counts.steps + self._steps

    def ask_for(self, request: Request, seed: int | None = None) -> None:
        """Stop the run and start another: the same scenario, or the next one."""
        with self._changed:
            self._request = request
            self.seed = self.seed if seed is None else seed
            self._changed.notify_all()

    def load(self, scenario: str) -> None:
        """Stop the run and start another scenario."""
        with self._changed:
            self.requested = scenario
        self.ask_for("load")

    @property
    def paused(self) -> bool:
        """Return True if the run is paused."""
        return self._paused
