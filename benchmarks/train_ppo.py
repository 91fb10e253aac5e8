"""Train a policy by PPO of Stable-Baselines3, and save it as a planner, with its learning curve.

    python benchmarks/train_ppo.py --minutes 25 --out first.onnx
    python benchmarks/train_ppo.py --start taught.zip --values 0.7 --noise 0.1 --out policy.onnx

docs/howto/train_a_policy.md has the commands of the policy that comes along.

It learns in short corridors that no edition has, among few people first and many later: the next
level begins once nine of ten episodes arrive, or when its share of the time is over. ``--start``
goes on from a policy at the last level, among people who walk along, too, or in a ``--suite`` with
new draws of people; with less noise in its actions: what drives well among people in spite of much
noise keeps too far away without it. With more ``--directions`` than before it begins with the same
actions. It may also go on from what benchmarks/imitate.py has taught; then it learns for the first
``--values`` minutes only how much what it sees is worth. Beside the policy stand ``policy.zip``,
for Stable-Baselines3, and ``policy.csv`` and ``policy.svg``, its learning curve.
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
from numpy.typing import NDArray
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from crowdbot.rl import StableVecEnv, conventions, save_onnx

#: Worlds, what is seen of them, and what they are worth.
WORLDS: dict[str, Any] = {
    "suite": str(Path(__file__).parent / "training" / "nav-training.yaml"),
    "levels": [["counter-d000-*", "counter-d005-*"], "counter-d010-*",
               ["counter-d010-*", "counter-d020-*"],
               ["counter-d010-*", "counter-d020-*", "in-d010-mixed-*"]],
    "observation": {
        "kind": "free_velocities", "sensor": "front_lidar", "others": ["rear_lidar"],
        "directions": 33, "widest": 2.4, "speeds": 3, "people": 12,
    },
    "start_spread": {"x": 0.5, "y": 3.5, "yaw": 2.0},
    "reward": {
        "kind": "comfort", "contact": 0.0, "arrival": 5.0, "change": 0.02, "wall": 5.0,
    },
    "contact": "end",
    "draws": 24,
}  # fmt: skip
COLUMNS = ("processor_s", "steps", "level", "episodes", "reward", "arrived", "touched", "seconds")
#: Costs that options set.
COSTS = ("touch", "forced", "aside", "advance", "time")
#: Episodes whose mean the curve shows.
LATELY = 30
#: Share of the time after which each level ends at the latest.
ENDS = (0.15, 0.4, 1.0)
READY = 0.9


class Course(BaseCallback):
    """Writes the curve, raises the level, saves the policy and stops when the time is over."""

    def __init__(self, given: argparse.Namespace, before: Sequence[tuple[float, ...]]) -> None:
        super().__init__()
        self._budget: float = 60.0 * given.minutes
        self._alone: float = 60.0 * given.values
        self._out: Path = given.out
        self._rate: float = given.learning_rate or (1e-4 if before else 3e-4)
        self._level = len(ENDS) + bool(given.suite) if before else 0
        self._ended: list[tuple[float, bool, bool, float]] = []
        self._rows, self._earlier = list(before), before[-1][:2] if before else (0.0, 0)
        self._begun = time.process_time()

    def _on_training_start(self) -> None:
        env: Any = self.training_env
        env.set_level(self._level)

    def _on_rollout_start(self) -> None:
        """Let the actor learn only once the values are known."""
        policy: Any = self.model.policy
        for part in (policy.mlp_extractor.policy_net, policy.action_net):
            part.requires_grad_(self.used >= self._alone)

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
    axes.plot(minutes, lately(rows, "arrived"), color="#117733", label="arrived")
    axes.plot(minutes, lately(rows, "touched"), color="#cc3311", label="touched a person")
    for level in np.unique(rows["level"])[1:]:
        begin = minutes[np.argmax(rows["level"] == level)]
        what = f"level {level:.0f}" if level < len(ENDS) else "goes on from a policy"
        axes.axvline(begin, color="#999999", linewidth=0.8)
        axes.text(begin, 1.0, f" {what}", va="bottom", fontsize=8)
    axes.legend(loc="center right")
    figure.savefig(out, metadata={"Date": None})


def lately(rows: Any, name: str) -> NDArray[np.float64]:
    """Return a share at each row: of the last 30 episodes or somewhat more, at first of fewer."""
    total = np.concatenate([[0.0], np.cumsum(rows["episodes"])])
    hits = np.concatenate([[0.0], np.cumsum(rows["episodes"] * rows[name])])
    since = np.maximum(np.searchsorted(total, total[1:] - LATELY, side="right") - 1, 0)
    shares: NDArray[np.float64] = (hits[1:] - hits[since]) / np.maximum(
        total[1:] - total[since], 1e-9
    )
    return shares


def train(given: argparse.Namespace) -> None:
    """Train for some processor time and save the policy."""
    torch.set_num_threads(1)
    env = StableVecEnv(given.worlds, threads=given.threads, **worlds_of(given))
    before: list[tuple[float, ...]] = []
    if given.start:
        model = go_on(env, given)
        rows = np.loadtxt(given.start.with_suffix(".csv"), delimiter=",", skiprows=1, ndmin=2)
        before = [tuple(row) for row in rows.tolist()]
    else:
        model = begin(env, given)
    course = Course(given, before)
    model.learn(10**9, callback=course)
    course.save()
    env.close()


def worlds_of(given: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of the environment."""
    costs = {name: getattr(given, name) for name in COSTS}
    lidars = (f"robots.robot.sensors.{name}_lidar.{field}" for name in ("front", "rear")
              for field in ("angle_step=3 deg", f"rate={given.hertz} Hz"))  # fmt: skip
    step = WORLDS["observation"]["widest"] / (WORLDS["observation"]["directions"] // 2)
    fan = {"directions": given.directions, "widest": step * (given.directions // 2)}
    worlds = {**WORLDS, "set": [f"rates.planner={given.hertz} Hz", *lidars],
              "observation": {**WORLDS["observation"], **fan}}  # fmt: skip
    if given.suite:
        only = given.only or ["*"]
        worlds |= {"suite": given.suite, "levels": [only] * (len(WORLDS["levels"]) + 1)}
    return worlds | {"reward": {**WORLDS["reward"], **costs}}


def horizon(hertz: int) -> dict[str, Any]:
    """Return what makes the horizons of learning equally long in seconds at any rate."""
    share = 4.0 / hertz
    return {"n_steps": 16 * hertz, "gamma": 0.985**share, "gae_lambda": 0.95**share}


def begin(env: StableVecEnv, given: argparse.Namespace) -> PPO:
    """Return a policy that knows nothing."""
    return PPO(
        "MlpPolicy", env, batch_size=2048, n_epochs=6, learning_rate=3e-4, seed=given.seed,
        device="cpu", **horizon(given.hertz),
        policy_kwargs={"net_arch": [256, 256], "log_std_init": math.log(given.noise)},
    )  # fmt: skip


def go_on(env: StableVecEnv, given: argparse.Namespace) -> PPO:
    """Return a policy that knows what another one does, and may see in more directions."""
    model = begin(env, given)
    before: Any = PPO.load(given.start, device="cpu")
    fan = before.crowdbot["observation"]
    known = before.policy.state_dict()
    for name, weight in known.items():
        if name.startswith("mlp_extractor") and name.endswith("net.0.weight"):
            known[name] = widened(weight, fan["directions"], given.directions, fan["speeds"])
    model.policy.load_state_dict(known)
    if fan["directions"] == given.directions:
        model.policy.optimizer.load_state_dict(before.policy.optimizer.state_dict())
    model.policy.log_std.data.fill_(math.log(given.noise))
    return model


def widened(weight: torch.Tensor, before: int, after: int, speeds: int) -> torch.Tensor:
    """Return the first weights of a fan with more directions on both sides, which weigh nothing.

    Args:
        weight: (outputs, inputs); the fan comes first, speed by speed.
        before, after: how many directions it has.
        speeds: how many speeds.
    """
    size, more = 2 * speeds * before, (after - before) // 2
    fan = weight[:, :size].reshape(len(weight), speeds, before, 2)
    wider = torch.nn.functional.pad(fan, (0, 0, more, more)).flatten(1)
    return torch.cat([wider, weight[:, size:]], dim=1)


def add_worlds(parser: argparse.ArgumentParser) -> None:
    """Add the options of the worlds and of the policy."""
    parser.add_argument("--worlds", type=int, default=96)
    parser.add_argument("--noise", type=float, default=0.5, help="deviation of actions")
    parser.add_argument("--touch", type=float, default=20.0, help="cost of touching a person")
    parser.add_argument("--forced", type=float, default=40.0, help="of forcing people aside, kg/J")
    parser.add_argument("--aside", type=float, default=0.0, help="cost of a person driven aside")
    parser.add_argument("--advance", type=float, default=2.0, help="of a metre towards them, 1/m")
    parser.add_argument("--time", type=float, default=0.1, help="cost of a second, 1/s")
    parser.add_argument("--directions", type=int, default=33, help="seen, 0.15 rad apart")
    parser.add_argument("--hertz", type=int, default=8, help="decisions a second")
    parser.add_argument("--suite", help="to go on in, instead of the corridors")
    parser.add_argument("--only", action="append", help="pattern of its scenario ids")
    parser.add_argument("--threads", type=int, default=1, help="that step the worlds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("policy.onnx"))


def main(arguments: list[str]) -> None:
    """Read the arguments and train."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=6.0, help="of processor time")
    parser.add_argument("--values", type=float, default=0.0, help="first minutes, for values only")
    parser.add_argument("--start", type=Path, help="policy.zip, beside policy.csv, to go on from")
    parser.add_argument("--learning-rate", type=float, help="at the beginning")
    add_worlds(parser)
    train(parser.parse_args(arguments))


if __name__ == "__main__":
    main(sys.argv[1:])
