"""Many worlds as one Gymnasium vector environment, stepped in one compiled call."""

from __future__ import annotations

from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Mask
from crowdbot.errors import InputError
from crowdbot.rl.actor import StepResult, Vectors
from crowdbot.rl.env_setup import resolve_named
from crowdbot.rl.episodes import seeds_of
from crowdbot.rl.libraries import DISABLED, NEXT_STEP, SAME_STEP, VectorEnv, gym
from crowdbot.rl.picture import picture
from crowdbot.rl.rollout import Rollout
from crowdbot.rl.window import RENDER_MODES, Window, check_render_mode


class NavVectorEnv(VectorEnv):
    """W worlds of one robot each.

    Args:
        num_envs: W.
        autoreset_mode: ``NextStep``: a step after the end of an episode begins the next one, and
            ignores its action; ``SameStep``: the step that ends it also begins the next one, and
            its last observation is ``infos["final_obs"]``; ``Disabled``: `reset` with
            ``options={"reset_mask": …}`` begins the next one.
        threads: number of threads that step the worlds.
        max_episode_steps: ends an episode before its time is over; None: the task's time limit.
        render_mode: ``rgb_array``: `render` returns a picture of each world; ``human``: a window
            shows the first world at each step.
        arguments: as in `crowdbot.rl.env_setup.resolve`.

    Raises:
        CrowdbotError: an argument is wrong, or a component cannot be simulated in a batch.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "render_modes": list(RENDER_MODES),
        "render_fps": 16,
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        autoreset_mode: str = NEXT_STEP,
        threads: int = 1,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
        **arguments: Any,
    ) -> None:
        if num_envs < 1 or threads < 1:
            raise InputError("num_envs and threads must be at least 1")
        check_render_mode(render_mode)
        self._made = partial(
            type(self), num_envs, autoreset_mode=autoreset_mode, threads=threads,
            max_episode_steps=max_episode_steps, render_mode=render_mode, **arguments,
        )  # fmt: skip
        mode = gym.vector.AutoresetMode(autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": mode}  # type: ignore[misc]
        self.num_envs, self.render_mode, self.autoreset_mode = num_envs, render_mode, mode
        self._most_steps = max_episode_steps
        seeds = np.random.SeedSequence().generate_state(num_envs, np.uint32).tolist()
        self.rollout = Rollout(resolve_named(arguments), seeds, threads)
        if len(self.rollout.actors) > 1:
            raise InputError(
                f"{self.rollout.scenarios[0]} has {len(self.rollout.actors)} robots; "
                "crowdbot.rl.ParallelNavEnv is for several"
            )
        (actor,) = self.rollout.actors
        self.single_observation_space = gym.spaces.Box(actor.low, actor.high)
        self.single_action_space = gym.spaces.Box(-1.0, 1.0, (actor.size,), np.float32)
        batch_space = gym.vector.utils.batch_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended = np.zeros(num_envs, np.bool_)
        self._steps = np.zeros(num_envs, np.int64)
        self._begun, self._window = False, Window(NavVectorEnv.__name__)

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Vectors, dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: of the first world, the next one has the next number; or of each world; None: the
                next episodes of the present seeds.
            options: ``reset_mask`` (W,) worlds that begin, all by default; ``level`` of the
                curriculum.

        Raises:
            InputError: a seed or an option is wrong.
        """
        given = dict(options or {})
        which = self._mask(given.pop("reset_mask", None))
        level = given.pop("level", None)
        if given:
            raise InputError(f"unknown option '{next(iter(given))}'; there are reset_mask, level")
        seeds = seeds_of(seed, self.num_envs)
        self._begin(which, seeds, level)
        self._begun = True
        self._show()
        return self.rollout.look(which, _nowhere(which)), self._infos(which)

    def set_level(self, level: int) -> None:
        """Set the level of the curriculum from the next episode of each world on.

        Raises:
            InputError: there is no such level.
        """
        self.rollout.set_level(level)

    def step(self, actions: Any) -> tuple[Vectors, NDArray[np.float64], Mask, Mask, dict[str, Any]]:
        """Advance all worlds by one period of their planner.

        Args:
            actions: (W, 2 or 3) from -1 to 1.

        Returns:
            observations (W, N), rewards (W,), True where the robot arrived (or touched a person,
            if that ends the episode) and where the time was over (W,), and further values.

        Raises:
            InputError: an action has a wrong shape or is not finite, or `reset` was not called.
        """
        given = np.asarray(actions, np.float64)
        shape = self.action_space.shape
        if given.shape != shape:
            raise InputError(f"actions have shape {shape}, not {given.shape}")
        if not self._begun:
            raise InputError("call reset() first: it begins the episodes")
        again = self._ended.copy()
        if again.any():
            if self.autoreset_mode.value == DISABLED:
                raise InputError("episodes have ended; reset them with options={'reset_mask': …}")
            self._begin(again, [None] * self.num_envs, None)
        result = self.rollout.step(given, np.flatnonzero(~again))
        self._steps += ~again
        after = self._after(result, again)
        self._show()
        return after

    def _after(
        self, result: StepResult, again: Mask
    ) -> tuple[Vectors, NDArray[np.float64], Mask, Mask, dict[str, Any]]:
        """Return what `step` returns; where episodes ended, begin new ones if the mode says so."""
        setup = self.rollout.setup
        ends = result.touched if setup.ends_at_contact else np.zeros_like(again)
        terminated, late = result.arrived | ends, result.late
        if self._most_steps is not None:
            late = late | ((self._steps >= self._most_steps) & ~again)
        truncated = late & ~terminated
        self._ended = terminated | truncated
        observed = self.rollout.look(again, ~again)
        infos = self._infos(np.ones_like(again), result)
        if self.autoreset_mode.value == SAME_STEP and self._ended.any():
            done = self._ended.copy()
            final = np.full(self.num_envs, None, object)
            for w in np.flatnonzero(done).tolist():
                final[w] = observed[w].copy()
            kept = {"final_obs": final, "_final_obs": done, "final_info": infos}
            self._begin(done, [None] * self.num_envs, None)
            observed = self.rollout.look(done, _nowhere(done))
            infos = {**self._infos(np.ones_like(again)), **kept, "_final_info": done}
        return observed, result.reward, terminated, truncated, infos

    def _begin(self, which: Mask, seeds: list[int | None], level: int | None) -> None:
        self.rollout.begin(which, seeds, level)
        self._ended[which], self._steps[which] = False, 0

    def _infos(self, which: Mask, result: StepResult | None = None) -> dict[str, Any]:
        """Return ``infos`` of some worlds: time, arrival, contact and scenario."""
        none = np.zeros(self.num_envs, np.bool_)
        arrived = none if result is None else result.arrived
        touched = none if result is None else result.touched
        values = {
            "t": self.rollout.time,
            "is_success": arrived,
            "touched": touched,
            "scenario": self.rollout.scenarios.copy(),
        }
        here = which.copy()
        return {**values, **{f"_{name}": here for name in values}}

    def _mask(self, given: Any) -> Mask:
        if given is None:
            return np.ones(self.num_envs, np.bool_)
        mask = np.asarray(given)
        if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
            raise InputError(
                f"reset_mask must be a bool array of shape {(self.num_envs,)} with at least one "
                "True"
            )
        return mask

    def render(self) -> tuple[Any, ...] | None:
        """Return images (H, W, 3) uint8 of all worlds from above; None unless ``rgb_array``."""
        if self.render_mode == "human":
            self._show()
        if self.render_mode != "rgb_array":
            return None
        return tuple(picture(self.rollout, w) for w in range(self.num_envs))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the arguments; `reset` an unpickled copy before its first step."""
        return self._made, ()

    def close_extras(self, **kwargs: Any) -> None:
        """End the threads."""
        del kwargs
        self.rollout.close()
        self._window.close()

    def _show(self) -> None:
        if self.render_mode == "human":
            self._window.show(picture(self.rollout, 0))


def _nowhere(like: Mask) -> Mask:
    """Return a mask of the same shape that is False everywhere."""
    return np.zeros_like(like)
