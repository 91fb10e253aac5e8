"""The log of a judge: one signed line per event, each with the hash of the line before.

A line cannot be changed, removed or inserted without changing all that follow, so that anyone who
kept the hash of one line can check everything before it.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from crowdbot.core.bundle.signature import sign, signature_problem
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.support.text_files import input_text
from crowdbot.errors import InputError

#: Name of the log in a judge's folder; the hash before the first line.
LOG, BEGIN = "judge.log.jsonl", "0" * 64
#: Event of a submission that came in time.
RECEIVED = "received"
_REQUIRED = ("line", "time", "previous", "event")


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line: its event with all that belongs to it, and the hash of the whole line."""

    event: str
    document: Mapping[str, Any]
    sha256: str


def read_log(path: Path, trusted: Collection[str]) -> list[LogLine]:
    """Return the lines of a log, each checked; empty if there is no log.

    Raises:
        InputError: a line is damaged, changed, missing, out of order, or not signed with a trusted
            key; the message names it.
    """
    if not path.exists():
        return []
    text = input_text(path)
    if text and not text.endswith("\n"):
        raise InputError(f"{path}: the last line is cut off")
    lines: list[LogLine] = []
    for number, line in enumerate(text.splitlines(), 1):
        where = f"{path}:{number}"
        try:
            document = parse_json(line)
        except ValueError as error:
            raise InputError(f"{where}: {error}") from None
        if not isinstance(document, dict) or any(k not in document for k in _REQUIRED):
            raise InputError(f"{where}: not a line of a judge's log")
        before = lines[-1].sha256 if lines else BEGIN
        if document["line"] != number or document["previous"] != before:
            raise InputError(f"{where}: a line before it was changed, removed or inserted")
        if problem := signature_problem(document, trusted):
            raise InputError(f"{where}: {problem}")
        digest = hashlib.sha256(line.encode()).hexdigest()
        lines.append(LogLine(str(document["event"]), document, digest))
    return lines


def append(path: Path, lines: list[LogLine], event: str, **about: Any) -> None:
    """Append one signed line to a log, and to the lines that were read from it.

    Raises:
        InputError: it cannot be written.
        MissingLibraryError: the extra ``signing`` is not installed.
    """
    time = datetime.now(UTC).isoformat(timespec="seconds")
    before = lines[-1].sha256 if lines else BEGIN
    document = sign(
        {"line": len(lines) + 1, "time": time, "previous": before, "event": event, **about}
    )
    text = json.dumps(document, ensure_ascii=True)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("a", encoding="ascii") as file:
            file.write(text + "\n")
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    lines.append(LogLine(event, document, hashlib.sha256(text.encode()).hexdigest()))
