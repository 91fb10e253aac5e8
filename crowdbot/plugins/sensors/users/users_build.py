"""Synthetic users as joysticks: wanted deflection, its delay, the hand's error; or one switch.

The hand's error is an Ornstein-Uhlenbeck process, exact at any step (Gillespie, Physical Review E
54, 1996, p. 2084). All state is in the sensor's memory, which begins with a common head; two
readings at the same time are equal.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np

from crowdbot.plugin import Array, Pose, Scene, SensorContext
from crowdbot.plugins.sensors.described_build import DescribedSensor
from crowdbot.plugins.sensors.joystick_build import full, stick_info
from crowdbot.plugins.sensors.users.users import FatiguedUserSpec, OneSwitchUserSpec, UserSpec
from crowdbot.plugins.sensors.users.wish_build import Wish, wish

#: Head of the memory: 1 after a reading, its time, its values.
STARTED, TIME, V, W, HEAD = range(5)


class SyntheticUser(DescribedSensor, ABC):
    """Base of synthetic users; reading: (2,) v (m/s), w (rad/s)."""

    def __init__(
        self, spec: UserSpec, context: SensorContext, *, memory: int, random: bool
    ) -> None:
        limits, body = context.robot.limits, context.task.robot
        if body is None:
            raise ValueError("a user needs a robot whose outline is known")
        self._user, self._body = spec, body
        self._goal = spec.goal or context.task.goal
        self._most = spec.max_speed or limits.v_max, spec.max_yaw_rate or limits.w_max
        self._info = stick_info(
            spec.rate, memory=HEAD + memory, random=random, sees=spec.sight > 0.0
        )

    def read(
        self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator, memory: Array
    ) -> Array:
        """Return the user's command; two readings at the same time are equal."""
        if memory[STARTED] == 0.0 or t > memory[TIME]:
            desired = wish(self._user, self._body, self._goal, self._most, scene, pose)
            ahead, aside = self.deflect(desired, t, rng, memory)
            memory[:HEAD] = 1.0, t, self._most[0] * full(ahead), self._most[1] * full(aside)
        return memory[V:HEAD].copy()

    @abstractmethod
    def deflect(
        self, desired: Wish, t: float, rng: np.random.Generator, memory: Array
    ) -> tuple[float, float]:
        """Return the stick's deflections ahead and to the left at a new time.

        ``memory`` still has the head of the last reading.
        """


class StickUser(SyntheticUser):
    """A user of a stick: delayed, with a shaky hand, inattentive in lapses.

    Memory: the hand's error ahead and aside, the end of a lapse, the deflections that were held in
    it, and a ring buffer of wanted deflections.
    """

    _ERROR, _LAPSE, _HELD, _RING = 0, 2, 3, 5

    def __init__(self, spec: UserSpec, context: SensorContext) -> None:
        tired = spec if isinstance(spec, FatiguedUserSpec) else None
        longest = spec.delay + (tired.tired_delay if tired else 0.0)
        self._tired, self._ring = tired, 1 + math.ceil(longest * spec.rate)
        super().__init__(
            spec,
            context,
            memory=self._RING + 2 * self._ring,
            random=spec.noise + spec.proportional_noise > 0.0
            or (tired is not None and tired.lapses > 0.0),
        )

    def deflect(
        self, desired: Wish, t: float, rng: np.random.Generator, memory: Array
    ) -> tuple[float, float]:
        """Return the deflections at a new time."""
        spec, own = self._user, memory[HEAD:]
        level = self._tiredness(t)
        ring = own[self._RING :].reshape(self._ring, 2)
        now = round(t * spec.rate)
        ring[now % self._ring] = desired.ahead, desired.aside
        late = spec.delay + (self._tired.tired_delay * level if self._tired else 0.0)
        ahead, aside = ring[(now - round(late * spec.rate)) % self._ring].tolist()
        if not self._info.random:
            return ahead, aside
        draws = rng.standard_normal(2), rng.random()
        self._tremble(own, memory, t, draws[0])
        more = 1.0 + (self._tired.tired_noise - 1.0) * level if self._tired else 1.0
        error = (own[:2] * more).tolist()
        ahead += (spec.noise + spec.proportional_noise * abs(ahead)) * error[0]
        aside += (spec.noise + spec.proportional_noise * abs(aside)) * error[1]
        return self._attend(own, t, draws[1], level, (ahead, aside))

    def _tiredness(self, t: float) -> float:
        """Return the user's tiredness, from 0 (rested) to 1."""
        tired = self._tired
        return 0.0 if tired is None else -math.expm1(-(tired.time_on_task + t) / tired.tiring_time)

    def _tremble(self, own: Array, memory: Array, t: float, draw: Array) -> None:
        """Advance the hand's error, in standard deviations, to time t."""
        stays = 0.0
        if memory[STARTED] != 0.0:
            stays = math.exp((memory[TIME] - t) / self._user.noise_time)
        own[:2] = stays * own[:2] + math.sqrt(1.0 - stays * stays) * draw

    def _attend(
        self, own: Array, t: float, draw: float, level: float, stick: tuple[float, float]
    ) -> tuple[float, float]:
        """Return the deflections, or those at the beginning of a lapse while it lasts."""
        tired = self._tired
        if tired is None:
            return stick
        if t < own[self._LAPSE]:
            return float(own[self._HELD]), float(own[self._HELD + 1])
        if draw < tired.lapses * level / tired.rate:
            own[self._LAPSE] = t + tired.lapse_time
        own[self._HELD : self._HELD + 2] = stick
        return stick


class SwitchUser(SyntheticUser):
    """A user of one switch.

    Memory: the selected direction (0: none, they are offered in turn), when that began, the time of
    the next press (0: no reason for one).
    """

    _MARK, _SINCE, _PRESS = range(3)
    #: Deflections of the marks; the first is the standing robot.
    MARKS = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0))

    def __init__(self, spec: OneSwitchUserSpec, context: SensorContext) -> None:
        super().__init__(spec, context, memory=3, random=spec.reaction_spread > 0.0)
        self._switch = spec

    def deflect(
        self, desired: Wish, t: float, rng: np.random.Generator, memory: Array
    ) -> tuple[float, float]:
        """Return the deflections of the selected direction at a new time."""
        spec, own = self._switch, memory[HEAD:]
        draw = float(rng.standard_normal()) if self._info.random else 0.0
        mark = int(own[self._MARK])
        lit = mark or 1 + int((t - own[self._SINCE]) / spec.scan_period) % 3
        due = own[self._PRESS] > 0.0
        if not due and (lit != self._wanted(desired, mark)) == bool(mark):
            own[self._PRESS] = t + spec.reaction * max(0.2, 1.0 + spec.reaction_spread * draw)
        elif due and t >= own[self._PRESS]:
            own[:] = 0.0 if mark else lit, t, 0.0
        ahead, aside = self.MARKS[int(own[self._MARK])]
        return spec.deflection * ahead, spec.deflection * aside

    def _wanted(self, desired: Wish, mark: int) -> int:
        """Return the command mark to choose for when the press takes effect; 0: stand still."""
        spec, aside = self._switch, self.MARKS[mark][1]
        off = desired.off - spec.reaction * spec.deflection * aside * self._most[1]
        if abs(off) > spec.tolerance and off * aside >= 0.0:
            return 2 if off > 0.0 else 3
        speed = spec.deflection * self._most[0]
        return 1 if desired.free > speed * (spec.reaction + spec.gap_time) and not aside else 0


def build(spec: UserSpec, context: SensorContext) -> SyntheticUser:
    """Return a user; goal and limits default to those of the robot."""
    if isinstance(spec, OneSwitchUserSpec):
        return SwitchUser(spec, context)
    return StickUser(spec, context)
