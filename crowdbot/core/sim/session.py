"""Session: a run that is stepped from outside, command by command.

The simulation is that of `simulate`, with planners that ask the caller of the session. Sensors and
planners act within one event, so the run has a thread of its own, which rests in a planner's step
while the session waits for commands: only one of the two ever runs.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import cast

from crowdbot.core.planning.choice import PlannerChoice
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.built_run import BuiltRun, build_runs
from crowdbot.core.sim.person_targets import with_targets
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.core.sim.run_thread import Exchange, own_stdout, start_run
from crowdbot.core.sim.session_arguments import CommandLike, checked_commands, checked_recording
from crowdbot.core.support.arguments import expect, texts_of, whole_number_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import InputError, kind_of


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionRobot:
    """Task, limits and sensors of one robot in a session.

    Attributes:
        task: start pose, goal and time limit; its body under ``task.robot``.
        limits: of its commands, which are clamped into them.
        sensors: name -> constant description of each sensor that is seen.
        planner_seed: what a planner would get in this run for its own random numbers.
    """

    task: Task
    limits: RobotLimits
    sensors: Mapping[str, SensorInfo]
    planner_seed: int


class Session:
    """Robots among people, stepped from your own loop.

    ::

        with crowdbot.Session(scenario, seed=1) as session:
            obs = session.reset()
            while not session.done:
                obs = session.step((0.4, 0.0))
        print(session.status, session.t)

    The same commands give exactly the same trajectories as a planner that returns them. Nothing is
    written unless ``recording`` names a file.

    `reset`, `step` and `observe` are for the only robot of a scenario. `reset_all`, `step_all`
    and `observations` are for any number of robots, by name.

    Args:
        scenario: with one robot or several, from `crowdbot.load`.
        seed: of the run: noise of the sensors.
        sensors: names or categories of the sensors to read, as in a planner's ``needs``; None: all
            that a robot may have. Only these are simulated.
        privileged: whether observations hold the truth (``obs.truth``).
        recording: file for the recording (MCAP); complete when the run has ended or was closed.
        registry: the installed components; None finds them.

    Attributes:
        robots: task, limits, sensors and planner seed of each robot, by name.

    Raises:
        InputError: the scenario has no robot, a robot lacks a sensor, or another argument is
            wrong.
    """

    def __init__(
        self,
        scenario: Scenario,
        *,
        seed: int = 0,
        sensors: Sequence[str] | None = None,
        privileged: bool = False,
        recording: str | Path | None = None,
        registry: Registry | None = None,
    ) -> None:
        if not isinstance(scenario, Scenario):
            raise InputError(
                f"a session needs a scenario, not {kind_of(scenario)}; "
                "crowdbot.load(SUITE, ID) reads one"
            )
        if not scenario.robots:
            raise InputError(f"{scenario.id} has no robot, and a session drives robots")
        if registry is not None:
            expect("registry", registry, Registry)
        self.scenario, self._registry = scenario, registry or discover()
        self._choice = _choice(sensors, privileged=privileged)
        self._recording = None if recording is None else checked_recording(recording)
        self._people = population(scenario, self._registry).agents
        self._exchange: Exchange | None = None
        self._thread: threading.Thread | None = None
        self._seen: dict[str, Observation] = {}
        self._going_on: tuple[str, ...] = ()
        self._outcome: Outcome | None = None
        self._seed = whole_number_of("seed", seed)
        self._builts: dict[str, BuiltRun] | None = self._build()
        self._describe(self._builts)

    def reset_all(self, seed: int | None = None) -> dict[str, Observation]:
        """Begin the run; a run that has begun already begins again.

        Args:
            seed: a new seed from now on; None keeps the current one.

        Returns:
            The observation of each robot at t = 0, by name.

        Raises:
            InputError: a robot would start in a wall or a person, or the recording cannot be
                written.
        """
        self.close()
        self._seed = self._seed if seed is None else whole_number_of("seed", seed)
        builts, self._builts = self._builts or self._build(), None  # sensors remember: for one run
        self._describe(builts)
        self._outcome, self._seen = None, {}
        exchange = self._exchange = Exchange()
        setup = RunSetup(
            scenario=self.scenario,
            agents=self._people,
            registry=self._registry,
            choice=self._choice,
            seed=self._seed,
            recording=Path(os.devnull) if self._recording is None else self._partial(),
            options=RunOptions(record="none" if self._recording is None else "used"),
            stage="session",
            progress=None,
            stop=lambda: exchange.closed,
            on_hang=None,
            on_begin=exchange.begin,
        )
        with own_stdout():
            self._thread = start_run(exchange, setup, builts)
            return self._take()

    def reset(self, seed: int | None = None) -> Observation:
        """Begin the run of the only robot, as `reset_all`; its observation at t = 0.

        Raises:
            InputError: there are several robots, or as in `reset_all`.
        """
        robot = self._only("reset")
        return self.reset_all(seed)[robot]

    def step_all(self, commands: Mapping[str, CommandLike]) -> dict[str, Observation]:
        """Give a command to each robot that goes on, applied for one period of the planner.

        Args:
            commands: by robot: v, w, and vy for a robot that can move sideways; m/s, rad/s. Those
                of robots that have ended are left aside.

        Returns:
            What each robot that goes on sees when the next commands are due. When the run has
            ended, ``done`` is true, and it is what each robot saw last.

        Raises:
            InputError: one is not a command, a robot that goes on has none, `reset_all` was not
                called, or the run has ended.
        """
        self._check_begun()
        if self.done:
            raise InputError(f"the run has ended: {self.reason}; reset() begins another")
        checked = checked_commands(commands, self._going_on, self.robots)
        assert self._exchange is not None
        with own_stdout():
            self._exchange.answer(checked)
            return self._take()

    def step(self, command: CommandLike) -> Observation:
        """Give a command to the only robot, which is applied for one period of the planner.

        Args:
            command: v, w, and vy for a robot that can move sideways; m/s, rad/s.

        Returns:
            The observation for the next command. At the end of the run, ``done`` is true and it is
            the last observation.

        Raises:
            InputError: it is not a command, `reset` was not called, the run has ended, or there
                are several robots.
        """
        robot = self._only("step")
        return self.step_all({robot: command})[robot]

    @property
    def observations(self) -> dict[str, Observation]:
        """Latest observation of each robot, by name; unchanged until the next step.

        Raises:
            InputError: `reset` was not called.
        """
        self._check_begun()
        return dict(self._seen)

    @property
    def going_on(self) -> tuple[str, ...]:
        """Return the names of the robots that have not ended."""
        return () if self.done else self._going_on

    def observe(self) -> Observation:
        """Return the current observation of the only robot; it stays the same until the next step.

        Raises:
            InputError: `reset` was not called, or there are several robots.
        """
        return self.observations[self._only("observe")]

    def close(self) -> None:
        """End the run if one is in progress. The session can be reset again."""
        exchange, self._exchange = self._exchange, None
        if exchange is None or self._thread is None:
            return
        with own_stdout():
            exchange.close()
            self._thread.join()
        self._thread = None
        if self._outcome is None and isinstance(end := exchange.next(), Outcome):
            self._end(end)

    @property
    def task(self) -> Task:
        """Return the only robot's task: start pose, goal, time limit, and its body."""
        return self.robots[self._only("task")].task

    @property
    def limits(self) -> RobotLimits:
        """Return the only robot's limits, into which commands are clamped."""
        return self.robots[self._only("limits")].limits

    @property
    def sensors(self) -> Mapping[str, SensorInfo]:
        """Return the only robot's sensors that are seen: name -> constant description."""
        return self.robots[self._only("sensors")].sensors

    @property
    def planner_seed(self) -> int:
        """Seed that a planner of the only robot would get in this run for its random numbers."""
        return self.robots[self._only("planner_seed")].planner_seed

    @property
    def done(self) -> bool:
        """Return True if the run has ended."""
        return self._outcome is not None

    @property
    def status(self) -> str:
        """Return ``running``, finally the word of the run's ending, such as ``arrived``."""
        return "running" if self._outcome is None else self._outcome.status

    @property
    def statuses(self) -> dict[str, str]:
        """Status of each robot, by name, when the run has ended; empty before."""
        if self._outcome is None:
            return {}
        each = self._outcome.robots
        return {name: each[name].status if each else self.status for name in self.robots}

    @property
    def reason(self) -> str:
        """Return why the run ended; empty while it is running."""
        return "" if self._outcome is None else self._outcome.reason

    @property
    def t(self) -> float:
        """Return the simulated time, s."""
        if self._outcome is not None:
            return self._outcome.sim_time
        return max((obs.t for obs in self._seen.values()), default=0.0)

    @property
    def goal_time(self) -> float | None:
        """Arrival time of the robot, or of the last one, s; None if one has not arrived."""
        return None if self._outcome is None else self._outcome.goal_time

    @property
    def trajectories(self) -> Trajectories:
        """Return the run of the only robot, for `crowdbot.score`.

        Raises:
            InputError: the run was not recorded, has not ended, or has several robots.
        """
        return self.trajectories_of(self._only("trajectories"))

    def trajectories_of(self, robot: str) -> Trajectories:
        """Return the run of one robot, for `crowdbot.score`.

        Raises:
            InputError: the run was not recorded, has not ended, or has no such robot.
        """
        if self._recording is None:
            raise InputError("the session was not recorded; give it recording='run.mcap'")
        if not self.done:
            raise InputError("the run has not ended; close() ends it")
        if robot not in self.robots:
            raise InputError(f"there is no robot '{robot}'; there are {', '.join(self.robots)}")
        with Recording(self._recording) as recording:
            return recording.trajectories(robot if len(self.robots) > 1 else None)

    def __enter__(self) -> Session:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_exchange", None) is not None:
            cast(Exchange, self._exchange).close()

    def _only(self, name: str) -> str:
        """Return the only robot.

        Raises:
            InputError: there are several.
        """
        if len(self.robots) > 1:
            other = {"observe": "observations", "trajectories": "trajectories_of(robot)"}
            use = f"{name}_all" if name in ("reset", "step") else other.get(name, "robots")
            raise InputError(
                f"{self.scenario.id} has {len(self.robots)} robots, {', '.join(self.robots)}; "
                f"Session.{name} is for one, Session.{use} for several"
            )
        return next(iter(self.robots))

    def _check_begun(self) -> None:
        if not self._seen:
            raise InputError("the session has not begun; reset() begins it")

    def _build(self) -> dict[str, BuiltRun]:
        builts = build_runs(self.scenario, self._registry, self._choice, "used")
        return with_targets(builts, self._people)

    def _describe(self, builts: Mapping[str, BuiltRun]) -> None:
        self.robots: Mapping[str, SessionRobot] = {
            name: SessionRobot(
                task=built.task,
                limits=built.model.limits,
                sensors={n: built.infos[n] for n in built.visible},
                planner_seed=stream_seed(self._seed, name, "planner") >> 1,
            )
            for name, built in builts.items()
        }

    def _take(self) -> dict[str, Observation]:
        """Return the run's next observation or end; raise its errors."""
        assert self._exchange is not None
        answer = self._exchange.next()
        if isinstance(answer, BaseException):
            self._exchange = self._thread = None
            self._seen = {}
            raise answer
        if isinstance(answer, Outcome):
            self._end(answer)
            return self.observations
        self._seen |= answer
        self._going_on = tuple(answer)
        return dict(answer)

    def _end(self, outcome: Outcome) -> None:
        self._outcome = outcome
        if self._recording is not None:
            self._partial().replace(self._recording)

    def _partial(self) -> Path:
        assert self._recording is not None
        return self._recording.with_name(f"{self._recording.name}.partial")


def _choice(sensors: Sequence[str] | None, *, privileged: bool) -> PlannerChoice:
    def build() -> Planner:
        raise InputError("a session takes no planner: your own program calls step() with commands")

    return PlannerChoice(
        name="session",
        spec_dump={"kind": "session"},
        build=build,
        pinned=False,
        needs=None if sensors is None else texts_of("sensors", sensors),
        label="session",
        privileged=privileged,
    )
