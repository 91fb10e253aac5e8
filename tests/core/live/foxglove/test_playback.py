"""A finished run in Foxglove: played, paused, searched; the other side speaks by hand."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from websockets.sync.client import ClientConnection, connect

from crowdbot.core.live.foxglove.drawn import drawn_messages, latest_drawn
from crowdbot.core.live.foxglove.playback import FoxglovePlayback
from crowdbot.core.planning.drawn import Drawn
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.errors import InputError
from tests.core.live.live_cases import AT_MOST
from tests.core.recording.recording_cases import header_of, random_run, write_run, write_samples

RUN = random_run()


@contextmanager
def _both(path: Path, *topics: str) -> Iterator[tuple[ClientConnection, dict[str, int]]]:
    player = FoxglovePlayback(path, "127.0.0.1", 0)
    speaks: Any = ["foxglove.sdk.v1"]
    uri = f"ws://127.0.0.1:{player.port}"
    try:
        with connect(uri, subprotocols=speaks, compression=None, close_timeout=0.5) as socket:
            found: dict[str, int] = {}
            while not {"/clock", "/map", "/tf", *topics} <= set(found):
                message = json.loads(_text(socket))
                if message["op"] == "serverInfo":
                    assert "playbackControl" in message["capabilities"]
                    assert message["dataStartTime"] == {"sec": 0, "nsec": 0}
                elif message["op"] == "advertise":
                    found |= {c["topic"]: c["id"] for c in message["channels"]}
            yield socket, found
    finally:
        player.close()


def _text(socket: ClientConnection) -> str:
    while True:
        frame = socket.recv(timeout=AT_MOST)
        if isinstance(frame, str):
            return frame


def _subscribe(socket: ClientConnection, *channels: int) -> None:
    wish = [{"id": 10 + k, "channelId": c} for k, c in enumerate(channels)]
    socket.send(json.dumps({"op": "subscribe", "subscriptions": wish}))


def _ask(
    socket: ClientConnection, *, play: bool, speed: float = 1.0, seek: int | None = None
) -> None:
    name = b"wish"
    has, at = (0, 0) if seek is None else (1, seek)
    body = struct.pack("<BBfBQI", 3, 0 if play else 1, speed, has, at, len(name)) + name
    socket.send(body)


def _clock(socket: ClientConnection, number: int) -> int:
    """Time of the next message of a subscription, ns."""
    while True:
        frame = socket.recv(timeout=AT_MOST)
        if isinstance(frame, bytes) and frame[0] == 1:
            subscription, ns = struct.unpack_from("<IQ", frame, 1)
            if subscription == number:
                message = ros.from_cdr(frame[13:], "rosgraph_msgs/msg/Clock")
                assert max(ns, 1) == message.clock.sec * 10**9 + message.clock.nanosec
                return int(ns)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("play") / "run.mcap"
    write_run(path, RUN)
    return path


def test_it_is_played_and_searched(path: Path) -> None:
    with _both(path) as (socket, channels):
        _subscribe(socket, channels["/clock"], channels["/map"])
        assert _clock(socket, 10) == 0
        _ask(socket, play=False, seek=1_500_000_000)
        while (now := _clock(socket, 10)) == 0:
            pass
        assert 1_400_000_000 <= now <= 1_500_000_000
        _ask(socket, play=True, speed=4.0)
        times = [_clock(socket, 10) for _ in range(5)]
        assert times == sorted(times)
        assert times[-1] > 1_500_000_000


def test_what_was_cut_off_is_refused(path: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(path.read_bytes()[:-30])
    with pytest.raises(InputError, match="recover"):
        FoxglovePlayback(cut, "127.0.0.1", 0)


_LINES, _TEXT = 5, 9


def _drawn(tmp_path: Path) -> Path:
    """A run whose planner drew a path at 1 s, and a text at 2 s."""
    path = tmp_path / "drawn.mcap"
    writer = RecordingWriter(path, header_of(RUN), record="all")
    write_samples(writer, RUN)
    writer.drawing(1.0, Drawn("path", np.array([[0.0, 0.0], [1.0, 0.0]], np.float32)))
    writer.drawing(2.0, Drawn("why", np.array([[1.0, 0.0]], np.float32), ("waits",)))
    writer.close(2.25, True, "arrived")
    return path


def _marker(socket: ClientConnection) -> tuple[int, Any]:
    """Time, ns, and content of the next marker."""
    while True:
        frame = socket.recv(timeout=AT_MOST)
        if isinstance(frame, bytes) and frame[0] == 1:
            subscription, ns = struct.unpack_from("<IQ", frame, 1)
            if subscription == 10:
                return int(ns), ros.from_cdr(frame[13:], "visualization_msgs/msg/Marker")


def test_what_the_planner_drew_is_shown_in_the_world(tmp_path: Path) -> None:
    with _both(_drawn(tmp_path), "/thoughts_marker") as (socket, channels):
        _subscribe(socket, channels["/thoughts_marker"])
        _ask(socket, play=True, speed=4.0)
        (at, line), (later, text) = _marker(socket), _marker(socket)
        assert (at, later) == (10**9, 2 * 10**9)
        assert (line.type, text.type, text.text) == (_LINES, _TEXT, "waits")
        assert RUN.robot is not None
        k = int(np.argmin(np.abs(RUN.t - 1.0)))
        x, y, yaw = (float(v) for v in RUN.robot[k][:3])
        start, end = line.points
        assert (start.x, start.y) == (pytest.approx(x), pytest.approx(y))
        assert end.x - start.x == pytest.approx(np.cos(yaw), abs=1e-6)
        assert end.y - start.y == pytest.approx(np.sin(yaw), abs=1e-6)
        _ask(socket, play=False, seek=1_250_000_000)
        assert _marker(socket)[0] == 10**9


def test_old_drawings_are_not_shown_after_a_jump(tmp_path: Path) -> None:
    drawn = drawn_messages(_drawn(tmp_path))
    shown = {t: [one.name for one in latest_drawn(drawn, round(t * 1e9))] for t in (0.9, 1.4, 1.6)}
    assert shown == {0.9: [], 1.4: ["path"], 1.6: []}
