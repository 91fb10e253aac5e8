"""The runner's server: on this machine only, for the page with its token only."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qsl

from crowdbot.core.live.admission import PAGE_HEADERS, Admission
from crowdbot.core.studies.runner.session import RunnerSession
from crowdbot.errors import CrowdbotError, InputError

#: Longest body of a request, bytes; largest number of its fields.
_LONGEST, _MOST_FIELDS = 65_536, 200
#: Forms say where they come from only if the page may tell its own server.
_HEADERS = {**PAGE_HEADERS, "Referrer-Policy": "same-origin"}


class RunnerServer(ThreadingHTTPServer):
    """Serves one session below a secret path.

    Args:
        session: of the participant.
        port: 0: a free one.

    Raises:
        InputError: the port cannot be opened.
    """

    daemon_threads = True

    def __init__(self, session: RunnerSession, port: int = 0) -> None:
        self.session, self.token = session, secrets.token_urlsafe(24)
        self.admission = Admission(server="study")
        try:
            super().__init__(("127.0.0.1", port), _Handler)
        except OSError as error:
            raise InputError(f"port {port}: cannot be opened: {error.strerror}") from error

    @property
    def origin(self) -> str:
        """Return the origin of the page."""
        return f"http://127.0.0.1:{self.server_address[1]}"

    @property
    def url(self) -> str:
        """Return the address of the page, with its token."""
        return f"{self.origin}/{self.token}/"


class _Handler(BaseHTTPRequestHandler):
    server: RunnerServer
    protocol_version = "HTTP/1.1"
    timeout = 30

    def do_GET(self) -> None:
        """Send the page, or the state of a drive."""
        path = self._path()
        if path is None:
            return
        if path == "":
            self._send(200, self._reply(self.server.session.page), "text/html")
        elif path == "state":
            self._send(200, self._reply(self.server.session.state), "text/plain")
        else:
            self._send(404, "no such page", "text/plain")

    def do_POST(self) -> None:
        """Take an answer; the page is asked for again."""
        path = self._path(needs_origin=True)
        if path is None:
            return
        fields = self._fields()
        if path != "" or fields is None:
            self._send(400, "not an answer of the page", "text/plain")
            return
        self._reply(lambda: self.server.session.answer(fields))
        self._send(303, "", "text/plain", Location="./")

    def log_message(self, format: str, *args: Any) -> None:
        """Log nothing, since addresses contain the token."""

    def _reply(self, ask: Callable[[], object]) -> str:
        try:
            return str(ask())
        except CrowdbotError as error:  # damaged or unwritable data
            return f"{error}"

    def _path(self, *, needs_origin: bool = False) -> str | None:
        """Return the path below the token; None if the request was refused."""
        headers = {n.lower(): self.headers.get_all(n, []) for n in set(self.headers.keys())}
        problem = self.server.admission.problem(headers)
        origins = headers.get("origin", [])
        if not problem and (origins or needs_origin) and origins != [self._own_origin()]:
            problem = "not from this page"
        token, slash, rest = self.path.partition("?")[0].removeprefix("/").partition("/")
        if not problem and not hmac.compare_digest(token.encode(), self.server.token.encode()):
            problem = "not without the token of the page's address"
        if problem:
            self.close_connection = True
            self._send(403, problem, "text/plain")
            return None
        return rest if slash else "/"

    def _own_origin(self) -> str:
        """Return the origin under which the page was opened: by number, or as localhost."""
        return f"http://{self.headers.get('Host', '')}"

    def _fields(self) -> dict[str, str] | None:
        """Return the fields of a form; None if the body is not one."""
        length = self.headers.get("Content-Length", "")
        kind = self.headers.get_content_type()
        if not length.isdecimal() or int(length) > _LONGEST or kind != _FORM:
            self.close_connection = True
            return None
        text = self.rfile.read(int(length)).decode("utf-8", "replace")
        try:
            return dict(parse_qsl(text, keep_blank_values=True, max_num_fields=_MOST_FIELDS))
        except ValueError:
            return None

    def _send(self, code: int, text: str, kind: str, **more: str) -> None:
        body = text.encode()
        self.send_response(code)
        for name, value in {**_HEADERS, **more}.items():
            self.send_header(name, value)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)


_FORM = "application/x-www-form-urlencoded"
