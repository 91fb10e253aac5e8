"""Scenario and seeds of a world's n-th episode, which depend on the world's seed alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import InputError
from crowdbot.rl.env_setup import EnvSetup

#: Roots of draws that come again are those of this number, which no suite has.
_AGAIN = "rl.again"


@dataclass(frozen=True, slots=True)
class Episode:
    """Scenario and seeds of one episode.

    Attributes:
        scenario: id.
        root: root seed of its draw of people; None: the suite's own draw.
        key: key of the random numbers of its noise.
        place: seed of its start and goal.
    """

    scenario: str
    root: int | None
    key: int
    place: int


class EpisodeCourse:
    """The sequence of episodes of one world.

    Args:
        seed: seed of the world.
        level: first level of the curriculum.

    Attributes:
        level: level of the next episode.
    """

    def __init__(self, setup: EnvSetup, seed: int, level: int = 0) -> None:
        self._setup, self._seed, self._number = setup, seed, -1
        self.level = level

    def next(self, level: int | None = None) -> Episode:
        """Return the next episode.

        Args:
            level: of the curriculum, from now on; None: as before.

        Raises:
            InputError: there is no such level.
        """
        if level is not None:
            self.set_level(level)
        self._number += 1
        chosen = self._setup.levels[self.level]
        scenario = chosen[self._draw("scenario") % len(chosen)].id
        return Episode(scenario, self._root(scenario), self._draw("noise"), self._draw("place"))

    def set_level(self, level: int) -> None:
        """Set the level of the curriculum from the next episode on.

        Raises:
            InputError: there is no such level.
        """
        count = len(self._setup.levels)
        if not 0 <= level < count:
            raise InputError(f"level {level} of {count}: levels count from 0")
        self.level = level

    def _draw(self, stream: str) -> int:
        return stream_seed(self._seed, str(self._number), f"rl.{stream}")

    def _root(self, scenario: str) -> int | None:
        """Return the root seed of the draw of people; None: the suite's own draw."""
        setup = self._setup
        if setup.edition:
            return None
        if setup.draws is None:
            return self._draw("crowd")
        number = self._draw("crowd") % setup.draws
        return stream_seed(number, scenario, _AGAIN)


def seeds_of(seed: int | list[int | None] | None, count: int) -> list[int | None]:
    """Return the seed of each world, as in Gymnasium; None: unchanged.

    Raises:
        InputError: there is another number of seeds, or one is negative.
    """
    if seed is None:
        return [None] * count
    if isinstance(seed, int | np.integer):
        seeds: list[int | None] = [int(seed) + k for k in range(count)]
    else:
        seeds = [None if s is None else int(s) for s in seed]
    if len(seeds) != count:
        raise InputError(f"{len(seeds)} seeds for {count} worlds")
    if any(s is not None and s < 0 for s in seeds):
        raise InputError("seeds must not be negative")
    return seeds
