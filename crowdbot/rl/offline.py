"""Convert runs to episodes for offline reinforcement learning.

An observation is ``tracks`` with the true states of the nearest people; an action is the robot's
command, as shares of its limits; the reward is ``progress``.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.batch.blueprint import Blueprint, blueprint
from crowdbot.core.learning.actions import actions_of
from crowdbot.core.learning.build import build_observer, build_reward
from crowdbot.core.learning.seen import LearningContext, RobotInputs, StepChange
from crowdbot.core.recording.reading.commands import read_commands
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.topics import Topic
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.run_directory import RECORDING, SCENARIO
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.support.ticks import TICK
from crowdbot.core.trajectories.tracks import RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Indices
from crowdbot.core.types.robot import robot_body
from crowdbot.errors import InputError
from crowdbot.rl.env_setup import spec_of

#: Number of a wall among contacts.
_WALL = -1
#: A run's last step may be shorter by this share.
_SHORTER = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class RunEpisode:
    """A run as an episode of T steps.

    Attributes:
        observations: (T + 1, N), from before the first step to after the last one.
        low, high: (N,) their bounds.
        actions: (T, 2) v and w, from -1 to 1.
        rewards: (T,).
        arrived: True if the robot arrived.
        scenario: id.
    """

    observations: NDArray[np.float32]
    low: NDArray[np.float32]
    high: NDArray[np.float32]
    actions: NDArray[np.float32]
    rewards: Array
    arrived: bool
    scenario: str


def run_episode(run: Path, registry: Registry) -> RunEpisode:
    """Return a run directory as an episode.

    Raises:
        InputError: the run has several robots, one that moves sideways, or no whole step.
    """
    (scenario,) = open_spec(str(run / SCENARIO), registry).scenarios
    plan = blueprint(scenario, registry, ())
    if len(plan.models) != 1 or plan.models[0].limits.vy_max > 0.0:
        raise InputError(
            f"{run}: only runs of one robot that is driven by v and w can be an episode"
        )
    with Recording(run / RECORDING) as opened:
        found = opened.trajectories()
    return _Reader(run, plan, registry, found).episode()


class _Reader:
    """Cuts a run into steps."""

    def __init__(
        self, run: Path, plan: Blueprint, registry: Registry, trajectories: Trajectories
    ) -> None:
        if trajectories.robot is None:
            raise InputError(f"{run}: the recording has no robot")
        self._plan, self._registry, self._found = plan, registry, trajectories
        self._robot: RobotTrack = trajectories.robot
        step = plan.period * TICK
        count = int((trajectories.t[-1] - trajectories.t[0]) / step + _SHORTER)
        if count < 1:
            raise InputError(f"{run}: the recording has no whole step of {step:g} s")
        self._at = trajectories.t[0] + step * np.arange(count + 1)
        self._rows = _nearest(trajectories.t, self._at)
        self._given = self._commands(run / RECORDING)
        self._context = LearningContext(
            worlds=1, limits=plan.models[0].limits, body=robot_body(plan.models[0]), step=step
        )

    def episode(self) -> RunEpisode:
        """Return the episode."""
        observer = build_observer(
            self._registry, spec_of(self._registry, "observation", "tracks"), self._context
        )
        seen = [observer.observe(self._inputs(n))[0] for n in range(len(self._rows))]
        return RunEpisode(
            observations=np.stack(seen),
            low=observer.low,
            high=observer.high,
            actions=actions_of(self._given, self._context.limits).astype(np.float32),
            rewards=self._rewards(),
            arrived=self._robot.goal_time is not None,
            scenario=self._plan.scenario.id,
        )

    def _commands(self, recording: Path) -> Array:
        """Return the command (T, 3) in force at the end of each step."""
        given = read_commands(recording, Topic.COMMAND, Topic.COMMAND)
        held = np.maximum(np.searchsorted(given.t, self._at[1:] - _SHORTER, side="right") - 1, 0)
        columns = [given.v_sc[held], given.w_sc[held], np.zeros(len(held))]
        return np.column_stack(columns)

    def _inputs(self, n: int) -> RobotInputs:
        k, robot = self._rows[n], self._robot
        return RobotInputs(
            fresh=np.array([n == 0]),
            stepped=np.array([n > 0]),
            pose=np.array([[robot.x[k], robot.y[k], robot.theta[k]]]),
            twist=np.array([[robot.v[k], robot.w[k], 0.0]]),
            goal=np.array([self._plan.tasks[0].goal]),
            people=self._people(int(k))[np.newaxis],
        )

    def _people(self, k: int) -> Array:
        """Return x, y, vx, vy, radius (M, 5) of people at a sample."""
        people = self._found.agents
        if people is None:
            return np.zeros((0, 5))
        return np.column_stack(
            [people.x[k], people.y[k], people.vx[k], people.vy[k], people.radius]
        )

    def _rewards(self) -> Array:
        spec = spec_of(self._registry, "reward", "progress")
        reward = build_reward(self._registry, spec, self._context)
        goal, k = self._plan.tasks[0].goal, self._rows
        distance = np.hypot(goal[0] - self._robot.x[k], goal[1] - self._robot.y[k])
        before = np.concatenate([np.zeros((1, 3)), self._given[:-1]])
        last, none = len(self._given) - 1, np.zeros(1)
        return np.array([
            reward.of(StepChange(
                progress=distance[n : n + 1] - distance[n + 1 : n + 2],
                distance=distance[n + 1 : n + 2],
                arrived=np.array([n == last and self._robot.goal_time is not None]),
                contact=self._touching(n, wall=False),
                wall=self._touching(n, wall=True),
                gap=none, advance=none, work=none, forced=none, aside=none,
                command=self._given[n : n + 1],
                before=before[n : n + 1],
            ))[0]
            for n in range(last + 1)
        ])  # fmt: skip

    def _touching(self, n: int, *, wall: bool) -> Array:
        """Return the fraction (1,) of step n in contact with people, or with a wall if ``wall``."""
        contacts, (begin, end) = self._found.contacts, self._at[n : n + 2]
        if contacts is None:
            return np.zeros(1)
        of = (contacts.agent == _WALL) if wall else (contacts.agent >= 0)
        both = np.minimum(contacts.t1, end) - np.maximum(contacts.t0, begin)
        longest = both[of].max(initial=0.0)
        return np.array([max(longest, 0.0) / (end - begin)])


def _nearest(t: Array, at: Array) -> Indices:
    """Return the indices of the samples ``t`` nearest to the times ``at``; both ascend."""
    after = np.clip(np.searchsorted(t, at), 1, max(len(t) - 1, 1))
    return np.where(at - t[after - 1] <= t[after] - at, after - 1, after)
