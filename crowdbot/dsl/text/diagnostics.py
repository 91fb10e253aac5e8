"""Errors with a position: file, line, column, the line itself and a caret."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from unicodedata import category

#: Hint for files of other programs.
OTHER_FILES = (
    "'crowdbot import FILE' makes a scenario of other simulators' scenes, and says which field "
    "reads a map, a floor plan or a robot"
)
#: Every code and its title; docs/reference/errors.md explains each.
CODES = {
    "E001": "file that cannot be read",
    "E002": "YAML syntax",
    "E003": "duplicate key",
    "E004": "anchor or alias",
    "E005": "tag",
    "E006": "merge key",
    "E007": "more than one plain document",
    "E008": "number that is not allowed",
    "E009": "nested too deep",
    "E010": "unusable key",
    "E011": "not a map",
    "E012": "format version",
    "E013": "neither suite nor scenario",
    "E014": "version of a component",
    "E015": "table of agents",
    "E016": "hidden character",
    "E102": "unknown field",
    "E103": "missing field",
    "E110": "bad quantity",
    "E111": "wrong type",
    "E112": "out of range",
    "E113": "unknown word",
    "E114": "wrong number of entries",
    "E115": "rule of a component",
    "E116": "text of the wrong form",
    "E120": "unknown kind",
    "E121": "unknown metric",
    "E130": "unknown zone, portal, goal area, policy, link or joint",
    "E131": "number of people that is not whole",
    "E132": "place outside the environment",
    "E133": "policy without cost functions",
    "E134": "crowd without people",
    "E135": "people without a speed",
    "E136": "area too small for its people",
    "E137": "group sizes that never occur",
    "E138": "number of an agent used twice",
    "E139": "agents in each other's place",
    "E140": "goal area without a next one",
    "E141": "people without a goal",
    "E142": "no ways across a torus",
    "E143": "nowhere to stand, or no way to a goal",
    "E144": "floor plan that cannot be read",
    "E145": "start in the goal",
    "E146": "goal person who is not there",
    "E147": "goal person who does not fit the task",
    "E201": "missing include",
    "E202": "include cycle",
    "E203": "include outside the root folder",
    "E204": "override of something that does not exist",
    "E205": "two axes write the same field",
    "E206": "too many includes",
    "E207": "too many combinations",
    "E208": "unknown axis",
    "E209": "empty axis",
    "E210": "unknown label",
    "E211": "empty selection",
    "E212": "suite without an id of its own",
    "E213": "asset with another content",
    "E214": "draws that are not the committed ones",
    "E215": "draws revealed in part",
    "E301": "plugin collision",
    "E401": "file of another program that cannot be read",
    "E402": "value in a file of another program",
    "E403": "file of no known program",
}
REFERENCE = "docs/reference/errors.md"
#: Largest number of reported errors; documents with more are broken in another way.
MAX_ERRORS = 1000
#: Number of identical errors that are shown.
_ALIKE = 10
_WINDOW = 100
_LONGEST = 400


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """A text that was read: its name, its lines, its includer, and its file."""

    name: str
    lines: Sequence[str] = ()
    included_from: Mark | None = None
    file: Path | None = None


@dataclass(frozen=True, slots=True)
class Mark:
    """A position in a source. Line and column count from 0; width in characters, on one line."""

    source: Source
    line: int = 0
    column: int = 0
    width: int = 1

    def __str__(self) -> str:
        return f"{self.source.name}:{self.line + 1}:{self.column + 1}"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """An error in a document, with its position and a hint.

    Attributes:
        code: a key of `CODES`.
        message: the error.
        mark: its position.
        hint: suggestion, shown beside the caret.
        also: related positions, with a word each.
    """

    code: str
    message: str
    mark: Mark
    hint: str = ""
    also: tuple[tuple[str, Mark], ...] = ()

    def headline(self) -> str:
        """Return ``file:line:column: error[code] message``."""
        return f"{self.mark}: error[{self.code}] {_shown(self.message)}"

    def sentence(self) -> str:
        """Return headline and hint, for Python exceptions, which show no snippet."""
        return self.headline() + (f"; {_shown(self.hint)}" if self.hint else "")

    def sort_key(self) -> tuple[str, int, int, str, str]:
        """Return the key for sorting by position, then code."""
        mark = self.mark
        return (mark.source.name, mark.line, mark.column, self.code, self.message)

    def as_dict(self) -> dict[str, object]:
        """Return a dictionary for ``--format json``; line and column count from 1."""
        return {
            "code": self.code,
            "title": CODES[self.code],
            "message": _clip(self.message),
            "hint": _clip(self.hint),
            "file": self.mark.source.name,
            "line": self.mark.line + 1,
            "column": self.mark.column + 1,
            "width": self.mark.width,
            "also": [{"what": text, "at": str(mark)} for text, mark in self.also],
            "included_from": [_place(mark) for mark in _includers(self.mark)],
        }


def render(diagnostics: Iterable[Diagnostic]) -> str:
    """Return all errors as readable text, with a count in the last line.

    If many positions have the same error, the first `_ALIKE` are shown, then a number.
    """
    found = list(diagnostics)
    count = "1 error" if len(found) == 1 else f"{len(found)} errors"
    if len(found) >= MAX_ERRORS:
        count = f"at least {count}"
    alike = Counter[tuple[str, str, str]]()
    lines = []
    for one in found:
        key = (one.mark.source.name, one.code, one.message)
        alike[key] += 1
        if alike[key] <= _ALIKE:
            lines.append(_render_one(one))
    lines += [
        f"{name}: error[{code}] {_shown(message)}: {number - _ALIKE} more of them"
        for (name, code, message), number in alike.items()
        if number > _ALIKE
    ]
    return "\n".join([*lines, f"{count}; see {REFERENCE}"])


def _render_one(diagnostic: Diagnostic) -> str:
    lines = [diagnostic.headline(), *_snippet(diagnostic.mark, _shown(diagnostic.hint))]
    lines += [f"  {note} {mark}" for note, mark in diagnostic.also]
    lines += [f"  included from {_place(mark)}" for mark in _includers(diagnostic.mark)]
    return "\n".join(lines)


def _snippet(mark: Mark, hint: str) -> list[str]:
    if not 0 <= mark.line < len(mark.source.lines):
        return [f"      {hint}"] if hint else []
    line = mark.source.lines[mark.line].replace("\t", " ")
    start = max(0, mark.column - _WINDOW // 2) if len(line) > _WINDOW else 0
    shown = line[start : start + _WINDOW]
    column = min(mark.column - start, len(shown))
    before, marked = _shown(shown[:column]), _shown(shown[column : column + max(mark.width, 1)])
    return [
        f"{mark.line + 1:>5} | {_shown(shown)}".rstrip(),
        f"      | {' ' * len(before)}{'^' * max(1, len(marked))} {hint}".rstrip(),
    ]


def _shown(text: str) -> str:
    """Return a text for terminals: one line, shortened, hidden characters escaped.

    Like `crowdbot.errors.printable`, which imports this module.
    """
    text = _clip(text)
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        c.encode("unicode_escape").decode()
        if category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp") and c not in "\t\u200c\u200d"
        else c
        for c in text
    )


def _clip(text: str) -> str:
    """Cut the middle out of a text that is too long for a message."""
    if len(text) <= _LONGEST:
        return text
    return f"{text[: _LONGEST // 2]} … {text[-_LONGEST // 2 :]}"


def _includers(mark: Mark) -> list[Mark]:
    marks: list[Mark] = []
    while mark.source.included_from is not None:
        mark = mark.source.included_from
        marks.append(mark)
    return marks


def _place(mark: Mark) -> str:
    return f"{mark.source.name}:{mark.line + 1}"
