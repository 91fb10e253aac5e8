"""Teach a policy of Stable-Baselines3's PPO what a planner would do; train_ppo.py goes on from it.

    python benchmarks/imitate.py --out taught.onnx
    python benchmarks/train_ppo.py --start taught.zip --values 0.7 --noise 0.1 --out policy.onnx

docs/howto/train_a_policy.md has the commands of the policy that comes along. In each round 96
robots drive for some seconds in the worlds of train_ppo.py, all as the planner says at first, then
half of them as the policy does so far (DAgger: Ross, Gordon, Bagnell 2011). The planner, which is
told the truth within 6 m, says at each step what it would do; then the policy learns all that has
been said so far. Beside the policy stand ``policy.zip`` and ``policy.csv``, as of train_ppo.py.
Time is the processor time of this process.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from teachers import Teachers
from train_ppo import COLUMNS, add_worlds, begin, worlds_of

from crowdbot.rl import StableVecEnv, conventions, save_onnx

Array = NDArray[np.float32]
#: Level of the worlds: people who come towards the robot at the two higher densities.
LEVEL = 2


class Lessons:
    """All that a teacher has said, and the policy that learns it."""

    def __init__(self, env: StableVecEnv, model: Any, given: argparse.Namespace) -> None:
        self._env, self._model, self._policy = env, model, model.policy
        self._random = np.random.default_rng(given.seed)
        self._teachers = Teachers(env.worlds, given.teacher, hurry_within=given.hurry_within)
        env.set_level(LEVEL)
        self._seen: Any = env.reset()
        self._teachers.begin(np.ones(env.num_envs, np.bool_))
        self._said: tuple[list[Array], list[Array]] = ([], [])
        self._adam = torch.optim.Adam(self._policy.parameters(), lr=1e-3)
        self.ended: list[tuple[float, bool, bool, float]] = []

    def drive(self, steps: int, taught: bool) -> None:
        """Drive all worlds, and keep what is seen and said.

        Args:
            taught: True if the policy already drives every second world.
        """
        mine = np.arange(self._env.num_envs) % 2 == 1
        for _ in range(steps):
            values = self._teachers.actions().astype(np.float32)
            self._said[0].append(self._seen.copy())
            self._said[1].append(values)
            done, _ = self._model.predict(self._seen, deterministic=True)
            noisy = values + 0.1 * self._random.standard_normal(values.shape)
            driven = np.where((mine & taught)[:, np.newaxis], done, noisy)
            self._env.step_async(np.clip(driven, -1.0, 1.0).astype(np.float32))
            self._seen, _, over, infos = self._env.step_wait()
            self._teachers.begin(over)
            for info in (infos[w] for w in np.flatnonzero(over & mine).tolist()):
                one = info["episode"]
                self.ended.append((one["r"], info["is_success"], info["touched"], one["t"]))

    def learn(self, passes: int, rate: float) -> float:
        """Learn all that was said, some times over; return the error that is left."""
        seen, values = (torch.from_numpy(np.concatenate(rows)) for rows in self._said)
        scale, huber = values.std(dim=0), torch.nn.functional.smooth_l1_loss
        for group in self._adam.param_groups:
            group["lr"] = rate
        for _ in range(passes):
            errors: list[float] = []
            for rows in torch.randperm(len(seen)).split(1024):
                hidden = self._policy.mlp_extractor.forward_actor(seen[rows])
                error = (self._policy.action_net(hidden) - values[rows]) / scale
                loss: Any = huber(error, torch.zeros_like(error), beta=0.5)
                self._adam.zero_grad()
                loss.backward()
                self._adam.step()
                errors.append(float(loss.detach()))
        return float(np.mean(errors))


def teach(given: argparse.Namespace) -> None:
    """Teach a policy and save it."""
    torch.set_num_threads(1)
    env = StableVecEnv(given.worlds, threads=given.threads, **worlds_of(given))
    model: Any = begin(env, given)
    lessons, begun, rows = Lessons(env, model, given), time.process_time(), []
    for k in range(given.rounds):
        lessons.drive(given.steps, taught=k > 1)
        last = k == given.rounds - 1
        error = lessons.learn(12 if last else 3, 3e-4 if last else 1e-3)
        ended = lessons.ended or [(0.0, False, False, 0.0)]
        spent, steps = time.process_time() - begun, (k + 1) * given.steps * given.worlds
        rows.append((spent, steps, LEVEL, len(ended), *np.mean(np.array(ended, float), axis=0)))
        values = (f"{n} {v:.5g}" for n, v in zip(COLUMNS, rows[-1], strict=True))
        print(f"{k} error {error:.4f}  ", *values, flush=True)
        lessons.ended.clear()
        if k % 4 == 3 or last:
            save_onnx(model, env, given.out)
            model.crowdbot = conventions(env)
            model.save(given.out.with_suffix(".zip"))
    with given.out.with_suffix(".csv").open("w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    env.close()


def main(arguments: list[str]) -> None:
    """Read the arguments and teach."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--teacher", default="people_mpc", help="planner, told the truth")
    parser.add_argument("--hurry-within", type=float, default=0.8, help="as of people_mpc")
    parser.add_argument("--rounds", type=int, default=16)
    parser.add_argument("--steps", type=int, default=120, help="of each world in a round")
    add_worlds(parser)
    teach(parser.parse_args(arguments))


if __name__ == "__main__":
    main(sys.argv[1:])
