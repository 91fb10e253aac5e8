"""Train a small policy by evolution strategies, and save it as a planner.

    python train_policy.py --minutes 60 --out policy.onnx

Source: Salimans, Ho, Chen, Sidor, Sutskever, "Evolution strategies as a scalable alternative to
reinforcement learning" (2017), with mirrored samples and ranks in place of returns.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.rl

Numbers = NDArray[np.float64]
#: Low and medium counterflow, with people that no edition has.
WORLDS: dict[str, Any] = {
    "suite": "challenge-2020",
    "scenario": ["counter-d0125-*-c20-r05", "counter-d0250-*-c20-r05"],
    "set": ["robots.robot.task.time_limit=60"],
    "observation": {"kind": "lidar_stack", "sensor": "front_lidar", "sectors": 18, "scans": 2},
    "reward": "comfort",
    "draws": 64,
}
HIDDEN, NOISE, RATE = 16, 0.05, 0.03


def layers_of(numbers: Numbers, inputs: int, outputs: int) -> list[tuple[Numbers, Numbers]]:
    """The layers of a policy whose weights and biases are these numbers."""
    found, at = [], 0
    for a, b in ((inputs, HIDDEN), (HIDDEN, outputs)):
        weight = numbers[at : at + a * b].reshape(a, b)
        found.append((weight, numbers[at + a * b : at + a * b + b]))
        at += a * b + b
    return found


def actions_of(population: Numbers, seen: Numbers, outputs: int) -> Numbers:
    """Actions (W, outputs) of policies (W, P), each of what its own world shows (W, inputs)."""
    inputs = seen.shape[1]
    first, rest = population[:, : inputs * HIDDEN], population[:, inputs * HIDDEN :]
    hidden = np.einsum("wi,wih->wh", seen, first.reshape(-1, inputs, HIDDEN))
    hidden = np.tanh(hidden + rest[:, :HIDDEN])
    last = rest[:, HIDDEN:].reshape(len(rest), -1)
    weight = last[:, : HIDDEN * outputs].reshape(-1, HIDDEN, outputs)
    return np.asarray(np.einsum("wh,who->wo", hidden, weight) + last[:, HIDDEN * outputs :])


def returns(env: Any, population: Numbers, steps: int, seed: int) -> Numbers:
    """Return the sum of rewards of each policy (W, P) in its world, in at most some steps."""
    pairs = len(population) // 2
    # Both of a mirrored pair meet the same people.
    seen, _ = env.reset(seed=[seed + k for k in (*range(pairs), *range(pairs))])
    total, alive = np.zeros(len(population)), np.ones(len(population), bool)
    for _ in range(steps):
        actions = actions_of(population, seen.astype(float), env.single_action_space.shape[0])
        seen, reward, done, late, _ = env.step(np.clip(actions, -1.0, 1.0))
        total += np.where(alive, reward, 0.0)
        alive &= ~(done | late)
        if not alive.any():
            break
    return total


def train(minutes: float, worlds: int, steps: int, out: Path) -> list[float]:
    """Train for some time and save the policy; return the mean return of each generation."""
    env = crowdbot.rl.NavVectorEnv(worlds, **WORLDS)
    inputs, outputs = env.single_observation_space.shape[0], env.single_action_space.shape[0]
    rng = np.random.default_rng(1)
    centre = np.zeros((inputs + 1) * HIDDEN + (HIDDEN + 1) * outputs)
    centre[: inputs * HIDDEN] = rng.normal(0.0, 0.1, inputs * HIDDEN)
    curve: list[float] = []
    end = time.monotonic() + 60.0 * minutes
    while not curve or time.monotonic() < end:
        half = rng.normal(size=(worlds // 2, len(centre)))
        noise = np.concatenate([half, -half])
        earned = returns(env, centre + NOISE * noise, steps, seed=len(curve) * worlds)
        rank = np.argsort(np.argsort(earned)) / (worlds - 1) - 0.5
        centre += RATE * (rank @ noise) / (worlds * NOISE)
        curve.append(float(earned.mean()))
        crowdbot.rl.save_layers(layers_of(centre, inputs, outputs), env, out)
        print(f"generation {len(curve)}: mean return {curve[-1]:.2f}", flush=True)
    return curve


def main(arguments: list[str]) -> None:
    """Read the arguments and train."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--worlds", type=int, default=64, help="even: policies tried at once")
    parser.add_argument("--steps", type=int, default=960, help="of each, at most")
    parser.add_argument("--out", type=Path, default=Path("policy.onnx"))
    given = parser.parse_args(arguments)
    train(given.minutes, given.worlds, given.steps, given.out)


if __name__ == "__main__":
    main(sys.argv[1:])
