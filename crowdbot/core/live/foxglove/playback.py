"""Play back a finished run in Foxglove, with pause and seek from the viewer.

Planners' drawings are recorded in the robot's frame, in a message type of crowdbot; they are
transformed to the world and shown as markers, on the topics of a live run.
"""

from __future__ import annotations

import heapq
import threading
import time
from bisect import bisect_left
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

from mcap.reader import SeekingReader

from crowdbot.core.live.admission import Admission
from crowdbot.core.live.foxglove.drawn import drawn_messages, latest_drawn
from crowdbot.core.live.foxglove.gate import FoxgloveGate
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.recording.people import MARKER
from crowdbot.core.recording.reading.contents import contents
from crowdbot.errors import InputError

#: Time to look back for the latest message of each topic, s; topics with fewer messages are kept
#: completely.
_BACK, _FEW = 2.0, 64
_SLOWEST, _FASTEST = 0.01, 100.0


class FoxglovePlayback:
    """Serves one recording; Foxglove's own controls set position and speed."""

    def __init__(
        self, path: Path, host: str, port: int, admission: Admission | None = None
    ) -> None:
        """Index the file and start listening.

        Raises:
            InputError: no complete recording, or the address is not available.
        """
        import foxglove
        from foxglove.websocket import Capability

        found = contents(path)
        if not found.finished:
            raise InputError(f"{path}: cut off; crowdbot recover makes a whole one of it")
        self._path, self._end = path, round(found.end * 1e9)
        few = {t.name for t in found.topics if t.count < _FEW}
        self._context = foxglove.Context()
        self._channels: dict[str, Any] = {}
        self._markers: dict[str, Any] = {}  # topic -> channel of what planners drew
        self._rare: list[Record] = []
        self._prepare(few)
        self._drawn = drawn_messages(path)
        for one in self._drawn:
            self._offer_markers(one.topic)
        self._changed = threading.Condition()
        self._now, self._speed, self._playing, self._stopped = 0, 1.0, False, False
        self._sought = True
        start = lambda address: foxglove.start_server(  # noqa: E731
            name=f"crowdbot: {path}",
            host=address,
            port=0,
            capabilities=[Capability.PlaybackControl, Capability.Time],
            playback_time_range=(0, self._end),
            server_listener=cast(Any, self),
            context=self._context,
        )
        self._gate = FoxgloveGate(host, port, start, admission or Admission(server="foxglove"))
        self._server = self._gate.server
        self._thread = threading.Thread(target=self._run, name="playback", daemon=True)
        self._thread.start()

    @property
    def port(self) -> int:
        """Return the port in use."""
        return self._gate.port

    def close(self) -> None:
        """Close all connections."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._thread.join()
        self._gate.close()

    def _prepare(self, few: set[str]) -> None:
        """Create the file's channels, and load all messages of topics that have few."""
        from foxglove import Channel, Schema

        records = Records(self._path)
        for record in records:
            if record.topic not in self._channels and record.encoding == "cdr":
                schema = records.channel(record.topic).schema
                if schema is None:
                    continue
                described = Schema(name=schema.name, encoding=schema.encoding, data=schema.data)
                self._channels[record.topic] = Channel(
                    record.topic, message_encoding="cdr", schema=described, context=self._context
                )
            if record.topic in few and record.topic in self._channels:
                self._rare.append(record)

    def _offer_markers(self, topic: str) -> None:
        """Create the channel of a robot's drawings."""
        from foxglove import Channel, Schema

        if topic not in self._markers:
            schema = Schema(name=MARKER, encoding="ros2msg", data=ros.definition(MARKER))
            self._markers[topic] = Channel(
                topic, message_encoding="cdr", schema=schema, context=self._context
            )

    # ------------------------------------------------------------------ the server's threads
    def on_subscribe(self, client: Any, channel: Any) -> None:
        """Send the current state to a new subscriber."""
        del client, channel
        with self._changed:
            self._sought = True
            self._changed.notify_all()

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        """Do nothing."""

    def on_playback_control_request(self, request: Any) -> Any:
        """Play, pause, seek, or change the speed."""
        from foxglove.websocket import PlaybackCommand

        with self._changed:
            self._playing = request.playback_command == PlaybackCommand.Play
            if request.playback_speed > 0.0:
                self._speed = min(max(request.playback_speed, _SLOWEST), _FASTEST)
            sought = request.seek_time is not None
            if sought:
                self._now = min(max(int(request.seek_time), 0), self._end)
                self._sought = True
            elif self._playing and self._now >= self._end:  # from the start again
                self._now, self._sought = 0, True
            self._changed.notify_all()
            return self._state(sought, request.request_id)

    def _state(self, sought: bool, request: str | None) -> Any:
        from foxglove.websocket import PlaybackState, PlaybackStatus

        ended = self._now >= self._end
        idle = PlaybackStatus.Ended if ended else PlaybackStatus.Paused
        status = PlaybackStatus.Playing if self._playing else idle
        return PlaybackState(status, self._now, self._speed, sought, request)

    # -------------------------------------------------------------------------- the thread
    def _run(self) -> None:
        while not self._stopped:
            with self._changed:
                self._changed.wait_for(lambda: self._stopped or self._sought or self._playing)
                sought, self._sought, begin = self._sought, False, self._now
            if sought:
                self._show(begin)
            elif self._playing:
                self._play(begin)

    def _show(self, ns: int) -> None:
        """Send the latest message of each topic at a time."""
        latest = {r.topic: (r.ns, r.data) for r in self._rare if r.ns <= ns}
        for topic, at, data in self._messages(ns - round(_BACK * 1e9), ns + 1):
            latest[topic] = (at, data)
        for topic, (at, data) in latest.items():
            self._channels[topic].log(data, log_time=at)
        for one in latest_drawn(self._drawn, ns):
            self._markers[one.topic].log(one.data, log_time=one.ns)
        self._server.broadcast_time(ns)

    def _play(self, begin: int) -> None:
        """Play until there is a request, or the end."""
        started, speed = time.monotonic(), self._speed
        for topic, ns, data in self._all_messages(begin + 1, self._end + 1):
            if not self._wait(started + (ns - begin) / 1e9 / speed, speed):
                return
            (self._channels.get(topic) or self._markers[topic]).log(data, log_time=ns)
            if ns > self._now:
                self._now = ns
                self._server.broadcast_time(ns)
        with self._changed:
            if not self._sought:
                self._now, self._playing = self._end, False
                self._server.broadcast_playback_state(self._state(False, None))

    def _wait(self, until: float, speed: float) -> bool:
        """Wait until a time; return False if there is a request."""
        with self._changed:
            while True:
                if self._stopped or self._sought or not self._playing or self._speed != speed:
                    return False
                left = until - time.monotonic()
                if left <= 0.0:
                    return True
                self._changed.wait(min(left, 1.0))

    def _all_messages(self, begin: int, end: int) -> Iterator[tuple[str, int, bytes]]:
        """Yield topic, time (ns) and bytes of messages and of what planners drew, in order."""
        first = bisect_left(self._drawn, begin, key=lambda one: one.ns)
        last = bisect_left(self._drawn, end, key=lambda one: one.ns)
        drawn = ((one.topic, one.ns, one.data) for one in self._drawn[first:last])
        return heapq.merge(self._messages(begin, end), drawn, key=lambda one: one[1])

    def _messages(self, begin: int, end: int) -> Iterator[tuple[str, int, bytes]]:
        """Yield topic, time (ns) and bytes between two times, in order."""
        with self._path.open("rb") as file:
            reader = SeekingReader(file)
            for _, channel, message in reader.iter_messages(
                topics=list(self._channels), starting_at=max(begin, 0), ending_before=end
            ):
                yield channel.topic, message.log_time, message.data
