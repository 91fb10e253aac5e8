"""Queued frames for one client; a client that does not read loses the oldest."""

from __future__ import annotations

import asyncio
from collections import deque
from dataclasses import dataclass

from crowdbot.core.live.rosbridge.frames import Frame

#: Largest queue of a client, bytes or characters.
MOST = 8 * 2**20


@dataclass(slots=True, eq=False)
class _Waiting:
    """A queued frame; None once it is sent or lost."""

    frame: Frame | None


class Outbox:
    """A queue with a limit for all frames, and optionally per topic."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._frames = deque[_Waiting]()
        self._by_topic: dict[str, deque[_Waiting]] = {}
        self._count = 0
        self._size = 0
        self._filled = asyncio.Event()
        self.lost = 0

    def put(self, frame: Frame, topic: str = "", queue: int = 0) -> None:
        """Add a frame; a topic with a ``queue`` (> 0) has at most that many waiting."""
        one = _Waiting(frame)
        self._frames.append(one)
        self._count += 1
        self._size += len(frame)
        mine = self._by_topic.setdefault(topic, deque())
        while mine and mine[0].frame is None:
            mine.popleft()
        mine.append(one)
        if queue > 0 and len(mine) > queue:
            self._lose(mine.popleft())
        while self._size > self._most and self._count > 1:
            self._lose(self._frames.popleft())
        self._filled.set()

    def _lose(self, one: _Waiting) -> None:
        if self._take(one) is not None:
            self.lost += 1

    def _take(self, one: _Waiting) -> Frame | None:
        """Return a frame and forget it; None if it was lost."""
        frame, one.frame = one.frame, None
        if frame is not None:
            self._count -= 1
            self._size -= len(frame)
        return frame

    def __len__(self) -> int:
        return self._count

    async def get(self) -> Frame:
        """Return the oldest frame; wait for one."""
        while True:
            while not self._count:
                self._frames.clear()
                self._by_topic.clear()
                self._filled.clear()
                await self._filled.wait()
            frame = self._take(self._frames.popleft())
            if frame is not None:
                return frame
