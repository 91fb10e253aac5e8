"""WatchedRun: shows watchers one sample of all robots and people at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from crowdbot.core.planning.drawn import Drawn
from crowdbot.core.planning.planner import TRACKS
from crowdbot.core.recording.drawings import drawing_in_world
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.watcher import Watcher
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.types.arrays import Array

#: Takes a sample: time (s), the robot's row and the people, either missing.
OnSample = Callable[[float, Sequence[float] | None, Array | None], None]
#: Takes what a planner draws, and the time, s.
OnDrawing = Callable[[float, Drawn], None]


class WatchedRun:
    """Collects the samples of one tick from all logs; that of the people comes last."""

    def __init__(
        self,
        watchers: Sequence[Watcher],
        shared: RecordingHeader,
        robots: Mapping[str, RecordingHeader],
        endings: Mapping[str, RobotEnding],
    ) -> None:
        """Notify the watchers that a run begins; see `Watcher.begin`."""
        self._watchers, self._endings = tuple(watchers), endings
        self._rows: dict[str, Sequence[float]] = {}
        for watcher in self._watchers:
            watcher.begin(shared, robots)

    def watch(self, robot: str, *, people: bool) -> OnSample | None:
        """Return the callback for the log of a robot, people or both; None without watchers."""
        if not self._watchers:
            return None

        def on_sample(t: float, row: Sequence[float] | None, agents: Array | None) -> None:
            if row is not None:
                self._rows[robot] = row
            if people:
                self._show(t, agents)

        return on_sample

    def drawings_of(self, robot: str) -> OnDrawing | None:
        """Return the callback for what a robot's planner draws; None without watchers."""
        if not self._watchers:
            return None

        def on_drawing(t: float, drawn: Drawn) -> None:
            if (row := self._rows.get(robot)) is None:
                return
            name, tracks = drawn.name, drawn.name == TRACKS
            columns = drawing_in_world(row[0], row[1], row[2], drawn.rows, tracks=tracks)
            more = () if drawn.texts is None else (drawn.texts,)
            for watcher in self._watchers:
                watcher.drawing(t, robot, name, columns, *more)

        return on_drawing

    def _show(self, t: float, agents: Array | None) -> None:
        there = {name: row for name, row in self._rows.items() if not self._endings[name].gone}
        for watcher in self._watchers:
            watcher.sample(t, there, agents)
