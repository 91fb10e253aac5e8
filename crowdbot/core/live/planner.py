"""The planner of a live run: publishes its observations and obeys external commands."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from crowdbot.core.live.door import Door
from crowdbot.core.live.message import LiveMessage, Offer, told
from crowdbot.core.live.observed import Observed
from crowdbot.core.live.scene import LiveScene, latched
from crowdbot.core.live.session import LiveSession
from crowdbot.core.planning.planner import NoValidCommand, Observation
from crowdbot.core.recording import messages as ros
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError

Missed = Literal["stop", "hold", "fail"]
STATUS, _STATUS = "/crowdbot/status", "crowdbot_msgs/msg/LiveStatus"
_TELL = 1.0  # s of wall time between two messages about the state
#: Total time that steps wait for a driver while there is none, s; then they do not wait.
_ALONE = 30.0


@dataclass(frozen=True, kw_only=True)
class Manner:
    """Timing of a live run's steps.

    Attributes:
        rate: simulated seconds per second; None waits for the command of each step.
        external_clock: True if an external clock triggers steps.
        budget: s to wait for a step's command.
        missed: behaviour of a step without a command.
        hold: s of simulated time for which a command is valid if steps do not wait.
        wait: s to wait for the first driving client.
        epoch: ns added to all stamps.
    """

    rate: float | None = None
    external_clock: bool = False
    budget: float = 5.0
    missed: Missed = "stop"
    hold: float = 0.5
    wait: float = math.inf
    epoch: int = 0

    @property
    def lockstep(self) -> bool:
        """Return True if each step waits for its command."""
        return self.rate is None and not self.external_clock


class LivePlanner:
    """Drives with external commands."""

    def __init__(
        self, session: LiveSession, doors: Sequence[Door], scene: LiveScene, manner: Manner
    ) -> None:
        self._session, self._doors, self._scene, self._manner = session, doors, scene, manner
        self._began = self._told = -math.inf
        self._alone = 0.0
        self._last, self._heard = Command(0.0, 0.0), -math.inf

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Offer the topics of this run, and publish constant data."""
        del limits
        self._observed = Observed(sensors, self._scene.model, epoch=self._manner.epoch)
        constant = latched(self._scene, task, seed, self._manner.epoch)
        offers = [Offer(m.topic, m.msgtype, latched=True) for m in constant]
        offers.append(Offer(STATUS, _STATUS, latched=True))
        offers += self._observed.offers()
        for door in self._doors:
            door.open(offers)
            door.publish(constant)
        self._tell()

    def step(self, obs: Observation) -> Command:
        """Publish the observation; return the external command.

        Raises:
            NoValidCommand: there is no command.
            PlannerError: there is no command, and that ends the run.
        """
        session, manner = self._session, self._manner
        session.t, session.pose = obs.t, obs.pose
        session.twist = (*obs.twist, obs.vy)
        if session.must_stop:
            return Command(0.0, 0.0)
        if self._began == -math.inf:
            session.wait_for_driver(manner.wait)
            self._began = time.monotonic() - (0.0 if manner.rate is None else obs.t / manner.rate)
        held = time.monotonic()
        session.wait_while_paused()
        self._began += time.monotonic() - held
        answer = self._lockstep(obs) if manner.lockstep else self._paced(obs)
        session.counts.steps += 1
        if time.monotonic() - self._told > _TELL:
            self._tell()
        return self._obeyed(answer, obs.t)

    def _lockstep(self, obs: Observation) -> Command | None:
        session = self._session
        session.ask(self._manner.epoch + ros.nanoseconds(obs.t))
        said = self._publish(obs)

        def tell_who_came() -> None:
            more = self._observed.again(obs, lambda t: t not in said and self._wanted(t))
            said.update(self._pass_on(more))

        if session.driven:
            self._alone = 0.0
            return session.answer(self._manner.budget, tell_who_came)
        begin = time.monotonic()
        patience = min(self._manner.budget, max(_ALONE - self._alone, 0.0))
        answer = session.answer(patience, tell_who_came)
        self._alone += time.monotonic() - begin
        return answer

    def _paced(self, obs: Observation) -> Command | None:
        """Keep to a clock; return the latest command if it is not too old."""
        session, manner = self._session, self._manner
        if manner.external_clock:
            session.wait_for_clock(obs.t)
        elif manner.rate is not None:
            due = self._began + obs.t / manner.rate
            session.sleep(due)
            session.counts.lag = max(time.monotonic() - due, 0.0)
            session.counts.most_lag = max(session.counts.most_lag, session.counts.lag)
        self._publish(obs)
        command, fresh = session.newest()
        if fresh:
            self._heard = obs.t
            return command
        if obs.t - self._heard <= manner.hold and command is not None:
            session.counts.missed += 1
            return command
        return None

    def _obeyed(self, answer: Command | None, t: float) -> Command:
        """Return the command, or the substitute for a missing one."""
        if answer is not None:
            self._last = answer
            return answer
        if self._session.must_stop:
            return Command(0.0, 0.0)
        self._session.counts.missed += 1
        if self._manner.missed == "fail":
            raise PlannerError(f"no command came for the step at {t:g} s")
        if self._manner.missed == "hold":
            return self._last
        raise NoValidCommand

    def _publish(self, obs: Observation) -> set[str]:
        """Publish new data; return its topics."""
        return self._pass_on(self._observed.messages(obs, self._wanted))

    def _pass_on(self, found: Iterable[LiveMessage]) -> set[str]:
        messages = list(found)
        for door in self._doors:
            door.publish(messages)
        return {m.topic for m in messages}

    def _wanted(self, topic: str) -> bool:
        return any(door.wants(topic) for door in self._doors)

    def _tell(self) -> None:
        self._told = time.monotonic()
        message = status(self._session, self._manner.epoch)
        for door in self._doors:
            door.publish([message])


def status(session: LiveSession, epoch: int) -> LiveMessage:
    """Return the state of the current run, or of the one that just ended."""
    counts = session.counts
    message = ros.new(
        "crowdbot_msgs/LiveStatus",
        scenario=session.scenario,
        run=session.run,
        seed=session.seed,
        state=session.state,
        t=session.t,
        lag=counts.lag,
        steps=counts.steps,
        missed=counts.missed,
    )
    return told(STATUS, epoch + ros.nanoseconds(session.t), message, latched=True)
