"""Several robots in one world, as a PettingZoo environment."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.errors import InputError
from crowdbot.rl.env_setup import resolve_named
from crowdbot.rl.libraries import ParallelEnv, gym
from crowdbot.rl.picture import picture
from crowdbot.rl.rollout import Rollout
from crowdbot.rl.window import RENDER_MODES, Window, check_render_mode

Values = dict[str, Any]


class ParallelNavEnv(ParallelEnv):
    """All robots of a scenario, each with its own observation, action and reward.

    A robot that has arrived is done and stands; the others go on, until all are done or the time is
    over.

    Args:
        arguments: as in `crowdbot.rl.env_setup.resolve`.

    Raises:
        CrowdbotError: an argument is wrong, or a component cannot be simulated in a batch.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "crowdbot_nav_v0",
        "render_modes": list(RENDER_MODES),
        "render_fps": 16,
    }

    def __init__(self, *, render_mode: str | None = None, **arguments: Any) -> None:
        check_render_mode(render_mode)
        seed = int(np.random.SeedSequence().generate_state(1)[0])
        self.rollout, self.render_mode = Rollout(resolve_named(arguments), [seed]), render_mode
        self.possible_agents = list(self.rollout.world(0).blueprint.names)
        self.agents: list[str] = []
        self._window = Window(ParallelNavEnv.__name__)
        self._actors = dict(zip(self.possible_agents, self.rollout.actors, strict=True))
        self.observation_spaces = {
            name: gym.spaces.Box(actor.low, actor.high) for name, actor in self._actors.items()
        }
        self.action_spaces = {
            name: gym.spaces.Box(-1.0, 1.0, (actor.size,), np.float32)
            for name, actor in self._actors.items()
        }

    def observation_space(self, agent: str) -> Any:
        """Return the observation space of a robot."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Any:
        """Return the action space of a robot."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Values, Values]:
        """Begin an episode of all robots; arguments as in `crowdbot.rl.env.NavEnv.reset`."""
        level = (options or {}).get("level")
        self.rollout.begin(np.ones(1, np.bool_), [seed], level)
        self.agents = list(self.possible_agents)
        self._show()
        return self._observe(fresh=True), {name: {} for name in self.agents}

    def step(self, actions: Values) -> tuple[Values, Values, Values, Values, Values]:
        """Advance all robots by one period of their planner.

        Args:
            actions: action of each robot that is not done, from -1 to 1.

        Raises:
            InputError: a robot that is not done has no action, or an invalid one.
        """
        if not self.agents:
            return {}, {}, {}, {}, {}
        given = {name: self._command(name, actions) for name in self.agents}
        still = np.zeros((1, 3))
        rows = [given.get(name, still) for name in self.possible_agents]
        rollout, here = self.rollout, np.ones(1, np.bool_)
        rollout.advance(np.stack(rows, axis=1), np.zeros(1, np.int64))
        going = {name: self._actors[name] for name in self.agents}
        found = {
            n: a.result(rollout.batches, rollout.rows, given[n], here) for n, a in going.items()
        }
        rewards = {n: float(r.reward[0]) for n, r in found.items()}
        done = {n: bool(r.arrived[0]) for n, r in found.items()}
        late = {n: bool(r.late[0]) for n, r in found.items()}
        infos = {
            n: {"is_success": done[n], "touched": bool(r.touched[0])} for n, r in found.items()
        }
        observed = self._observe(fresh=False)
        self._show()
        self.agents = [name for name in self.agents if not (done[name] or late[name])]
        return observed, rewards, done, late, infos

    def _command(self, name: str, actions: Values) -> NDArray[np.float64]:
        """Return the command (1, 3) of a robot."""
        if name not in actions:
            raise InputError(f"robot '{name}' has no action")
        action = np.asarray(actions[name], np.float64)
        if action.shape != (self._actors[name].size,) or not np.isfinite(action).all():
            raise InputError(f"the action of '{name}' has {self._actors[name].size} finite numbers")
        return self._actors[name].commands(action[np.newaxis])

    def _observe(self, *, fresh: bool) -> Values:
        new = np.array([fresh])
        return {
            name: self.rollout.look(new, ~new, self.possible_agents.index(name))[0]
            for name in self.agents
        }

    def render(self) -> Any:
        """Return a picture (H, W, 3) uint8 of the world from above, if the mode makes pictures."""
        self._show()
        return picture(self.rollout, 0) if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """End the threads, and close the window."""
        self.rollout.close()
        self._window.close()

    def _show(self) -> None:
        if self.render_mode == "human":
            self._window.show(picture(self.rollout, 0))
