"""A gate before Foxglove's server, which itself accepts every website.

The gate reads the first request of a connection, admits or refuses it, and passes bytes on. The
server behind it listens at a random loopback address and port (on Linux one of 16 million
addresses), which a website cannot guess.
"""

from __future__ import annotations

import asyncio
import secrets
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from crowdbot.core.live.admission import Admission
from crowdbot.core.live.foxglove.log import bound_log
from crowdbot.core.support.loop_thread import LoopThread
from crowdbot.errors import InputError

#: Largest request, bytes; time for it, s; clients at once.
_HEAD, _PATIENCE, _MOST_CLIENTS = 16 << 10, 10.0, 50
#: Bytes per second that a client may send, and those of the first moment.
_PER_SECOND, _BURST, _CHUNK = 256 << 10, 1 << 20, 64 << 10


def inner_address() -> str:
    """Return a random address of this machine."""
    if not sys.platform.startswith("linux"):
        return "127.0.0.1"
    return f"127.{secrets.randbelow(254) + 1}.{secrets.randbelow(256)}.{secrets.randbelow(254) + 1}"


class FoxgloveGate:
    """Listens for viewers, and connects those that are admitted with the server behind it."""

    def __init__(
        self, host: str, port: int, start: Callable[[str], Any], admission: Admission
    ) -> None:
        """Start the server by ``start(address)``, then listen.

        Raises:
            InputError: the address is not available.
        """
        self._admission, self._clients = admission, 0
        where = inner_address()
        bound_log()
        try:
            self.server = start(where)
        except RuntimeError as error:
            raise InputError(f"{where}: cannot listen there: {error}") from error
        self._inner = where, int(self.server.port)
        self._loop = LoopThread("foxglove gate")
        try:
            self._listener = self._loop.run(
                asyncio.start_server(self._serve, host, port, limit=_HEAD)
            )
        except OSError as error:
            self.server.stop()
            self._loop.close()
            text = error.strerror or error
            raise InputError(f"{host}:{port}: cannot listen there: {text}") from error
        self.port = int(self._listener.sockets[0].getsockname()[1])

    def close(self) -> None:
        """Close all connections."""
        self.server.stop()
        self._loop.run(self._stop())
        self._loop.close()

    async def _stop(self) -> None:
        self._listener.close()
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._clients += 1
        try:
            await self._admit(reader, writer)
        except (OSError, EOFError, TimeoutError, asyncio.CancelledError):
            pass  # the client or the server has gone
        finally:
            self._clients -= 1
            writer.close()

    async def _admit(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            head = await asyncio.wait_for(reader.readuntil(b"\r\n\r\n"), _PATIENCE)
        except asyncio.LimitOverrunError:
            return
        full = self._clients > _MOST_CLIENTS
        problem = "too many clients" if full else self._problem(head)
        if problem:
            await _refuse(writer, "503 Service Unavailable" if full else "403 Forbidden", problem)
            return
        behind = await asyncio.open_connection(*self._inner)
        try:
            behind[1].write(head)
            back = asyncio.ensure_future(_pass_on(behind[0], writer))
            there = asyncio.ensure_future(_pass_on(reader, behind[1], _PER_SECOND))
            try:
                await asyncio.wait((back, there), return_when=asyncio.FIRST_COMPLETED)
            finally:
                back.cancel()
                there.cancel()
                await asyncio.gather(back, there, return_exceptions=True)
        finally:
            behind[1].close()

    def _problem(self, head: bytes) -> str:
        found = _headers(head)
        return "not a request" if found is None else self._admission.problem(found)


async def _pass_on(
    reader: asyncio.StreamReader, writer: asyncio.StreamWriter, rate: float = 0.0
) -> None:
    """Pass bytes on until the end; with a ``rate``, at most this many per second after a burst."""
    now = asyncio.get_running_loop().time
    left, filled = float(_BURST), now()
    while data := await reader.read(_CHUNK):
        writer.write(data)
        with suppress(ConnectionError):
            await writer.drain()
        if rate:
            left = min(left + (now() - filled) * rate, _BURST) - len(data)
            filled = now()
            if left < 0.0:
                await asyncio.sleep(-left / rate)


async def _refuse(writer: asyncio.StreamWriter, status: str, problem: str) -> None:
    body = f"{problem}\n".encode()
    head = f"HTTP/1.1 {status}\r\nContent-Length: {len(body)}\r\nConnection: close\r\n\r\n"
    writer.write(head.encode() + body)
    await writer.drain()


def _headers(head: bytes) -> dict[str, list[str]] | None:
    """Return a request's headers; None for one that two readers could read differently."""
    lines = head.decode("latin-1").removesuffix("\r\n\r\n").split("\r\n")[1:]
    headers: dict[str, list[str]] = {}
    for line in lines:
        name, colon, value = line.partition(":")
        token = name.replace("-", "").replace("_", "")
        if not colon or not token.isascii() or not token.isalnum() or {"\r", "\n"} & set(line):
            return None
        headers.setdefault(name.lower(), []).append(value.strip())
    return headers
