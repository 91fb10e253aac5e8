"""Frames on their way to one client; one that does not read loses the oldest of them."""

from __future__ import annotations

import asyncio
from collections import Counter, deque

from crowdbot.core.live.rosbridge.frames import Frame

#: So much may wait for a client, bytes or characters.
MOST = 8 * 2**20


class Outbox:
    """A queue with a limit for all frames, and for those of a topic that wants one."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._frames = deque[tuple[str, Frame]]()
        self._count = Counter[str]()
        self._size = 0
        self._filled = asyncio.Event()
        self.lost = 0

    def put(self, frame: Frame, topic: str = "", queue: int = 0) -> None:
        """Add a frame; of a topic with a ``queue`` (> 0) no more than that many wait."""
        self._frames.append((topic, frame))
        self._count[topic] += 1
        self._size += len(frame)
        if queue > 0 and self._count[topic] > queue:
            self._drop_oldest(topic)
        while self._size > self._most and len(self._frames) > 1:
            self._drop(0)
        self._filled.set()

    def _drop_oldest(self, topic: str) -> None:
        for k, (name, _) in enumerate(self._frames):
            if name == topic:
                self._drop(k)
                return

    def _drop(self, k: int) -> None:
        topic, frame = self._frames[k]
        del self._frames[k]
        self._gone(topic, frame)
        self.lost += 1

    def _gone(self, topic: str, frame: Frame) -> None:
        self._count[topic] -= 1
        if not self._count[topic]:
            del self._count[topic]
        self._size -= len(frame)

    def __len__(self) -> int:
        return len(self._frames)

    async def get(self) -> Frame:
        """The oldest frame; waits for one."""
        while not self._frames:
            self._filled.clear()
            await self._filled.wait()
        topic, frame = self._frames.popleft()
        self._gone(topic, frame)
        return frame
