"""Reference cases of the original engine: one step at a time from its own states."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from crowd_reference import Array, agents_of, choice_costs

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.contact import push_apart
from crowdbot.core.crowd.policy import Agents, CrowdView
from crowdbot.core.crowd.sampling import Sampler, fan
from crowdbot.dsl.base import CostFunctionSpec, Range
from crowdbot.plugins.crowd.rvo import RvoSpec
from crowdbot.plugins.crowd.rvo_build import build as build_rvo
from crowdbot.plugins.crowd.ttca_dca import TtcaDcaSpec
from crowdbot.plugins.crowd.ttca_dca_build import build as build_ttca_dca

FOLDER = Path(__file__).parent.parent / "data" / "oracle"
NAMES = sorted(p.stem for p in FOLDER.glob("*.npz"))
CLOSE = 5e-4  # m/s
CONTACT_STIFFNESS = 62.5  # the original's default


def compiled(spec: CostFunctionSpec) -> Any:
    """The compiled form of one cost function."""
    if isinstance(spec, TtcaDcaSpec):
        return build_ttca_dca(spec)
    assert isinstance(spec, RvoSpec)
    return build_rvo(spec)


@dataclass(frozen=True)
class Case:
    """One case; before (K, N, 4) x, y, vx, vy; after (K, N, 4) one step later."""

    before: Array
    after: Array
    agents: Agents
    goal: Array
    walls: Array
    specs: list[CostFunctionSpec]
    candidates: Array
    scale: Array  # largest sampled speed over preferred speed, per agent
    relaxation: float
    dt: float
    torus: float

    def step(self, state: Array) -> Array:
        """Velocities (N, 2) after one step from a state (N, 4)."""
        view = self.view(state)
        difference = self.choose(view) - state[:, 2:]
        time = self._time(state)[:, np.newaxis]
        acceleration = _limit(difference / time, self.agents.max_acceleration)
        velocity = _limit(state[:, 2:] + acceleration * self.dt, self.agents.max_speed)
        return velocity + self._push(view) * self.dt / self.agents.mass[:, np.newaxis]

    def _time(self, state: Array) -> Array:
        """In which the chosen velocity is reached; who has arrived stops at once."""
        arrived = np.hypot(*(self.goal - state[:, :2]).T) <= self.agents.radius
        return np.where(arrived, self.dt, max(self.relaxation, self.dt))

    def view(self, state: Array) -> CrowdView:
        """The torus' images stand in the view as further bodies."""
        images = [np.zeros((0, 5))]
        for shift in (-self.torus, self.torus) if math.isfinite(self.torus) else ():
            image = np.column_stack([state, self.agents.radius])
            image[:, 0] += shift
            images.append(image)
        return CrowdView(
            agents=self.agents, position=np.ascontiguousarray(state[:, :2]),
            velocity=np.ascontiguousarray(state[:, 2:]), goal=self.goal,
            present=np.ones(len(state), np.bool_), robot=np.concatenate(images),
            walls=self.walls, dt=self.dt,
        )  # fmt: skip

    def choose(self, view: CrowdView) -> Array:
        """Chosen velocities; agents that sample up to another speed have a sampler of their own."""
        costs = [compiled(spec) for spec in self.specs]
        chosen = np.empty_like(view.velocity)
        for scale in np.unique(self.scale):
            who = self.scale == scale
            chosen[who] = Sampler(self.candidates * scale, costs, self.agents).choose(view)[who]
        return chosen

    def _push(self, view: CrowdView) -> Array:
        n = len(self.agents)
        rows = np.zeros((n + len(view.robot), s.AGENT_COLUMNS))
        rows[:n, s.X : s.Y + 1] = view.position
        rows[n:, s.X : s.Y + 1] = view.robot[:, :2]
        radius = np.concatenate([self.agents.radius, view.robot[:, 4]])
        order = np.argsort(rows[:, s.X], kind="stable")
        push_apart(rows, radius, order, self.walls, CONTACT_STIFFNESS)
        return rows[:n, s.PUSH_X : s.PUSH_Y + 1]

    def is_tie(self, state: Array, i: int, theirs: Array, rng: np.random.Generator) -> bool:
        """Whether float32 rounding may have decided agent i's choice.

        The original's velocity is reached from an input changed by at most 1e-5, or the cost of
        its choice lies within 1e-3 (relative) or 1e-6 (absolute) of the least cost, be the
        candidates at exactly the largest speed allowed or forbidden.
        """
        view = self.view(state)
        u, total = choice_costs(view, self.specs, self.candidates * self.scale[i], i)
        velocity = state[i, 2:] + np.array(
            [_limit((c - state[i, 2:])[np.newaxis] / self._time(state)[i],
                    self.agents.max_acceleration[i])[0] for c in u]
        ) * self.dt  # fmt: skip
        velocity = _limit(velocity, self.agents.max_speed[i])
        same = np.hypot(*(velocity + self._push(view)[i] * self.dt - theirs).T) < CLOSE
        on_limit = np.hypot(*u.T) > self.agents.max_speed[i] * (1.0 - 1e-6)
        for least in (float(np.min(total)), float(np.min(total[~on_limit]))):
            if np.any(same & (total <= least + max(1e-3 * abs(least), 1e-6))):
                return True
        return any(
            np.hypot(*(self.step(state + rng.uniform(-1e-5, 1e-5, state.shape))[i] - theirs))
            < CLOSE
            for _ in range(32)
        )


def _limit(vectors: Array, largest: Array | float) -> Array:
    norm = np.hypot(vectors[:, 0], vectors[:, 1])
    scale = np.where(norm > largest, largest / np.maximum(norm, 1e-300), 1.0)
    return np.asarray(vectors * scale[:, np.newaxis])


def load(name: str) -> Case:
    """A case by name."""
    with np.load(FOLDER / f"{name}.npz") as data:
        arrays = {k: np.asarray(data[k]) for k in data.files}
    settings = json.loads(str(arrays["settings"]))
    goal, table = arrays["agents"][:, :2], arrays["agents"][:, 2:]
    before = arrays["before"].astype(np.float64)
    agents = Agents.of(
        id=np.arange(len(table)), x=before[0, :, 0].copy(), y=before[0, :, 1].copy(),
        radius=table[:, 0].copy(), preferred_speed=table[:, 1].copy(),
        max_speed=table[:, 2].copy(), max_acceleration=table[:, 3].copy(), mass=table[:, 4].copy(),
    )  # fmt: skip
    attributes = settings["attributes"]
    by_max = attributes["SamplingRadius"] == "maximum speed"
    assert attributes["SamplingBase"] == "zero"
    assert attributes["SamplingBaseDirection"] == "preferred velocity"
    assert attributes["IncludeBaseAsSample"] == "true"
    return Case(
        before=before,
        after=arrays["after"].astype(np.float64),
        agents=agents,
        goal=np.ascontiguousarray(goal),
        walls=arrays["walls"],
        specs=[_spec(c) for c in settings["costs"]],
        candidates=fan(
            int(attributes["SpeedSamples"]),
            int(attributes["AngleSamples"]),
            math.radians(float(attributes["SamplingAngle"])),
        ),
        scale=agents.max_speed / agents.preferred_speed if by_max else np.ones(len(table)),
        relaxation=float(attributes["RelaxationTime"]),
        dt=float(settings["dt"]),
        torus=float(settings["world"].get("width", math.inf)),
    )


def _spec(given: Mapping[str, str]) -> CostFunctionSpec:
    weight, reach = float(given.get("coeff", 1.0)), Range(value=float(given["range"]))
    if given["name"] == "RVO":
        return RvoSpec(weight=weight, range=reach)
    return TtcaDcaSpec(
        weight=weight, range=reach, sigma_ttca=float(given["sigmaTtca"]),
        sigma_dca=float(given["sigmaDca"]), sigma_angle_goal=float(given["sigmaAngle_goal"]),
        sigma_speed_goal=float(given["sigmaSpeed_goal"]),
    )  # fmt: skip


__all__ = ["CLOSE", "NAMES", "Case", "agents_of", "compiled", "load"]
