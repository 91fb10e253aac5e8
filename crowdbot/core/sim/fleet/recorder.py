"""Close a chunk of a fleet's recording each simulated second, as for one robot."""

from __future__ import annotations

from collections.abc import Sequence

from pydrake.systems.framework import Context, DiagramBuilder

from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.sim.recorder import Recorder
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES


class FleetRecorder(Recorder):
    """No ports. Data of all robots is written before the shared chunk ends."""

    __slots__ = NO_ATTRIBUTES

    def __init__(self, robots: Sequence[RecordingWriter], shared: RecordingWriter) -> None:
        super().__init__(shared)
        self._robots = tuple(robots)

    def _publish(self, context: Context) -> None:
        for writer in self._robots:
            writer.flush()
        super()._publish(context)


def add_fleet_recorder(
    builder: DiagramBuilder, robots: Sequence[RecordingWriter], shared: RecordingWriter
) -> None:
    """Add the recorder to a diagram; it needs no connections."""
    builder.AddNamedSystem("recorder", FleetRecorder(robots, shared))
