"""Many worlds as a vector environment of Stable-Baselines3, stepped in one compiled call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.errors import InputError
from crowdbot.rl.libraries import SAME_STEP, found, missing
from crowdbot.rl.vector_env import NavVectorEnv

_stable = found("stable_baselines3.common.vec_env")
VecEnv: Any = (
    _stable.VecEnv
    if _stable
    else missing("Stable-Baselines3", "install it with: pip install stable-baselines3")
)


class StableVecEnv(VecEnv):
    """W worlds for the algorithms of Stable-Baselines3.

    Args:
        num_envs, arguments: as in `NavVectorEnv`; its ``autoreset_mode`` is ``SameStep``.
    """

    def __init__(self, num_envs: int, **arguments: Any) -> None:
        self.worlds = NavVectorEnv(num_envs, autoreset_mode=SAME_STEP, **arguments)
        self.render_mode = self.worlds.render_mode
        self._given = np.zeros((num_envs, 2))
        self._next_seed: int | None = None
        self._steps, self._total = np.zeros(num_envs, np.int64), np.zeros(num_envs)
        super().__init__(
            num_envs, self.worlds.single_observation_space, self.worlds.single_action_space
        )

    def reset(self) -> Any:
        """Begin an episode in all worlds; return the observations."""
        found, _ = self.worlds.reset(seed=self._next_seed)
        self._next_seed = None
        self._steps[:], self._total[:] = 0, 0.0
        return found

    def seed(self, seed: int | None = None) -> Sequence[int | None]:
        """Set the seeds of the next reset: world k gets ``seed + k``."""
        self._next_seed = seed
        return [None if seed is None else seed + k for k in range(self.num_envs)]

    def set_level(self, level: int) -> None:
        """Set the level of the curriculum; see `NavVectorEnv.set_level`."""
        self.worlds.set_level(level)

    def step_async(self, actions: Any) -> None:
        """Store the actions for `step_wait`."""
        self._given = actions

    def step_wait(self) -> tuple[Any, Any, Any, list[dict[str, Any]]]:
        """Advance all worlds; the information of an episode that ended is in ``infos``."""
        observed, reward, terminated, truncated, more = self.worlds.step(self._given)
        done = terminated | truncated
        self._steps += 1
        self._total += reward
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for w in np.flatnonzero(done).tolist():
            infos[w] = {
                "terminal_observation": more["final_obs"][w],
                "TimeLimit.truncated": bool(truncated[w]),
                "is_success": bool(more["final_info"]["is_success"][w]),
                "touched": bool(more["final_info"]["touched"][w]),
                "episode": {
                    "r": float(self._total[w]),
                    "l": int(self._steps[w]),
                    "t": float(more["final_info"]["t"][w]),
                },
            }
            self._steps[w], self._total[w] = 0, 0.0
        return observed, reward.astype(np.float32), done, infos

    def close(self) -> None:
        """End the threads."""
        self.worlds.close()

    def get_images(self) -> Sequence[Any]:
        """Return a picture of each world, if the mode makes pictures."""
        return list(self.worlds.render() or ())

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Return an attribute, the same for all worlds."""
        return [getattr(self.worlds, attr_name)] * len(self._indices(indices))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Refuse: the worlds have no attributes of their own."""
        del value, indices
        raise InputError(f"'{attr_name}' is not an attribute of single worlds")

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> Any:
        """Refuse: the worlds have no methods of their own."""
        del args, indices, kwargs
        raise InputError(f"'{method_name}' is not a method of single worlds")

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Return False for all worlds."""
        del wrapper_class
        return [False] * len(self._indices(indices))

    def _indices(self, given: Any) -> list[int]:
        """Return indices of worlds as a list; all for None."""
        if given is None:
            return list(range(self.num_envs))
        return [given] if isinstance(given, int) else list(given)
