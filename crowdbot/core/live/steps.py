"""The steps of a live run, which all its robots take together."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence

from crowdbot.core.live.live_connection import LiveConnection
from crowdbot.core.live.message import LiveMessage, OfferedTopic, live_message
from crowdbot.core.live.robot_messages import RobotMessages, clock_last, constant_of
from crowdbot.core.live.robot_topics import STATUS, namespaces
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.step_policy import StepPolicy
from crowdbot.core.planning.planner import Observation
from crowdbot.core.recording import messages as ros

_STATUS = "crowdbot_msgs/msg/LiveStatus"
_TELL = 1.0  # s of wall time between two messages about the state


class LiveSteps:
    """The parts of a live run's step that happen once for all robots.

    The first planner of a step publishes the observations of all robots, and then the clock; from
    then on, commands for all robots count for that step.

    Attributes:
        session, policy: the session, and the timing.
        shown: when the current step was published, s of `time.monotonic`.
    """

    def __init__(
        self,
        session: LiveSession,
        connections: Sequence[LiveConnection],
        policy: StepPolicy,
        robots: Sequence[str],
    ) -> None:
        """Prepare the steps of one recording after the other. ``robots``: names of all robots."""
        self.session, self.policy = session, policy
        self.shown = 0.0
        self._connections, self._spaces = connections, namespaces(robots)
        self._robots: dict[str, RobotMessages] = {}
        self._look: Callable[[], Mapping[str, Observation]] = dict
        self._seen: Mapping[str, Observation] = {}
        self._passed_on, self._open = set[str](), set[str]()
        self._t = self._began = self._reported = -math.inf

    def begin_run(self, look: Callable[[], Mapping[str, Observation]]) -> None:
        """Start a recording; ``look`` returns all robots' observations at the present step."""
        self._look = look

    def space(self, robot: str) -> str:
        """Return the namespace of a robot."""
        return self._spaces[robot]

    def join(self, robot: str, messages: RobotMessages) -> None:
        """Add a robot; after the last one, announce all topics and publish constant data."""
        if set(self._robots) == set(self._spaces):  # of an earlier recording
            self._robots = {}
        self._robots[robot] = messages
        if set(self._robots) != set(self._spaces):
            return
        self._t = self._began = self._reported = -math.inf
        self._open = set()
        constant = constant_of(self._robots.values())
        offers = [OfferedTopic(m.topic, m.msgtype, latched=True) for m in constant]
        offers.append(OfferedTopic(STATUS, _STATUS, latched=True))
        offers += [offer for each in self._robots.values() for offer in each.offers()]
        for connection in self._connections:
            connection.open(list(dict.fromkeys(offers)))
            connection.publish(constant)
        self._tell()

    def begin(self, robot: str, obs: Observation) -> bool:
        """Begin a step, if this robot is its first; return False if the run ends."""
        if obs.t > self._t:
            if self._open:  # a robot ended before it was asked
                self._finish()
            self._t = obs.t
            self._seen = {**self._look(), robot: obs}
            self._note(obs.t)
            if not self.session.must_stop:
                self._open = set(self._seen)
                self._begin(obs.t)
                return True
        return not self.session.must_stop

    def taken(self, robot: str) -> None:
        """Store that a robot has its command; after the last one, the step is complete."""
        self._open.discard(robot)
        if not self._open:
            self._finish()

    def tell_who_came(self) -> None:
        """Publish the current step again for new subscribers."""
        for robot, obs in self._seen.items():
            more = self._robots[robot].again(
                obs, lambda t: t not in self._passed_on and self._wanted(t)
            )
            self._passed_on |= self._pass_on(more)

    def _note(self, t: float) -> None:
        self.session.t = t
        for name, obs in self._seen.items():
            robot = self.session.robots[self._spaces[name]]
            robot.pose, robot.twist = obs.pose, (*obs.twist, obs.vy)

    def _begin(self, t: float) -> None:
        """Wait until the step may be taken, and publish it."""
        session, policy = self.session, self.policy
        if self._began == -math.inf:
            session.wait_for_driver(policy.wait)
            self._began = time.monotonic() - (0.0 if policy.rate is None else t / policy.rate)
        held = time.monotonic()
        session.wait_while_paused()
        self._began += time.monotonic() - held
        if policy.lockstep:
            ns = policy.epoch + ros.nanoseconds(t)
            session.ask(ns, [self._spaces[name] for name in self._seen])
        else:
            self._keep_pace(t)
        self._passed_on = self._pass_on(
            message
            for name, obs in self._seen.items()
            for message in self._robots[name].messages(obs, self._wanted)
        )
        self.shown = time.monotonic()

    def _keep_pace(self, t: float) -> None:
        """Wait until the external clock, or real time, has reached ``t``, s."""
        session, policy = self.session, self.policy
        if policy.external_clock:
            session.wait_for_clock(t)
        elif policy.rate is not None:
            due = self._began + t / policy.rate
            session.sleep(due)
            session.counts.lag = max(time.monotonic() - due, 0.0)
            session.counts.most_lag = max(session.counts.most_lag, session.counts.lag)

    def _finish(self) -> None:
        self._open = set()
        self.session.counts.steps += 1
        if time.monotonic() - self._reported > _TELL:
            self._tell()

    def _pass_on(self, found: Iterable[LiveMessage]) -> set[str]:
        """Publish messages; return their topics."""
        messages = clock_last(found)
        for connection in self._connections:
            connection.publish(messages)
        return {m.topic for m in messages}

    def _wanted(self, topic: str) -> bool:
        return any(connection.wants(topic) for connection in self._connections)

    def _tell(self) -> None:
        self._reported = time.monotonic()
        message = status(self.session, self.policy.epoch)
        for connection in self._connections:
            connection.publish([message])


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
    return live_message(STATUS, epoch + ros.nanoseconds(session.t), message, latched=True)
