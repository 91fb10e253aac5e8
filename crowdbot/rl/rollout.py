"""W worlds of one robot each, reset and stepped by index."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.batch.bank import Bank
from crowdbot.core.batch.parallel import Batches, parts_of
from crowdbot.core.batch.world import BatchWorld
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array, Indices, Mask
from crowdbot.errors import InputError
from crowdbot.rl.actor import Actor, StepResult, Vectors
from crowdbot.rl.env_setup import EnvSetup
from crowdbot.rl.episodes import Episode, EpisodeCourse
from crowdbot.rl.scatter import scatter


class Rollout:
    """Worlds, with the observations and rewards of their robots.

    Args:
        seeds: (W,) of the worlds.
        threads: number of threads that step them.

    Attributes:
        actors: the robots of each world, in order.
        rows: (W, R, 8) present states of the robots, see `RobotRecord`.
        scenarios: (W,) id of each world's scenario.
    """

    def __init__(self, setup: EnvSetup, seeds: Sequence[int], threads: int = 1) -> None:
        self.setup, count = setup, len(seeds)
        robots = len(next(iter(setup.blueprints.values())).models)
        self.actors = [Actor(setup, count, robot) for robot in range(robots)]
        self._courses = [EpisodeCourse(setup, seed) for seed in seeds]
        keep = setup.draws is not None or setup.edition
        self._banks = [Bank(keep=keep) for _ in range(max(1, min(threads, count)))]
        self.batches = self._first()
        self.rows = np.zeros((count, robots, 8))
        self.scenarios = np.full(count, "", object)
        self._people = np.zeros(count, np.int64)
        self._seen = np.zeros((count, 0, 5))
        for w in range(count):
            self._note(w)
        self._gather()

    def _first(self) -> Batches:
        """Return the worlds of the first episodes."""
        episodes = [course.next() for course in self._courses]
        worlds = [self._take(self._banks[0], episodes[0])]
        parts = parts_of(len(episodes), len(self._banks), worlds[0].people)
        for bank, (begin, end) in zip(self._banks, parts, strict=True):
            worlds += [self._take(bank, one) for one in episodes[max(begin, 1) : end]]
        return Batches(worlds, [episode.key for episode in episodes], parts)

    def begin(self, which: Mask, seeds: Sequence[int | None], level: int | None = None) -> None:
        """Begin new episodes in some worlds.

        Args:
            which: (W,) worlds that begin.
            seeds: (W,) new seeds; None: the next episode of the present one.
            level: of the curriculum; None: as before.

        Raises:
            InputError: there is no such level, or the people of a draw do not fit.
        """
        for w in np.flatnonzero(which).tolist():
            seed = seeds[w]
            if seed is not None:
                self._courses[w] = EpisodeCourse(self.setup, seed, self._courses[w].level)
            episode = self._courses[w].next(level)
            bank = self._banks[self.batches.thread_of(w)]
            bank.give_back(self.world(w))
            self.batches.put(w, self._take(bank, episode), episode.key)
            self._note(w)
        self._gather()

    def _gather(self) -> None:
        """Read robots and, if they are observed, people of worlds that have begun."""
        self.batches.robots(self.rows)
        if self.setup.observation.privileged or self.setup.observation.tracks:
            most = int(self._people.max(initial=0))
            if self._seen.shape[1] != most:
                self._seen = np.zeros((len(self._people), most, 5))
            self.batches.show_people(self._seen)

    def _take(self, bank: Bank, episode: Episode) -> BatchWorld:
        """Return the world of an episode, with its own start and goal if they are drawn."""
        world = bank.take(self.setup.blueprints[episode.scenario], episode.root)
        if self.setup.spread is not None:
            scatter(world, self.setup.spread, episode.place)
            world.reset()
        return world

    def set_level(self, level: int) -> None:
        """Set the level of the curriculum from the next episode of each world on.

        Raises:
            InputError: there is no such level.
        """
        for course in self._courses:
            course.set_level(level)

    def _note(self, w: int) -> None:
        world = self.world(w)
        self._people[w], self.scenarios[w] = world.people, world.blueprint.scenario.id
        for actor in self.actors:
            actor.begin(w, world.tasks)

    def advance(self, commands: Array, which: Indices) -> None:
        """Advance some worlds by one step.

        Args:
            commands: (W, R, 3) of all robots.
            which: rows of the worlds.
        """
        self.batches.step(commands, which)
        self.batches.robots(self.rows)

    def step(self, actions: Array, which: Indices) -> StepResult:
        """Advance some worlds of one robot each; the rewards of others are 0.

        Args:
            actions: (W, N) from -1 to 1.
            which: rows of the worlds.

        Raises:
            InputError: an action has a number that is infinite or not a number.
        """
        if not np.isfinite(actions[which]).all():
            raise InputError("an action has a number that is infinite or not a number")
        (actor,), batches = self.actors, self.batches
        given = actor.commands(actions)
        self.advance(given[:, np.newaxis], which)
        here = np.zeros(len(actions), np.bool_)
        here[which] = True
        return actor.result(batches, self.rows, given, here)

    def look(self, fresh: Mask, stepped: Mask, robot: int = 0) -> Vectors:
        """Return the observations (W, N) of a robot of each world.

        Args:
            fresh: (W,) True where an episode has just begun.
            stepped: (W,) True where a step was made since the last look.
        """
        return self.actors[robot].look(self.batches, self.rows, fresh, stepped, self._seen.copy())

    def people(self) -> Array:
        """Return x, y, vx, vy, radius (W, M, 5) of all people; NaN for those who are absent."""
        out = np.zeros((len(self._courses), int(self._people.max(initial=0)), 5))
        self.batches.people(out)
        return out

    def world(self, w: int) -> BatchWorld:
        """Return a world as it is now."""
        return self.batches.world(w)

    @property
    def time(self) -> Array:
        """Return (W,) the time since each episode began, s."""
        return np.asarray(self.batches.now * TICK, np.float64)

    def close(self) -> None:
        """End the threads."""
        self.batches.close()
