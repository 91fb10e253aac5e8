"""Recorder: closes a chunk of the recording each simulated second.

The blocks pass their rows to the writer themselves, at the tick to which they belong.
"""

from __future__ import annotations

from pydrake.systems.framework import Context, DiagramBuilder, LeafSystem

from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES

_PERIOD = 1.0  # s


class Recorder(LeafSystem):
    """No ports. Chunks end by simulated time, so that equal runs give equal files."""

    __slots__ = NO_ATTRIBUTES

    def __init__(self, writer: RecordingWriter) -> None:
        super().__init__()
        self._writer = writer
        self.DeclarePeriodicPublishEvent(_PERIOD, 0.0, self._publish)

    def _publish(self, context: Context) -> None:
        del context
        self._writer.flush()


def add_recorder(builder: DiagramBuilder, writer: RecordingWriter) -> None:
    """Add the recorder to a diagram; it needs no connections."""
    builder.AddNamedSystem("recorder", Recorder(writer))
