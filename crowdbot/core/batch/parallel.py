"""A batch of worlds split among threads; results are those of a single batch."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np

from crowdbot.core.batch.batch import Batch, drives_of
from crowdbot.core.batch.robot_tables import DRIVE_STATE
from crowdbot.core.batch.step import NOW
from crowdbot.core.batch.step_threads import StepThreads
from crowdbot.core.batch.world import BatchWorld
from crowdbot.core.types.arrays import Array, Indices

#: People who are stepped while another thread wakes up, which takes about 0.1 ms.
_HEAD_START = 100


def parts_of(worlds: int, threads: int, people: int) -> list[tuple[int, int]]:
    """Return the first world and the end (exclusive) of each thread.

    The first thread starts at once and the others after waking up, so it gets more worlds.

    Args:
        worlds: number of worlds, at least 1.
        threads: largest number of threads.
        people: approximate number in each world.
    """
    count = max(1, min(threads, worlds))
    head = (count - 1) * _HEAD_START / (people + 1)
    first = min(round((worlds + head) / count), worlds - count + 1)
    ends: list[int] = np.linspace(first, worlds, count).astype(int).tolist()
    return list(itertools.pairwise([0, *ends]))


class Batches:
    """Batches of worlds, one for each thread; a single one runs in the calling thread.

    Args:
        worlds, keys: as in `Batch`.
        parts: which worlds each thread steps, see `parts_of`; those of a part may share scratch.
    """

    def __init__(
        self, worlds: Sequence[BatchWorld], keys: Sequence[int], parts: Sequence[tuple[int, int]]
    ) -> None:
        self._parts = list(parts)
        self._thread_of = np.repeat(np.arange(len(parts)), np.diff(parts)[:, 0]).tolist()
        self._shared = drives_of(worlds)
        self._batches: list[Batch] = [
            Batch(worlds[a:b], keys[a:b], self._shared.part(a, b)) for a, b in self._parts
        ]
        self._threads = StepThreads(len(self._batches) - 1)

    def thread_of(self, w: int) -> int:
        """Return the index of the thread that steps a world."""
        return int(self._thread_of[w])

    def put(self, w: int, world: BatchWorld, key: int) -> None:
        """Replace a world, see `Batch.put`."""
        number = self.thread_of(w)
        self._batches[number].put(w - self._parts[number][0], world, key)

    def world(self, w: int) -> BatchWorld:
        """Return a world in its present state."""
        number = self.thread_of(w)
        return self._batches[number].worlds[w - self._parts[number][0]]

    def step(self, commands: Array, which: Indices) -> None:
        """Advance some worlds by one step each, see `Batch.step`.

        Args:
            which: rows of the worlds, ascending.
        """

        def one(number: int) -> None:
            first, end = self._parts[number]
            own = None
            if len(which) < len(commands):
                own = which[(which >= first) & (which < end)] - first
            if own is None or len(own):
                self._batches[number].step(commands[first:end], own)

        self._threads.share(one)

    def robots(self, out: Array) -> None:
        """Write the rows (W, R, 8) of all robots, see `Batch.robots`."""
        self._into(out, lambda batch, rows: batch.robots(rows))

    def people(self, out: Array) -> None:
        """Write all people (W, M, 5), see `Batch.people`."""
        self._into(out, lambda batch, rows: batch.people(rows))

    def show_people(self, out: Array) -> None:
        """Write all people (W, M, 5) to ``out`` now and after each later step, see `Batch.seen`."""
        for batch, (first, end) in zip(self._batches, self._parts, strict=True):
            batch.seen = out[first:end]
        self.people(out)

    def ranges(self, sensor: int, out: Array) -> None:
        """Write the ranges (W, L, B) of one sensor, see `Batch.ranges`."""
        self._into(out, lambda batch, rows: batch.ranges(sensor, rows))

    @property
    def drives(self) -> Array:
        """Return (W, R, D) `DriveStateRecord` of all robots, shared memory."""
        return self._shared.drives

    def drive(self, name: str) -> Array:
        """Return (W, R) a field of `DriveStateRecord`, a copy."""
        return self._shared.drives[:, :, DRIVE_STATE.names.index(name)].copy()

    @property
    def commands(self) -> Array:
        """Return (W, R, 3) the commands v, w, vy of all robots after slew limits, a copy."""
        return np.concatenate([batch.commands for batch in self._batches])

    @property
    def ticks(self) -> Indices:
        """Return (W,) ticks of 1/128 s since each world began, shared memory."""
        return self._shared.table[:, NOW]

    @property
    def now(self) -> Indices:
        """Return (W,) ticks of 1/128 s since each world began, a copy."""
        return self._shared.table[:, NOW].copy()

    def close(self) -> None:
        """End the threads."""
        self._threads.end()

    def _into(self, out: Array, write: Callable[[Batch, Array], None]) -> None:
        for batch, (first, end) in zip(self._batches, self._parts, strict=True):
            write(batch, out[first:end])
