"""The boundary to plugins: every call into a plugin's code is made inside a `PluginCall`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection
from types import TracebackType
from typing import Any, NoReturn

from crowdbot.core.registry.plugin_errors import describe_error, is_user_interrupt
from crowdbot.errors import CrowdbotError, PluginError, printable

Exceptions = type[BaseException] | tuple[type[BaseException], ...]


class PluginCall:
    """Calls into one plugin: made once, entered for each call.

    ::

        call = PluginCall("sensor 'acme.radar' (acme 1.0)")
        with call("read", t):
            values = sensor.read(...)

    What Python code inside prints goes to stderr, so that stdout keeps to what a command answers.
    The user's interrupt passes, and so do crowdbot's own errors, with ``who`` put in front where
    they do not say it. Whatever else is raised, ``SystemExit`` and ``KeyboardInterrupt`` included,
    becomes an ``error`` that says who it was, what it did, and in which line of which file.

    Args:
        who: what is called, and the distribution that it comes from; begins every message.
        sources: finds the plugin's files, whose lines are preferred to those of libraries.
        error: what everything else becomes.
        passes: exceptions that stay what they are.

    Entering it costs 0.4 microseconds; it may be entered again while it is entered.
    """

    __slots__ = ("_doing", "_error", "_passes", "_sources", "_stdouts", "_t", "who")

    def __init__(
        self,
        who: str,
        *,
        sources: Callable[[], Collection[str]] = frozenset,
        error: type[PluginError] = PluginError,
        passes: Exceptions = CrowdbotError,
    ) -> None:
        self.who = who
        self._sources, self._error, self._passes = sources, error, passes
        self._doing = ""
        self._t: float | None = None
        self._stdouts: list[Any] = []

    def __call__(self, doing: str, t: float | None = None) -> PluginCall:
        """Say what the next call does, and at which simulated time (s), for messages."""
        self._doing, self._t = doing, t
        return self

    def __enter__(self) -> PluginCall:
        self._stdouts.append(sys.stdout)
        sys.stdout = sys.stderr
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            if error is not None:
                self._let_pass_or_raise(error)
        finally:
            sys.stdout = self._stdouts.pop()

    def fail(self, what: str) -> NoReturn:
        """Say what is wrong with that which a call returned.

        Raises:
            PluginError: always; of the class that was asked for.
        """
        raise self._error(printable(f"{self.who}: {what}" if self.who else what))

    def _let_pass_or_raise(self, error: BaseException) -> None:
        if is_user_interrupt(error):
            return
        if not isinstance(error, self._passes):
            raise self._error(self._told(describe_error(error, self._sources()))) from error
        if isinstance(error, CrowdbotError) and self.who.partition(" (")[0] not in str(error):
            error.args = (printable(f"{self.who}: {error}"),)

    def _told(self, what: str) -> str:
        """Who, in which call, at which time: what."""
        doing = self._doing if self._t is None else f"{self._doing} at t = {self._t:g} s"
        return printable(": ".join(part for part in (self.who, doing, what) if part))
