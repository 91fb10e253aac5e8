"""Train a policy by PPO of Stable-Baselines3, and save it as a planner, with its learning curve.

    python benchmarks/train_ppo.py --minutes 6 --touch 12 --forced 0 --out first.onnx
    python benchmarks/train_ppo.py --start first.zip --noise 0.2 --minutes 18 --out policy.onnx

docs/howto/train_a_policy.md has the commands of the policy that comes along.

It learns in short corridors that no edition has, among few people first and many later: the next
level begins once nine of ten episodes arrive, or when its share of the time is over. ``--start``
goes on from a policy at the last level, among people who walk along, too, with less noise in its
actions: what drives well among people in spite of much noise keeps too far away without it. Beside
the policy stand ``policy.zip``, for Stable-Baselines3, and ``policy.csv`` and ``policy.svg``, its
learning curve.
Time is the processor time of this process.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import torch
from matplotlib.figure import Figure
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from crowdbot.rl import StableVecEnv, conventions, save_onnx

#: Worlds, what is seen of them, and what they are worth.
WORLDS: dict[str, Any] = {
    "suite": str(Path(__file__).parent / "training" / "nav-training.yaml"),
    "levels": [["counter-d000-*", "counter-d005-*"], "counter-d010-*",
               ["counter-d010-*", "counter-d020-*"],
               ["counter-d010-*", "counter-d020-*", "in-d010-mixed-*"]],
    "set": ["rates.planner=4 Hz", *(f"robots.robot.sensors.{name}_lidar.{field}"
            for name in ("front", "rear") for field in ("angle_step=3 deg", "rate=4 Hz"))],
    "observation": {"kind": "free_velocities", "sensor": "front_lidar", "others": ["rear_lidar"]},
    "start_spread": {"x": 0.5, "y": 3.5, "yaw": 2.0},
    "reward": {
        "kind": "comfort", "advance": 2.0, "contact": 0.0, "arrival": 5.0,
        "change": 0.02, "wall": 5.0, "time": 0.1,
    },
    "contact": "end",
    "draws": 24,
}  # fmt: skip
COLUMNS = ("processor_s", "steps", "level", "episodes", "reward", "arrived", "touched", "seconds")
#: Share of the time after which each level ends at the latest.
ENDS = (0.15, 0.4, 1.0)
READY = 0.9


class Course(BaseCallback):
    """Writes the curve, raises the level, saves the policy and stops when the time is over."""

    def __init__(self, minutes: float, out: Path, before: Sequence[tuple[float, ...]]) -> None:
        super().__init__()
        self._budget, self._out, self._rate = 60.0 * minutes, out, 1e-4 if before else 3e-4
        self._level = len(ENDS) if before else 0
        self._ended: list[tuple[float, bool, bool, float]] = []
        self._rows, self._earlier = list(before), before[-1][:2] if before else (0.0, 0)
        self._begun = time.process_time()

    def _on_training_start(self) -> None:
        env: Any = self.training_env
        env.set_level(self._level)

    @property
    def used(self) -> float:
        """Processor time since the beginning, s."""
        return time.process_time() - self._begun

    def _on_step(self) -> bool:
        for info in self.locals["infos"]:
            if "episode" in info:
                episode = info["episode"]
                self._ended.append(
                    (episode["r"], info["is_success"], info["touched"], episode["t"])
                )
        return self.used < self._budget

    def _on_rollout_end(self) -> None:
        self._learn_more_slowly()
        if len(self._ended) < self.training_env.num_envs // 2:
            return
        means = np.mean(np.array(self._ended, float), axis=0)
        spent, steps = self._earlier
        row = (
            spent + self.used,
            steps + self.num_timesteps,
            self._level,
            len(self._ended),
            *means.tolist(),
        )
        self._rows.append(row)
        self._ended.clear()
        print("  ".join(f"{name} {value:.6g}" for name, value in zip(COLUMNS, row, strict=True)),
              flush=True)  # fmt: skip
        self._raise_level(arrived=means[1])
        if len(self._rows) % 10 == 0:
            self.save()

    def _learn_more_slowly(self) -> None:
        rate = self._rate * max(0.1, 1.0 - self.used / self._budget)
        self.model.lr_schedule = lambda _: rate

    def _raise_level(self, arrived: float) -> None:
        if self._level >= len(ENDS) - 1:
            return
        over = self.used > ENDS[self._level] * self._budget
        if arrived > READY or over:
            self._level += 1
            env: Any = self.training_env
            env.set_level(self._level)

    def save(self) -> None:
        """Write the policy, the model and the curve."""
        env: Any = self.training_env
        model: Any = self.model
        save_onnx(model, env, self._out)
        model.crowdbot = conventions(env)
        model.save(self._out.with_suffix(".zip"))
        with self._out.with_suffix(".csv").open("w", newline="") as file:
            csv.writer(file).writerows([COLUMNS, *self._rows])
        draw(self._out.with_suffix(".csv"), self._out.with_suffix(".svg"))


def draw(curve: Path, out: Path) -> None:
    """Draw a learning curve: arrivals and contacts, and where levels begin."""
    matplotlib.rcParams["svg.hashsalt"] = "crowdbot"
    rows = np.atleast_1d(np.genfromtxt(curve, delimiter=",", names=True))
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.add_subplot(xlabel="processor time, min", ylabel="share of episodes")
    axes.set_ylim(0.0, 1.0)
    minutes = rows["processor_s"] / 60.0
    axes.plot(minutes, rows["arrived"], color="#117733", label="arrived")
    axes.plot(minutes, rows["touched"], color="#cc3311", label="touched a person")
    for level in np.unique(rows["level"])[1:]:
        begin = minutes[np.argmax(rows["level"] == level)]
        axes.axvline(begin, color="#999999", linewidth=0.8)
        axes.text(begin, 1.0, f" level {level:.0f}", va="bottom", fontsize=8)
    axes.legend(loc="center right")
    figure.savefig(out, metadata={"Date": None})


def train(given: argparse.Namespace) -> None:
    """Train for some processor time and save the policy."""
    torch.set_num_threads(1)
    costs = {"touch": given.touch, "forced": given.forced, "time": given.time}
    worlds = {**WORLDS, "reward": {**WORLDS["reward"], **costs}}
    env = StableVecEnv(given.worlds, threads=given.threads, **worlds)
    before: list[tuple[float, ...]] = []
    if given.start:
        model = PPO.load(given.start, env, device="cpu")
        model.policy.log_std.data.fill_(math.log(given.noise))
        rows = np.loadtxt(given.start.with_suffix(".csv"), delimiter=",", skiprows=1, ndmin=2)
        before = [tuple(row) for row in rows.tolist()]
    else:
        model = begin(env, given.seed, given.noise)
    course = Course(given.minutes, given.out, before)
    model.learn(10**9, callback=course)
    course.save()
    env.close()


def begin(env: StableVecEnv, seed: int, noise: float) -> PPO:
    """Return a policy that knows nothing."""
    return PPO(
        "MlpPolicy", env, n_steps=64, batch_size=2048, n_epochs=6, gamma=0.985, gae_lambda=0.95,
        learning_rate=3e-4, seed=seed, device="cpu",
        policy_kwargs={"net_arch": [128, 128], "log_std_init": math.log(noise)},
    )  # fmt: skip


def main(arguments: list[str]) -> None:
    """Read the arguments and train."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=6.0, help="of processor time")
    parser.add_argument("--worlds", type=int, default=96)
    parser.add_argument("--noise", type=float, default=0.5, help="deviation of actions")
    parser.add_argument("--start", type=Path, help="policy.zip, beside policy.csv, to go on from")
    parser.add_argument("--touch", type=float, default=20.0, help="cost of touching a person")
    parser.add_argument("--forced", type=float, default=40.0, help="of forcing people aside, kg/J")
    parser.add_argument("--time", type=float, default=0.1, help="cost of a second, 1/s")
    parser.add_argument("--threads", type=int, default=1, help="that step the worlds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("policy.onnx"))
    train(parser.parse_args(arguments))


if __name__ == "__main__":
    main(sys.argv[1:])
