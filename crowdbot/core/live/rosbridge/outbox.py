"""Queued frames for one client; a client that does not read loses the oldest."""

from __future__ import annotations

import asyncio
from collections import Counter, deque

from crowdbot.core.live.rosbridge.frames import Frame

#: Largest queue of a client, bytes or characters.
MOST = 8 * 2**20


class Outbox:
    """A queue with a limit for all frames, and optionally per topic."""

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._frames = deque[tuple[str, Frame]]()
        self._count = Counter[str]()
        self._size = 0
        self._filled = asyncio.Event()
        self.lost = 0

    def put(self, frame: Frame, topic: str = "", queue: int = 0) -> None:
        """Add a frame; a topic with a ``queue`` (> 0) has at most that many waiting."""
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
        """Return the oldest frame; wait for one."""
        while not self._frames:
            self._filled.clear()
            await self._filled.wait()
        topic, frame = self._frames.popleft()
        self._gone(topic, frame)
        return frame
