"""One file that is edited: read, changed, checked, played and saved."""

from __future__ import annotations

import hashlib
from pathlib import Path
from threading import Lock
from typing import Any

from crowdbot.core.editor.document import NEW, Edit, changed
from crowdbot.core.editor.drawn import drawn
from crowdbot.core.editor.play import play
from crowdbot.core.exchange.scene import id_of
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.dsl.text.bounded_files import MAX_BYTES, read_text
from crowdbot.errors import InputError, UsageError


class ConflictError(InputError):
    """The file was changed by another program since it was read."""


class Desk:
    """The file of one editor; requests come one at a time.

    Args:
        file: the document; one that does not exist begins as an empty floor.
        registry: the installed components.

    Raises:
        UsageError: it is a suite, whose scenarios have no text of their own.
        SpecError: it cannot be read.
    """

    def __init__(self, file: Path, registry: Registry) -> None:
        self.file, self._registry, self._lock = file, registry, Lock()
        text = self._read()
        if "\nsuite:" in f"\n{text}":
            raise UsageError(
                f"{file} is a suite; edit one of its scenarios: "
                f"crowdbot expand {file} --one ID > scenario.yaml"
            )

    def opened(self) -> dict[str, Any]:
        """Return the text of the file, its hash and its drawing."""
        with self._lock:
            text = self._read()
            return {"text": text, "hash": self._hash(), **self._drawn(text)}

    def check(self, text: str) -> dict[str, Any]:
        """Return the drawing of a text."""
        with self._lock:
            return {"text": text, **self._drawn(text)}

    def change(self, text: str, changes: list[Edit]) -> dict[str, Any]:
        """Return a text with changes made to it, and its drawing."""
        with self._lock:
            made = changed(_bounded(text), changes)
            return {"text": made, **self._drawn(made)}

    def play(self, text: str) -> dict[str, Any]:
        """Return the first ten seconds of a scenario text, simulated.

        Raises:
            InputError: it is not valid, or its simulation failed.
        """
        found = self._drawn(text)
        if found["errors"]:
            raise InputError("mend the errors first: only a valid scenario can be played")
        return play(text, self.file, list(found["data"].get("robots", {})))

    def save(self, text: str, known: str, *, anyway: bool) -> dict[str, Any]:
        """Write a text to the file.

        Args:
            text: the document.
            known: hash of the file when it was read.
            anyway: True to overwrite changes that other programs made meanwhile.

        Raises:
            ConflictError: another program wrote the file meanwhile.
        """
        with self._lock:
            if self._hash() != known and not anyway:
                raise ConflictError(
                    f"{self.file.name} was changed by another program since it was opened here"
                )
            atomic_write(self.file, _bounded(text))
            return {"hash": self._hash(), "errors": self._drawn(text)["errors"]}

    def _read(self) -> str:
        if not self.file.exists():
            return NEW.format(name=id_of(self.file.stem))
        return read_text(self.file, str(self.file))

    def _hash(self) -> str:
        return hashlib.sha256(self.file.read_bytes()).hexdigest() if self.file.exists() else "new"

    def _drawn(self, text: str) -> dict[str, Any]:
        return drawn(_bounded(text), self.file, self._registry)


def _bounded(text: str) -> str:
    if len(text.encode()) > MAX_BYTES:
        raise InputError("the text is larger than 1 MB")
    return text
