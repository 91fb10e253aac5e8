"""Simulate a crowd in an endless corridor, at the densities of recorded crowds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from statistics import NormalDist

import numpy as np

from crowdbot.core.crowd import state as s
from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.realism.bins import CELLS, FLOWS, RATE, WINDOW
from crowdbot.core.realism.model import CrowdModel
from crowdbot.core.realism.tracks import CorridorTracks
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array

#: Width of the corridor, m, as in most of the recordings.
WIDTH = {"uni": 3.0, "counter": 3.6}
#: Densities, 1/m^2: one below the recorded cells, then those of the cells.
DENSITIES = (0.2, *(float(c) for c in CELLS))
#: Time for the crowd to settle, and time during which it is compared, s.
WARM_UP, DURATION = 6.0, 10.0
#: Sample rate before averaging over quarters of a second, Hz.
_FINE = 16
_FAR = 1e5
#: Preferred speeds lie between these multiples of their mean.
_SLOWEST, _FASTEST = 0.4, 1.6
_TRIES = 4000


@dataclass(frozen=True, slots=True, kw_only=True)
class Corridor:
    """Settings of one simulated corridor: flow, density, seed and times.

    Attributes:
        flow: ``uni`` or ``counter``.
        density: people per square metre, 1/m^2.
        seed: seed of positions and speeds.
        warm_up, duration: time before, and time of, the comparison, s.
    """

    flow: str
    density: float
    seed: int = 0
    warm_up: float = WARM_UP
    duration: float = DURATION

    @property
    def length(self) -> float:
        """Return the period along x, m; shorter with more people."""
        for density, length in ((0.7, 40.0), (1.2, 26.0), (1.7, 18.0)):
            if self.density < density:
                return length
        return 14.0


def corridors(seed: int, *, warm_up: float = WARM_UP, duration: float = DURATION) -> list[Corridor]:
    """Return the corridors to simulate: both flows at all densities."""
    return [
        Corridor(flow=f, density=d, seed=seed, warm_up=warm_up, duration=duration)
        for f in FLOWS
        for d in DENSITIES
    ]


def simulate(model: CrowdModel, corridor: Corridor) -> CorridorTracks:
    """Simulate a crowd walking through a corridor.

    Raises:
        PluginError: the policy fails.
    """
    rng = np.random.default_rng([corridor.seed, round(100 * corridor.density), 0xC0])
    width, length = WIDTH[corridor.flow], corridor.length
    count = round(corridor.density * width * length)
    at = _places(count, length, width, model.radius, rng)
    way = np.ones(count)
    if corridor.flow == "counter":
        way[::2] = -1.0
    speed = _speeds(model, count, rng)
    engine = _engine(model, corridor, at, way, speed)
    return _tracks(_walk(engine, corridor), corridor, model.radius)


def _speeds(model: CrowdModel, count: int, rng: np.random.Generator) -> Array:
    """Return preferred speeds, one from each slice of the distribution, so without outliers."""
    normal = NormalDist(model.speed, max(model.speed_deviation, 1e-9))
    slices = (rng.permutation(count) + rng.uniform(0.001, 0.999, count)) / count
    drawn = np.array([normal.inv_cdf(u) for u in slices])
    return np.asarray(np.clip(drawn, _SLOWEST * model.speed, _FASTEST * model.speed))


def _engine(
    model: CrowdModel, corridor: Corridor, at: Array, way: Array, speed: Array
) -> CrowdEngine:
    width, length = WIDTH[corridor.flow], corridor.length
    agents = Agents.of(
        x=at[:, 0], y=at[:, 1], preferred_speed=speed, radius=model.radius,
        avoided_radius=model.avoided_radius, max_speed=model.max_speed,
        max_acceleration=model.max_acceleration,
        routes=[[(x + _FAR * g, y)] for (x, y), g in zip(at, way, strict=True)],
    )  # fmt: skip
    half = 0.5 * width
    world = CrowdWorld(
        walls=np.array([[-6.0, -half, length + 6.0, -half], [-6.0, half, length + 6.0, half]]),
        periodic_boundary=(0.0, length, -np.inf, np.inf),
        steering=replace(model.steering, key=corridor.seed),
        decision_rate=model.decision_rate,
    )
    return CrowdEngine(agents, world, model.policy)


def _walk(engine: CrowdEngine, corridor: Corridor) -> Array:
    """Return walked paths (S, N, 2) at 16 Hz, without jumps at the border, m."""
    flat = engine.initial_state()
    _, rows = s.view(flat)
    steps = round((corridor.warm_up + corridor.duration) * _FINE)
    found = np.empty((steps, len(rows), 2))
    pause = TICKS_PER_SECOND // _FINE
    # In a crowd no one starts at full speed.
    slow = min(1.0, (1.2 if corridor.density < 1.0 else 0.7) / max(0.1, _mean_speed(rows)))
    rows[:, s.VX : s.VY + 1] *= slow
    for k in range(steps):
        done = 0
        while done < pause:
            done += engine.advance_alone(flat, pause - done)
        found[k, :, 0] = rows[:, s.X] - rows[:, s.LAP_X]
        found[k, :, 1] = rows[:, s.Y]
    return found


def _mean_speed(rows: Array) -> float:
    return float(np.hypot(rows[:, s.VX], rows[:, s.VY]).mean())


def _tracks(way: Array, corridor: Corridor, radius: float) -> CorridorTracks:
    """Return tracks as means over quarters of a second."""
    per = round(_FINE / RATE)
    mean = way.reshape(-1, per, *way.shape[1:]).mean(axis=1)
    at = mean.copy()
    at[..., 0] %= corridor.length
    windows = [(WINDOW * k, WINDOW * (k + 1)) for k in range(int(corridor.length // WINDOW))]
    return CorridorTracks(
        position=at,
        way=mean,
        width=WIDTH[corridor.flow],
        period=corridor.length,
        windows=np.array(windows),
        first=round(corridor.warm_up * RATE),
        last=len(mean),
        radius=radius,
    )


def _places(
    count: int, length: float, width: float, radius: float, rng: np.random.Generator
) -> Array:
    """Return (N, 2) random positions with gaps, m; with smaller gaps if there is no other space."""
    room = width - 2.0 * radius - 0.04
    apart = min(2.0 * radius + 0.06, 0.72 / np.sqrt(max(count / (length * width), 0.3)))
    at, n, tries = np.empty((count, 2)), 0, 0
    while n < count:
        p = np.array([rng.uniform(0.0, length), rng.uniform(-0.5 * room, 0.5 * room)])
        tries += 1
        if tries > _TRIES:
            apart, tries = 0.93 * apart, 0
        dx = at[:n, 0] - p[0]
        dx -= length * np.round(dx / length)
        if n and float((dx**2 + (at[:n, 1] - p[1]) ** 2).min()) < apart * apart:
            continue
        at[n] = p
        n += 1
    return at
