"""Session: a run that is stepped from outside, command by command.

The simulation is that of `simulate`, with a planner that gets its commands from the session's
owner. Sensors and planner act in the same event, so the run has its own thread, which waits in the
planner's step while the session waits for a command: only one of the two ever runs.
"""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Sequence
from numbers import Real
from pathlib import Path
from types import TracebackType
from typing import Any, cast

from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.lock import population
from crowdbot.core.scenarios.one_robot import check_one_robot
from crowdbot.core.sim.built_run import BuiltRun, build_run
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.core.sim.run_thread import Exchange, own_stdout, start_run
from crowdbot.core.support.arguments import expect, path_of, texts_of, whole_number_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.motion import Command
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import InputError, kind_of

#: Types of a session's command: v, w, and vy for a robot that can move sideways; m/s, rad/s.
CommandLike = Command | tuple[float, ...] | Sequence[float]


class Session:
    """One robot among people, stepped from your own loop.

    ::

        with crowdbot.Session(scenario, seed=1) as session:
            obs = session.reset()
            while not session.done:
                obs = session.step((0.4, 0.0))
        print(session.status, session.t)

    The same commands give exactly the same trajectories as a planner that returns them. Nothing is
    written unless ``recording`` names a file.

    Args:
        scenario: with exactly one robot, from `crowdbot.load`.
        seed: seed of the sensors' noise.
        sensors: names or categories of the sensors to read, as in a planner's ``needs``; None: all
            that a robot may have. Only these are simulated.
        privileged: whether observations hold the truth (``obs.truth``).
        recording: file for the recording (MCAP); complete when the run has ended or was closed.
        registry: the installed components; None finds them.

    Attributes:
        task: start pose, goal and time limit of the robot; its body under ``task.robot``.
        limits: the robot's; commands are clamped into them.
        sensors: name -> constant description of each sensor that is seen.
        planner_seed: what a planner would get in this run for its own random numbers.

    Raises:
        InputError: the scenario does not have exactly one robot, the robot lacks a sensor, or
            another argument is wrong.
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
        check_one_robot(scenario, "a session")
        if registry is not None:
            expect("registry", registry, Registry)
        self.scenario, self._registry = scenario, registry or discover()
        self._choice = _choice(sensors, privileged=privileged)
        self._recording = None if recording is None else _checked_recording(recording)
        self._people = population(scenario, self._registry).agents
        self._exchange: Exchange | None = None
        self._thread: threading.Thread | None = None
        self._observation: Observation | None = None
        self._outcome: Outcome | None = None
        self._seed = whole_number_of("seed", seed)
        self._built: BuiltRun | None = self._build()
        self._describe(self._built)

    def reset(self, seed: int | None = None) -> Observation:
        """Start the run, again if it has started already.

        Args:
            seed: a new seed from now on; None keeps the current one.

        Returns:
            The observation at t = 0.

        Raises:
            InputError: the robot would start in a wall or a person, or the recording cannot be
                written.
        """
        self.close()
        self._seed = self._seed if seed is None else whole_number_of("seed", seed)
        built, self._built = self._built or self._build(), None  # for one run only
        self._describe(built)
        self._outcome = self._observation = None
        exchange = self._exchange = Exchange()
        host = PlannerHost(cast(Planner, exchange), "session", self.limits)
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
        )
        self._thread = start_run(exchange, setup, built, host)
        return self._take()

    def step(self, command: CommandLike) -> Observation:
        """Apply a command for one period of the planner.

        Args:
            command: v, w, and vy for a robot that can move sideways; m/s, rad/s.

        Returns:
            The observation for the next command. At the end of the run, ``done`` is true and it is
            the last observation.

        Raises:
            InputError: it is not a command, `reset` was not called, or the run has ended.
        """
        self.observe()
        if self.done:
            raise InputError(f"the run has ended: {self.reason}; reset() begins another")
        assert self._exchange is not None
        self._exchange.answer(_checked_command(command))
        return self._take()

    def observe(self) -> Observation:
        """Return the current observation, which is constant until the next step.

        Raises:
            InputError: `reset` was not called.
        """
        if self._observation is None:
            raise InputError("the session has not begun; reset() begins it")
        return self._observation

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
    def done(self) -> bool:
        """Return True if the run has ended."""
        return self._outcome is not None

    @property
    def status(self) -> str:
        """Return ``running``, finally ``arrived``, ``timeout``, ``toppled`` or ``interrupted``."""
        return "running" if self._outcome is None else self._outcome.status

    @property
    def reason(self) -> str:
        """Return why the run ended; empty while it is running."""
        return "" if self._outcome is None else self._outcome.reason

    @property
    def t(self) -> float:
        """Return the simulated time, s."""
        if self._outcome is not None:
            return self._outcome.sim_time
        return 0.0 if self._observation is None else self._observation.t

    @property
    def goal_time(self) -> float | None:
        """Return the robot's time of arrival, s; None before."""
        return None if self._outcome is None else self._outcome.goal_time

    @property
    def trajectories(self) -> Trajectories:
        """Return the run's trajectories, for `crowdbot.score`.

        Raises:
            InputError: the run was not recorded, or has not ended.
        """
        if self._recording is None:
            raise InputError("the session was not recorded; give it recording='run.mcap'")
        if not self.done:
            raise InputError("the run has not ended; close() ends it")
        with Recording(self._recording) as recording:
            return recording.trajectories()

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

    def _build(self) -> BuiltRun:
        return build_run(self.scenario, self._registry, self._choice, "used")

    def _describe(self, built: BuiltRun) -> None:
        self.task, self.limits = built.task, built.model.limits
        self.sensors = {n: built.infos[n] for n in built.visible}
        self.planner_seed = stream_seed(self._seed, built.name, "planner") >> 1

    def _take(self) -> Observation:
        """Return the run's next observation or end; raise its errors."""
        assert self._exchange is not None
        with own_stdout():
            answer = self._exchange.next()
        if isinstance(answer, Observation):
            self._observation = answer
        elif isinstance(answer, Outcome):
            self._end(answer)
        else:
            self._exchange = self._thread = self._observation = None
            raise answer
        return self.observe()

    def _end(self, outcome: Outcome) -> None:
        self._outcome = outcome
        if self._recording is not None:
            self._partial().replace(self._recording)

    def _partial(self) -> Path:
        assert self._recording is not None
        return self._recording.with_name(f"{self._recording.name}.partial")


def _checked_recording(recording: str | Path) -> Path:
    path = path_of("recording", recording)
    if path.is_dir():
        raise InputError(f"{path}: a recording is a file, and this is a folder")
    return path


def _checked_command(command: CommandLike) -> Command:
    """Return the command as finite floats.

    Raises:
        InputError: it is not a command.
    """
    try:
        numbers: tuple[Any, ...] = tuple(command)
    except TypeError:
        numbers = ()
    good = all(isinstance(x, Real) and not isinstance(x, bool) for x in numbers)
    if not (good and len(numbers) in (2, 3) and all(math.isfinite(x) for x in numbers)):
        raise InputError(f"a command is (v, w) or (v, w, vy), finite numbers; not {command!r}")
    return Command(*(float(x) for x in numbers))


def _choice(sensors: Sequence[str] | None, *, privileged: bool) -> PlannerChoice:
    def build() -> Planner:
        raise InputError("a session has no planner: its commands come from `step`")

    return PlannerChoice(
        name="session",
        spec_dump={"kind": "session"},
        build=build,
        pinned=False,
        needs=None if sensors is None else texts_of("sensors", sensors),
        label="session",
        privileged=privileged,
    )
