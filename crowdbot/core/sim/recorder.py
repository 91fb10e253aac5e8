"""Recorder: hands each new sensor reading to the recording."""

from __future__ import annotations

from collections.abc import Collection

from pydrake.systems.framework import Context, EventStatus, LeafSystem

from crowdbot.core.recording import RecordingWriter
from crowdbot.core.sim import ports
from crowdbot.core.sim.sensor_bank import SensorBank
from crowdbot.core.ticks import TICK, TICKS_PER_SECOND


class Recorder(LeafSystem):
    """Input: readings. Also closes a chunk of the file each simulated second."""

    def __init__(self, writer: RecordingWriter, bank: SensorBank, sensors: Collection[str]) -> None:
        super().__init__()
        self._writer = writer
        self._slots = {n: s for n, s in bank.slots.items() if n in sensors}
        self._last = dict.fromkeys(self._slots, -1.0)
        size = bank.GetOutputPort(ports.READINGS).size()
        self._port = self.DeclareVectorInputPort(ports.READINGS, size)
        self.DeclarePeriodicPublishEvent(TICK, 0.0, self._publish)

    def _publish(self, context: Context) -> EventStatus:
        bank = self._port.Eval(context)
        for name, slot in self._slots.items():
            if bank[slot.stamp] > self._last[name]:
                self._last[name] = bank[slot.stamp]
                self._writer.reading(name, slot.reading(bank))
        if round(context.get_time() * TICKS_PER_SECOND) % TICKS_PER_SECOND == 0:
            self._writer.flush()
        return EventStatus.Succeeded()
