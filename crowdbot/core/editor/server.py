"""The server of the editor: this machine alone, with a token, Host and Origin checked."""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

from crowdbot.core.editor.desk import ConflictError, Desk
from crowdbot.core.editor.document import Edit
from crowdbot.core.editor.page import page
from crowdbot.core.live.admission import PAGE_HEADERS, Admission
from crowdbot.errors import CrowdbotError, printable

#: Largest request, bytes.
_LARGEST = 4_000_000
#: Header that pages of other websites cannot send.
TOKEN = "X-Crowdbot-Token"  # noqa: S105 - its name


class Server:
    """HTTP server of one desk on a loopback address.

    Args:
        desk: the file that is edited.
        port: 0 for a free one.

    Raises:
        OSError: the port is taken.
    """

    def __init__(self, desk: Desk, port: int = 0) -> None:
        self.token = secrets.token_urlsafe(24)
        handler = type("_Bound", (_Handler,), {
            "desk": desk, "token": self.token, "admission": Admission(server="edit"),
        })  # fmt: skip
        self._http = ThreadingHTTPServer(("127.0.0.1", port), handler)
        self._http.daemon_threads = True
        self.port = self._http.server_address[1]

    @property
    def url(self) -> str:
        """Return the address of the page, with the token."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    def run(self) -> None:
        """Serve until `close`, or Ctrl-C."""
        self._http.serve_forever(poll_interval=0.2)

    def close(self) -> None:
        """Stop serving."""
        self._http.shutdown()
        self._http.server_close()


class _Handler(BaseHTTPRequestHandler):
    desk: Desk
    token: str
    admission: Admission
    protocol_version = "HTTP/1.1"
    timeout = 60

    def do_GET(self) -> None:
        """Return the page."""
        parts = urlsplit(self.path)
        given = parse_qs(parts.query).get("token", [""])[0]
        if self._refused(given):
            return
        if parts.path != "/":
            self._send(HTTPStatus.NOT_FOUND, {"error": "no such page"})
            return
        body = page(self.desk.file.name, self.token).encode()
        self._answer(HTTPStatus.OK, body, "text/html; charset=utf-8")

    def do_POST(self) -> None:
        """Answer a request of the page."""
        if self._refused(self.headers.get(TOKEN, "")):
            return
        act = _ACTS.get(urlsplit(self.path).path)
        if act is None:
            self._send(HTTPStatus.NOT_FOUND, {"error": "no such request"})
            return
        try:
            self._send(HTTPStatus.OK, act(self.desk, self._body()))
        except ConflictError as error:
            self._send(HTTPStatus.CONFLICT, {"error": str(error)})
        except (CrowdbotError, ValueError, KeyError, TypeError) as error:
            self._send(HTTPStatus.BAD_REQUEST, {"error": printable(str(error))})

    def _refused(self, given: str) -> bool:
        headers = {name.lower(): self.headers.get_all(name) or [] for name in self.headers}
        problem = self.admission.problem(headers)
        if not problem and not secrets.compare_digest(given.encode(), self.token.encode()):
            problem = "without the token of the address that crowdbot edit printed"
        if problem:
            self._send(HTTPStatus.FORBIDDEN, {"error": problem})
        return bool(problem)

    def _body(self) -> Mapping[str, Any]:
        size = int(self.headers.get("Content-Length") or 0)
        if not 0 <= size <= _LARGEST:
            self.close_connection = True
            raise ValueError(f"a request is at most {_LARGEST} bytes")
        found = json.loads(self.rfile.read(size) or b"{}")
        if not isinstance(found, dict) or not isinstance(found.get("text", ""), str):
            raise TypeError("a request is a map with a text")
        return found

    def _send(self, status: HTTPStatus, content: Mapping[str, Any]) -> None:
        body = json.dumps(content, allow_nan=False, default=str).encode()
        self._answer(status, body, "application/json")

    def _answer(self, status: HTTPStatus, body: bytes, kind: str) -> None:
        if status == HTTPStatus.FORBIDDEN:
            self.close_connection = True
        self.send_response(status)
        own = {"Content-Type": kind, "Content-Length": str(len(body))}
        for name, value in {**PAGE_HEADERS, **own}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Print nothing: requests are those of the user's own page."""


def _change(desk: Desk, given: Mapping[str, Any]) -> dict[str, Any]:
    changes = [Edit(list(one["path"]), one.get("value")) for one in given["changes"]]
    return desk.change(given["text"], changes)


def _save(desk: Desk, given: Mapping[str, Any]) -> dict[str, Any]:
    return desk.save(given["text"], str(given["hash"]), anyway=given.get("anyway") is True)


_ACTS: Mapping[str, Callable[[Desk, Mapping[str, Any]], dict[str, Any]]] = {
    "/open": lambda desk, given: desk.opened(),  # noqa: ARG005
    "/check": lambda desk, given: desk.check(given["text"]),
    "/change": _change,
    "/play": lambda desk, given: desk.play(given["text"]),
    "/save": _save,
}
