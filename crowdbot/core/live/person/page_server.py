"""The server of the person's page: one page and its websocket, on this machine only."""

from __future__ import annotations

import asyncio
import json
import logging
import secrets
import time
from contextlib import suppress
from http import HTTPStatus
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from crowdbot.core.live.admission import PAGE_HEADERS, is_loopback
from crowdbot.core.live.person.page_client import PageClient
from crowdbot.core.live.person.seat import Seat
from crowdbot.core.support.loop_thread import LoopThread
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from websockets.asyncio.server import Server, ServerConnection
    from websockets.http11 import Request, Response

HOST = "127.0.0.1"
_LARGEST, _WAITING, _MOST_CLIENTS = 16_384, 32, 16
_STATE = 0.1  # s between two looks at what the pages have to know
_FAREWELL = 2.0  # s


class PageServer:
    """Serves pages, one of which drives while the others watch.

    Attributes:
        token: secret that a page must send; part of its address.
        port: the port in use.
    """

    def __init__(self, seat: Seat, page: str, port: int = 0, name: str = "teleop") -> None:
        """Start listening.

        Args:
            page: the whole page, HTML.
            port: 0: any free port.
            name: of the command, for messages.

        Raises:
            InputError: the port is not available.
        """
        self._seat, self._page = seat, page.encode()
        self.token = secrets.token_urlsafe(24)
        self._clients = set[PageClient]()
        self._scene, self._frame, self._end, self._state = "", "", "", ""
        seat.on_taken = lambda number, t: self.tell("taken", n=number, t=t, at=1e3 * time.time())
        self._loop = LoopThread(f"{name} page")
        try:
            self._server: Server = self._loop.run(self._start(port))
        except OSError as error:
            self._loop.close()
            raise InputError(
                f"{HOST}:{port}: cannot listen there: {error.strerror or error}"
            ) from error
        self.port: int = next(iter(self._server.sockets)).getsockname()[1]
        self._watch = self._loop.begin(self._tell_states())

    @property
    def url(self) -> str:
        """Return the address for the browser."""
        return f"http://{HOST}:{self.port}/?token={self.token}"

    # ---------------------------------------------------------------- the simulation's thread
    def show_scene(self, scene: Any) -> None:
        """Send the static scene to all pages, also to those that connect later."""
        self._loop.soon(self._keep, "_scene", json.dumps({"op": "scene", "scene": scene}), "scene")
        self._loop.soon(self._forget_end)

    def show_frame(self, frame: Any) -> None:
        """Send the moving parts to all pages; a slow page gets only the latest."""
        self._loop.soon(self._keep, "_frame", json.dumps({"op": "frame", **frame}), "frame")

    def show_end(self, **fields: Any) -> None:
        """Send all pages how the run ended."""
        self._loop.soon(self._keep, "_end", json.dumps({"op": "end", **fields}), "end")

    def tell(self, op: str, **fields: Any) -> None:
        """Send all pages a message."""
        self._loop.soon(self._send_all, json.dumps({"op": op, **fields}))

    def close(self) -> None:
        """Send the queued messages, then close all connections."""
        if self._loop.is_closed:
            return
        self._watch.cancel()
        with suppress(TimeoutError, RuntimeError):
            self._loop.run(self._stop())
        self._loop.close()

    # ------------------------------------------------------------------ the server's thread
    def _keep(self, name: str, text: str, topic: str) -> None:
        setattr(self, name, text)
        for client in self._clients:
            client.outbox.put(text, topic, 1)

    def _forget_end(self) -> None:
        self._end = ""

    def _send_all(self, text: str) -> None:
        for client in self._clients:
            client.outbox.put(text)

    async def _tell_states(self) -> None:
        """Keep sending all pages why the run waits, and if the seat is taken."""
        while True:
            self._tell_state()
            await asyncio.sleep(_STATE)

    def _tell_state(self) -> None:
        seat = self._seat
        now = json.dumps({"op": "state", "waits": seat.why_waiting, "taken": seat.taken})
        if now != self._state:
            self._state = now
            self._send_all(now)

    async def _start(self, port: int) -> Server:
        from websockets.asyncio.server import serve

        quiet = logging.getLogger("crowdbot.page")
        quiet.setLevel(logging.CRITICAL)
        return await serve(
            self._serve, HOST, port, process_request=self._answer, compression=None,
            max_size=_LARGEST, max_queue=_WAITING, close_timeout=2.0, logger=quiet,
            ping_interval=2.0, ping_timeout=4.0,
        )  # fmt: skip

    async def _stop(self) -> None:
        end = time.monotonic() + _FAREWELL
        while any(c.waiting for c in self._clients) and time.monotonic() < end:
            await asyncio.sleep(0.005)
        self._server.close()
        await asyncio.wait_for(self._server.wait_closed(), 10.0)

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the page; None for its websocket; a refusal for everyone else."""
        from websockets.datastructures import Headers
        from websockets.http11 import Response

        problem = self._problem(request)
        if problem is not None:
            return connection.respond(*problem)
        path = urlsplit(request.path).path
        if path == "/socket":
            return None
        if path != "/":
            return connection.respond(HTTPStatus.NOT_FOUND, "there is one page\n")
        headers = Headers(
            {
                **PAGE_HEADERS,
                "Content-Type": "text/html; charset=utf-8",
                "Content-Length": str(len(self._page)),
                "Connection": "close",
            }
        )
        return Response(200, "OK", headers, self._page)

    def _problem(self, request: Request) -> tuple[HTTPStatus, str] | None:
        """Return why a request is refused: another site, another name, or no token."""
        hosts, origins = (request.headers.get_all(n) for n in ("host", "origin"))
        if len(hosts) != 1 or not is_loopback(_name_of(hosts[0])):
            return HTTPStatus.FORBIDDEN, "not by that name: 'localhost' and 127.0.0.1 are served\n"
        if any(origin != f"http://{hosts[0]}" for origin in origins):
            return HTTPStatus.FORBIDDEN, "not from another page, even of this machine\n"
        sites = request.headers.get_all("sec-fetch-site")
        if any(site in ("cross-site", "same-site") for site in sites):
            return HTTPStatus.FORBIDDEN, "not from another site\n"
        given = parse_qs(urlsplit(request.path).query).get("token", [""])[0]
        if not secrets.compare_digest(given.encode(), self.token.encode()):
            return HTTPStatus.UNAUTHORIZED, "the address lacks its token: use the printed one\n"
        if len(self._clients) >= _MOST_CLIENTS:
            return HTTPStatus.SERVICE_UNAVAILABLE, "too many pages\n"
        return None

    async def _serve(self, socket: ServerConnection) -> None:
        from websockets.exceptions import ConnectionClosed

        client = PageClient(self._seat)
        self._clients.add(client)
        for text, topic in ((self._scene, "scene"), (self._frame, "frame"), (self._end, "end")):
            if text:
                client.outbox.put(text, topic, 1)
        before = self._state
        self._tell_state()
        if self._state == before:
            client.outbox.put(before)
        writer = asyncio.get_running_loop().create_task(_write(client, socket))
        try:
            async for frame in socket:
                client.take(frame)
        except ConnectionClosed:
            pass
        finally:
            writer.cancel()
            with suppress(asyncio.CancelledError, ConnectionClosed):
                await writer
            self._clients.discard(client)
            client.close()
            self._tell_state()


def _name_of(host: str) -> str:
    """Return the name in a host with its port; empty if there is none."""
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""


async def _write(client: PageClient, socket: ServerConnection) -> None:
    """Send queued messages forever."""
    while True:
        frame = await client.outbox.get()
        client.sending = True
        await socket.send(frame)
        client.sending = False
