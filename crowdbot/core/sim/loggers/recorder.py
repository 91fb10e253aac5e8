"""Recorder: closes a chunk of the recording each simulated second.

The blocks hand their rows to the writers themselves, at the tick to which they belong.
"""

from __future__ import annotations

from collections.abc import Sequence

from pydrake.systems.framework import Context, DiagramBuilder

from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES

_PERIOD = 1.0  # s


class Recorder(Block):
    """No ports. Chunks end by simulated time, so that equal runs give equal files."""

    __slots__ = NO_ATTRIBUTES

    def __init__(self, writers: Sequence[RecordingWriter]) -> None:
        """Create the recorder of one file's writers; the last writer closes the chunk of all."""
        super().__init__()
        self._writers = tuple(writers)
        self.DeclarePeriodicPublishEvent(_PERIOD, 0.0, self._publish)

    def _publish(self, context: Context) -> None:
        del context
        for writer in self._writers:
            writer.flush()


def add_recorder(builder: DiagramBuilder, writers: Sequence[RecordingWriter]) -> None:
    """Add the recorder to a diagram; it needs no connections."""
    builder.AddNamedSystem("recorder", Recorder(writers))
