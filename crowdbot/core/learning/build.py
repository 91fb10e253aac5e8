"""Build observations and rewards from specs, and check the values they return."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.learning.bounded import write_bounded
from crowdbot.core.learning.seen import LearningContext, RobotInputs, StepChange
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.component_specs import ObservationSpec, RewardSpec
from crowdbot.errors import PluginError

Vectors = NDArray[np.float32]
#: Numbers of a person.
_PERSON = 5


class Observer(Protocol):
    """Turns sensor data of robots into vectors; may keep a memory for each world.

    Attributes:
        low, high: (N,) float32, finite: bounds of each number.
    """

    low: Vectors
    high: Vectors

    def observe(self, seen: RobotInputs) -> Vectors:
        """Return observations (W, N), float32 within the bounds; a new array."""
        ...


class Reward(Protocol):
    """Computes the reward of steps."""

    def of(self, change: StepChange) -> Array:
        """Return the rewards of W robots: (W,) finite float64."""
        ...


class CheckedObserver:
    """An observer whose results are checked.

    Attributes:
        low, high: as in `Observer`.
    """

    def __init__(self, observer: Observer, worlds: int, call: PluginCall) -> None:
        self._observer, self._worlds, self._call = observer, worlds, call
        self.low = np.ascontiguousarray(observer.low)
        self.high = np.ascontiguousarray(observer.high)

    @property
    def size(self) -> int:
        """Return the length of a vector."""
        return len(self.low)

    def observe(self, seen: RobotInputs) -> Vectors:
        """Return (W, N) vectors within the bounds.

        Raises:
            PluginError: the observer raised, or its answer has another shape or is not finite.
        """
        with self._call("observe"):
            found = np.asarray(self._observer.observe(seen), np.float32)
        if found.shape != (self._worlds, self.size):
            self._call.fail(f"observed shape {found.shape}, not {(self._worlds, self.size)}")
        bounded = np.empty_like(found, order="C")
        if not write_bounded(np.ascontiguousarray(found), self.low, self.high, bounded):
            self._call.fail("observed a number that is not finite")
        return bounded

    def tracker(self) -> Callable[[Any], Array]:
        """Return a function from a planner's observation to people (M, 5) as in `RobotInputs`.

        Only for observations whose spec has ``tracks``.
        """
        with self._call("tracker"):
            follow = cast(Any, self._observer).tracker()

        def people(obs: Any) -> Array:
            with self._call("tracker", obs.t):
                found = np.asarray(follow(obs), np.float64)
            if found.ndim != 2 or found.shape[1] != _PERSON or not np.isfinite(found).all():
                self._call.fail(f"followed people of shape {found.shape}, not (M, {_PERSON})")
            return found

        return people


class CheckedReward:
    """A reward whose results are checked."""

    def __init__(self, reward: Reward, worlds: int, call: PluginCall) -> None:
        self._reward, self._worlds, self._call = reward, worlds, call

    def of(self, change: StepChange) -> Array:
        """Return (W,) rewards.

        Raises:
            PluginError: the reward raised, or its answer has another shape or is not finite.
        """
        with self._call("of"):
            found = np.asarray(self._reward.of(change), np.float64)
        if found.shape != (self._worlds,):
            self._call.fail(f"returned shape {found.shape}, not {(self._worlds,)}")
        if not np.isfinite(found).all():
            self._call.fail("returned a reward that is not finite")
        return found


def build_observer(
    registry: Registry, spec: ObservationSpec, context: LearningContext
) -> CheckedObserver:
    """Return the observer of a spec.

    Raises:
        PluginError: it cannot be built, or its bounds are not finite.
        InputError: the robot lacks a sensor that it needs.
    """
    call = registry.plugin_call(spec)
    built = registry.build(spec, _checked_observer, context, call=call)
    if spec.tracks:
        _need(built, "tracker")
    return CheckedObserver(built, context.worlds, call)


def build_reward(registry: Registry, spec: RewardSpec, context: LearningContext) -> CheckedReward:
    """Return the reward of a spec.

    Raises:
        PluginError: it cannot be built.
    """
    call = registry.plugin_call(spec)
    return CheckedReward(registry.build(spec, _checked_reward, context, call=call),
                         context.worlds, call)  # fmt: skip


def _checked_observer(built: Any) -> Observer:
    _need(built, "observe")
    for name in ("low", "high"):
        bound = getattr(built, name, None)
        if not (isinstance(bound, np.ndarray) and bound.ndim == 1 and bound.dtype == np.float32):
            raise PluginError(f"'{name}' must be (N,) float32")
        if not np.isfinite(bound).all():
            raise PluginError(f"'{name}' must be finite")
    if built.low.shape != built.high.shape or not np.all(built.low < built.high):
        raise PluginError("'low' must be below 'high', number by number")
    return cast(Observer, built)


def _checked_reward(built: Any) -> Reward:
    _need(built, "of")
    return cast(Reward, built)


def _need(built: Any, method: str) -> None:
    if not callable(getattr(built, method, None)):
        raise PluginError(f"build returned a {type(built).__name__}, which has no '{method}'")


def sensors_of(specs: Sequence[ObservationSpec]) -> tuple[str, ...]:
    """Return the sensors that observations need, by name or category, each once."""
    return tuple(dict.fromkeys(name for spec in specs for name in spec.needs))
