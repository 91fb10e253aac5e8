"""Admission to a live server: pages of foreign websites are refused."""

from __future__ import annotations

import ipaddress
import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from crowdbot.errors import printable

#: Largest number of refused websites that are named on stderr.
_NAMED = 20
#: Scheme, host and port, as browsers write an origin: no user, path or query.
_ORIGIN = re.compile(
    r"(?:[a-z][a-z0-9+.-]*:)?//(\[[0-9a-f:.]+\]|[a-z0-9.-]+)(?::[0-9]{1,5})?/?", re.I
)
#: Headers of a page of our own: no other site may frame it, guess its kind, learn its address or
#: keep it.
PAGE_HEADERS: Mapping[str, str] = {
    "Content-Security-Policy": "frame-ancestors 'none'",
    "X-Frame-Options": "DENY",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


def is_loopback(host: str) -> bool:
    """Return True if a host is this machine: localhost, or a loopback address."""
    name = host.lower()
    if name.startswith("[") and name.endswith("]"):
        name = name[1:-1]
    try:
        address = ipaddress.ip_address(name)
    except ValueError:
        return name in ("localhost", "localhost.")
    mapped = getattr(address, "ipv4_mapped", None)
    return (mapped or address).is_loopback


@dataclass(kw_only=True)
class Admission:
    """The rule for clients of one server.

    A browser sends the website of a page as ``Origin``, and the name by which it reached the
    server as ``Host``, which is a foreign name after DNS rebinding. Programs send no ``Origin``.

    Attributes:
        server: name of the server for messages.
        origins: websites that are admitted, such as ``https://app.foxglove.dev``.
    """

    server: str
    origins: Sequence[str] = ()
    _refused: set[str] = field(default_factory=set)

    def problem(self, headers: Mapping[str, Sequence[str]]) -> str:
        """Return why a request is refused; empty if it is admitted.

        Args:
            headers: name in lower case -> all its values.
        """
        hosts, origins = headers.get("host", ()), headers.get("origin", ())
        if len(hosts) > 1 or len(origins) > 1:
            return "a header is there twice"
        if origins and not self._fits(origins[0]):
            self._say(origins[0])
            return f"not from that website; --allow-origin {printable(origins[0])[:200]} admits it"
        if hosts and not is_loopback(_name(f"//{hosts[0]}")):
            return "not by that name: 'localhost' and loopback addresses are served"
        return ""

    def _fits(self, origin: str) -> bool:
        if origin.rstrip("/") in (o.rstrip("/") for o in self.origins):
            return True
        return is_loopback(_name(origin))

    def _say(self, origin: str) -> None:
        """Name a refused website once; the user may have opened it."""
        shown = printable(origin)[:200]
        if shown not in self._refused and len(self._refused) < _NAMED:
            self._refused.add(shown)
            text = f"{self.server}: refused a page of {shown}; --allow-origin {shown} admits it"
            print(text, file=sys.stderr, flush=True)


def _name(url: str) -> str:
    """Return the host's name in an origin or after ``//``; empty if it has more than a port."""
    found = _ORIGIN.fullmatch(url)
    return found[1] if found else ""
