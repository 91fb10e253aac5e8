"""One world as a Gymnasium environment."""

from __future__ import annotations

from functools import partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.errors import InputError
from crowdbot.rl.libraries import DISABLED, Env
from crowdbot.rl.vector_env import NavVectorEnv
from crowdbot.rl.window import RENDER_MODES


class NavEnv(Env):
    """A robot that drives to its goal among people: a vector environment of one world.

    An action is v, w and, if the drive moves sideways, vy; -1 and 1 are the robot's limits. An
    episode ends when the robot arrives; it is truncated at the time limit.

    Args:
        arguments: as in `crowdbot.rl.env_setup.resolve`.

    Raises:
        CrowdbotError: an argument is wrong, or a component cannot be simulated in a batch.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": list(RENDER_MODES), "render_fps": 16}

    def __init__(self, *, render_mode: str | None = None, **arguments: Any) -> None:
        self._made = partial(type(self), render_mode=render_mode, **arguments)
        self._one = NavVectorEnv(1, autoreset_mode=DISABLED, render_mode=render_mode, **arguments)
        self.render_mode = render_mode
        self.observation_space = self._one.single_observation_space
        self.action_space = self._one.single_action_space
        self.rollout = self._one.rollout

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: new seed of the episodes; None: the next episode of the present seed.
            options: ``level`` of the curriculum.

        Raises:
            InputError: the seed or an option is wrong.
        """
        super().reset(seed=seed)
        found, infos = self._one.reset(seed=seed, options=options)
        return found[0], _first(infos)

    def step(self, action: Any) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Advance by one period of the planner; see `NavVectorEnv.step`.

        Raises:
            InputError: the action has a wrong shape or is not finite, or no episode goes on.
        """
        given = np.asarray(action, np.float64)
        if given.shape != self.action_space.shape:
            raise InputError(f"an action has shape {self.action_space.shape}, not {given.shape}")
        observed, reward, terminated, truncated, infos = self._one.step(given[np.newaxis])
        return (
            observed[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), _first(infos),
        )  # fmt: skip

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the arguments; `reset` an unpickled copy before its first step."""
        return self._made, ()

    def render(self) -> Any:
        """Return an image (H, W, 3) uint8 of the world from above; None unless ``rgb_array``."""
        pictures = self._one.render()
        return None if pictures is None else pictures[0]

    def close(self) -> None:
        """End the threads."""
        self._one.close()


def _first(infos: dict[str, Any]) -> dict[str, Any]:
    """Return the values of world 0 from the ``infos`` of a vector environment."""
    found = {name: value[0] for name, value in infos.items() if not name.startswith("_")}
    return {n: v.item() if isinstance(v, np.generic) else v for n, v in found.items()}
