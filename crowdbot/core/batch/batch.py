"""Worlds of any scenarios that step together, in one compiled call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from crowdbot.core.batch import step as k
from crowdbot.core.batch.array_tables import ENTRY
from crowdbot.core.batch.crowd_tables import CROWD_FIELDS, GROUP_FIELDS
from crowdbot.core.batch.gather import gather_people, gather_ranges, gather_robots
from crowdbot.core.batch.robot_tables import DRIVE_STATE, ROBOT_FIELDS
from crowdbot.core.batch.scanner_tables import SCANNER_FIELDS
from crowdbot.core.batch.world import BatchWorld
from crowdbot.core.support.records import columns_of
from crowdbot.core.types.arrays import Array, Indices
from crowdbot.errors import PluginError

_DRIVE = {name: column for column, name in enumerate(DRIVE_STATE.names)}
_SLEWED = [_DRIVE[name] for name in ("v", "w", "vy")]
_MOST_KEY = 2**62


class Drives(NamedTuple):
    """Drive states of the robots of many worlds; several threads share the same arrays.

    Attributes:
        table: (W, `crowdbot.core.batch.step.WORLD_COLUMNS`) of the worlds.
        drives: (W, R, D) `crowdbot.core.batch.robot_tables.DriveStateRecord` of all robots.
        least, most: (W, R, 3) limits of commands v, w, vy, m/s and rad/s.
    """

    table: Indices
    drives: Array
    least: Array
    most: Array

    def part(self, first: int, end: int) -> Drives:
        """Return the drive states of some worlds, sharing memory."""
        own = slice(first, end)
        return Drives(self.table[own], self.drives[own], self.least[own], self.most[own])


def drives_of(worlds: Sequence[BatchWorld]) -> Drives:
    """Return arrays large enough for the robots of given worlds."""
    count, robots = len(worlds), max(len(w.robots) for w in worlds)
    return Drives(
        np.zeros((count, k.WORLD_COLUMNS), np.int64),
        np.zeros((count, robots, columns_of(DRIVE_STATE))),
        *np.zeros((2, count, robots, 3)),
    )


class Batch:
    """Worlds that are stepped together. Not thread-safe: each thread has its own batch.

    Args:
        worlds: the initial worlds; `put` replaces any.
        keys: (W,) keys of the random numbers of their noise.
        shared: drive states in memory that is shared with other batches; None: its own.

    Attributes:
        worlds: as they are now.
        drives, least, most: as in `Drives`.
        seen: (W, M, 5) people after each step, as `people` writes them; with M = 0, none are kept.
    """

    def __init__(
        self, worlds: Sequence[BatchWorld], keys: Sequence[int], shared: Drives | None = None
    ) -> None:
        self.worlds = list(worlds)
        self._most = max(len(w.groups) for w in worlds), max(len(w.scanners) for w in worlds)
        self._table, self.drives, self.least, self.most = shared or drives_of(worlds)
        count, robots = self.drives.shape[:2]
        self.seen = np.zeros((count, 0, 5))
        self._all, self._slow = np.arange(count), np.zeros(count, np.bool_)
        self._reads = np.zeros(count, np.bool_)
        self._crowds = np.zeros((count, len(CROWD_FIELDS), ENTRY), np.int64)
        self._robots = np.zeros((count, robots, len(ROBOT_FIELDS), ENTRY), np.int64)
        self._sound = np.ones(count, np.bool_)
        self._lay_out()
        for w, key in enumerate(keys):
            self._show(w, key)
        self._read(self._all)

    def put(self, w: int, world: BatchWorld, key: int) -> None:
        """Replace a world; the new one is in its initial state, and its lidars have been read."""
        world.reset()
        self.worlds[w] = world
        if len(world.groups) > self._most[0] or len(world.scanners) > self._most[1]:
            self._most = (
                max(self._most[0], len(world.groups)), max(self._most[1], len(world.scanners)),
            )  # fmt: skip
            kept = self._table.copy()
            self._lay_out()
            for other in range(len(self.worlds)):
                self._show_tables(other)
                self._table[other, [k.NOISE_KEY, k.NOW]] = kept[other, [k.NOISE_KEY, k.NOW]]
        self._show(w, key)
        self._read(np.array([w]))

    def step(self, commands: Array, which: Indices | None = None) -> None:
        """Advance worlds by one step each, which is one period of their planner.

        Args:
            commands: (W, R, 3) v, w, vy of each robot, m/s and rad/s; clamped to its limits.
            which: rows of the worlds; None: all.

        Raises:
            PluginError: a cost function of a crowd returned NaN.
        """
        chosen = self._all if which is None else which
        slow = self._slow[chosen]
        fast = chosen[~slow] if slow.any() else chosen
        k.step_worlds(
            np.ascontiguousarray(commands, np.float64), self.least, self.most,
            fast, self._table, self._crowds, self._groups, self._robots, self._scanners,
            self.drives, self._sound, self.seen,
        )  # fmt: skip
        for w in chosen[slow].tolist():
            self._step_slowly(w)
        for w in fast[self._reads[fast]].tolist() if self._reads.any() else ():
            self.worlds[w].read(int(self._table[w, k.NOW]))
        if not self._sound.all():
            self._refuse(int(np.flatnonzero(~self._sound)[0]))

    def robots(self, out: Array) -> None:
        """Write the rows (W, R, 8) of all robots, as in `RobotRecord`."""
        gather_robots(self._crowds, out)

    def people(self, out: Array, which: Indices | None = None) -> None:
        """Write x, y, vx, vy and radius (W, M, 5) of all people, NaN for those who are absent.

        Args:
            which: rows of the worlds; None: all.
        """
        gather_people(self._all if which is None else which, self._table, self._crowds, out)

    def ranges(self, sensor: int, out: Array) -> None:
        """Write the latest ranges (W, L, B) of one sensor of each world, m."""
        gather_ranges(self._table, self._scanners, sensor, out)

    @property
    def now(self) -> Indices:
        """Return (W,) ticks of 1/128 s since each world began."""
        return self._table[:, k.NOW]

    @property
    def commands(self) -> Array:
        """Return (W, R, 3) the commands v, w, vy of all robots after slew limits."""
        return self.drives[:, :, _SLEWED]

    def drive(self, name: str) -> Array:
        """Return one field (W, R) of `DriveStateRecord`."""
        return self.drives[:, :, _DRIVE[name]]

    def _step_slowly(self, w: int) -> None:
        world = self.worlds[w]
        for _ in range(int(self._table[w, k.PERIOD])):
            world.advance_people()
            k.step_robots(w, self._table, self._crowds, self._robots, self._scanners, self.drives)
            world.read(int(self._table[w, k.NOW]))
        k.meet_people(w, self._table, self._crowds, self.drives)
        self.people(self.seen, np.array([w]))

    def _read(self, which: Indices) -> None:
        k.read_scanners(which, self._table, self._crowds, self._scanners)
        for w in which[self._reads[which]].tolist():
            self.worlds[w].read(int(self._table[w, k.NOW]))

    def _lay_out(self) -> None:
        """Make room for the largest number of groups and scanners of a world."""
        count, (groups, scanners) = len(self.worlds), self._most
        self._groups = np.zeros((count * groups, len(GROUP_FIELDS), ENTRY), np.int64)
        self._scanners = np.zeros((count * scanners, len(SCANNER_FIELDS), ENTRY), np.int64)

    def _show(self, w: int, key: int) -> None:
        """Initialise row ``w`` of all arrays for its world: tables, time, robots at rest."""
        self._show_tables(w)
        self._table[w, k.NOISE_KEY], self._table[w, k.NOW] = key % _MOST_KEY, 0
        self.worlds[w].begin_noise(key % _MOST_KEY)
        self._sound[w] = True
        self.drives[w] = 0.0
        self.drives[w, :, _DRIVE["gap"]] = np.inf
        self.drives[w, :, [_DRIVE["clear"], _DRIVE["arrived"]]] = -1.0

    def _show_tables(self, w: int) -> None:
        world, (groups, scanners) = self.worlds[w], self._most
        row, self._slow[w] = self._table[w], not (world.compiled and world.steady)
        self._reads[w] = world.reads
        row[k.FIRST_GROUP], row[k.GROUPS] = w * groups, len(world.groups)
        row[k.FIRST_SCANNER], row[k.SCANNERS] = w * scanners, len(world.scanners)
        row[k.PEOPLE], row[k.PERIOD] = world.people, world.blueprint.period
        self._crowds[w] = world.crowd.entries
        for place, table in enumerate(world.groups):
            self._groups[w * groups + place] = table.entries
        for place, table in enumerate(world.scanners):
            self._scanners[w * scanners + place] = table.entries
        for r, (table, model) in enumerate(zip(world.tables, world.blueprint.models, strict=True)):
            self._robots[w, r] = table.entries
            limits = model.limits
            self.least[w, r] = limits.v_min, -limits.w_max, -limits.vy_max
            self.most[w, r] = limits.v_max, limits.w_max, limits.vy_max

    def _refuse(self, w: int) -> None:
        raise PluginError(
            f"a cost function of the crowd of {self.worlds[w].blueprint.scenario.id} returned NaN; "
            "crowdbot run finds which one"
        )
