"""Sampling shared by flows, streams and spawns, from named random streams."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.types.arrays import Array, Point
from crowdbot.dsl.scenario.people_kinds import WIDEST, LengthDistribution, MassDistribution
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.dsl.scenario.spawning import GroupSize
from crowdbot.dsl.spec.areas import Area, Place
from crowdbot.dsl.spec.parameters import Sample, SpeedDistribution
from crowdbot.dsl.spec.spec import Rectangle

#: Function from purpose and unit, such as a person, to a generator.
RngOf = Callable[[str, int], np.random.Generator]


@dataclass(frozen=True, slots=True)
class Streams:
    """The named random streams of a crowd."""

    root: int
    key: str

    def seed(self, name: str) -> int:
        """Return the seed of a stream."""
        return stream_seed(self.root, self.key, name)

    def rng(self, name: str, unit: int | None = None) -> np.random.Generator:
        """Return a stream, or that of one of its units, such as a group."""
        seed = self.seed(name)
        return np.random.default_rng(seed if unit is None else (seed, unit))


def area_of(place: Place, zones: Mapping[str, Rectangle]) -> Area:
    """Return an area from a zone's name or an area."""
    return Area.of(zones[place]) if isinstance(place, str) else place


def heading_to(x: float, y: float, goal: Point) -> float:
    """Return the direction from one point to another, rad; 0 if they are equal."""
    return math.atan2(goal[1] - y, goal[0] - x)


def stream_heading(portals: tuple[str, str], boxes: Mapping[str, Rectangle]) -> float:
    """Return the direction from the centre of one portal to that of the other, rad."""
    start, end = (Area.of(boxes[name]).centre for name in portals)
    return heading_to(*start, end)


def draw_speeds(rng: np.random.Generator, count: int, speed: SpeedDistribution) -> Array:
    """Sample speeds (count,), m/s.

    Normal, truncated at three standard deviations and at 5 % of the mean.
    """
    mean, std = speed.mean, speed.std
    low, high = max(mean - 3.0 * std, 0.05 * mean), mean + 3.0 * std
    speeds = np.empty(count)
    for i in range(count):
        draw = rng.normal(mean, std)
        while not low <= draw <= high:
            draw = rng.normal(mean, std)
        speeds[i] = draw
    return speeds


def draw_attention(streams: Streams, name: str, unit: int) -> float:
    """Return the attention of one person of a stream, independent of other people."""
    return float(streams.rng(name, unit).random())


def draw_one(
    rng: np.random.Generator,
    spread: Sample | SpeedDistribution | LengthDistribution | MassDistribution,
) -> float:
    """Return one sample of a distribution, in its unit."""
    if isinstance(spread, SpeedDistribution):
        return float(draw_speeds(rng, 1, spread)[0])
    if isinstance(spread, Sample):
        return spread.value + spread.spread * (2.0 * rng.random() - 1.0)
    return draw_normal(rng, spread.mean, spread.std)


def draw_numbers(rng: np.random.Generator, count: int, spread: Sample | SpeedDistribution) -> Array:
    """Draw (count,) numbers of a distribution, in its unit."""
    if isinstance(spread, SpeedDistribution):
        return draw_speeds(rng, count, spread)
    return np.array([draw_one(rng, spread) for _ in range(count)])


def draw_normal(rng: np.random.Generator, mean: float, std: float) -> float:
    """Sample from a normal distribution, truncated at `WIDEST` deviations and 5 % of the mean."""
    low, high = max(mean - WIDEST * std, 0.05 * mean), mean + WIDEST * std
    while not low <= (draw := float(rng.normal(mean, std))) <= high:
        pass
    return draw


def draw_groups(
    sizes: Sequence[GroupSize], rng: np.random.Generator, count: int | None, groups: int | None
) -> list[range]:
    """Return the members of each group, numbered from 0.

    Args:
        sizes: frequency of each group size; if empty, everyone is alone.
        count: number of people; the last group may be smaller.
        groups: number of groups; this or ``count``.
    """
    edges = np.cumsum([g.frequency for g in sizes])
    found: list[range] = []
    end = 0
    while end < count if count is not None else len(found) < (groups or 0):
        size = 1
        if len(edges):
            size = sizes[int(np.searchsorted(edges, rng.random() * edges[-1], side="right"))].size
        size = min(size, count - end) if count is not None else size
        found.append(range(end, end + size))
        end += size
    return found
