"""All exceptions that crowdbot raises on purpose.

::

    CrowdbotError                 exit code
    ├── InputError                1   the input is wrong: a document, an id, a value, a file
    │   ├── SpecError             1   a scenario or suite document; carries positioned diagnostics
    │   └── UnknownNameError      1   a kind, id or suite that does not exist; carries near names
    ├── UsageError                2   the command line itself is wrong
    ├── PluginError               3   a plugin failed; names the plugin
    │   ├── PlannerError          3   a planner raised, or returned something that is not a command
    │   └── PlannerHungError      3   a planner step never returned; ended by the watchdog
    ├── SimulationError           4   the simulation itself failed
    │   └── MissingLibraryError   4   a system library that Drake needs is not installed
    └── Interrupted               130 the user stopped the run
"""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from crowdbot.dsl.text.diagnostics import Diagnostic


#: Number of names listed in full if none is similar to the given one.
_FEW = 12


class CrowdbotError(Exception):
    """Base of all errors with a readable message."""

    exit_code = 1

    def __reduce__(self) -> tuple[Any, ...]:
        """Return data for pickle that restores the error without calling ``__init__``."""
        return _as_raised, (type(self), self.args, self.__dict__)


def _as_raised(
    kind: type[CrowdbotError], args: tuple[Any, ...], state: dict[str, Any]
) -> CrowdbotError:
    error = kind.__new__(kind)
    error.args = args
    error.__dict__.update(state)
    return error


class InputError(CrowdbotError):
    """The input is wrong."""


class SpecError(InputError):
    """One or more positioned errors in a document."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(d.sentence() for d in self.diagnostics))


class UnknownNameError(InputError):
    """An unknown name; the message ends with the reason or similar names."""

    def __init__(self, kind: str, name: str, known: Iterable[str], why: str = "") -> None:
        names = sorted(known)
        self.kind, self.name, self.near = kind, name, nearest(name, names)
        hint = f"; {why}" if why else did_you_mean(self.near)
        if not hint and 0 < len(names) <= _FEW:
            hint = f"; there are: {', '.join(names)}"
        super().__init__(f"unknown {kind} '{name}'{hint}")


class UsageError(CrowdbotError):
    """The command line is wrong."""

    exit_code = 2


class PluginError(CrowdbotError):
    """A plugin failed."""

    exit_code = 3


class PlannerError(PluginError):
    """A planner raised, or returned something that is not a command."""


class PlannerHungError(PluginError):
    """A planner step did not return within the watchdog's time."""


class SimulationError(CrowdbotError):
    """The simulation failed."""

    exit_code = 4


class MissingLibraryError(SimulationError):
    """A system library that Drake needs is not installed."""


class Interrupted(CrowdbotError):  # noqa: N818 - not a failure
    """The user stopped the run; the recording so far is readable."""

    exit_code = 130


class RecordingWarning(UserWarning):
    """A recording contains implausible values, such as positions in millimetres."""


def nearest(name: str, known: Iterable[str], limit: int = 3) -> tuple[str, ...]:
    """Return the known names most similar to ``name``, best first."""
    return tuple(difflib.get_close_matches(name, sorted(known), n=limit, cutoff=0.6))


def kind_of(value: object) -> str:
    """Return a value's type with its article: ``an int``, ``a list``, ``None``."""
    name = type(value).__name__
    return "None" if value is None else f"{'an' if name[0] in 'AEIOUaeiou' else 'a'} {name}"


def did_you_mean(near: Sequence[str]) -> str:
    """Return ``"; did you mean 'a' or 'b'?"``, or ""."""
    return f"; did you mean {' or '.join(repr(n) for n in near)}?" if near else ""


def hidden_character(text: str, allowed: str = "\t\n\r") -> str:
    """Return the first invisible or bidirectional character, as ``U+202E``.

    These are control and format characters, line and paragraph separators, and lone surrogates; but
    not the two joiners that some scripts need. Empty if there is none.
    """
    if text.isascii() and text.isprintable():
        return ""
    for character in text:
        if _is_hidden(character) and character not in allowed:
            return f"U+{ord(character):04X}"
    return ""


def printable(text: str) -> str:
    """Return a text with hidden characters escaped, so that it can be shown and written."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        c.encode("unicode_escape").decode() if _is_hidden(c) and c not in "\t\n" else c
        for c in text
    )


def _is_hidden(character: str) -> bool:
    kinds = ("Cc", "Cf", "Cs", "Zl", "Zp")
    return unicodedata.category(character) in kinds and character not in "\u200c\u200d"
