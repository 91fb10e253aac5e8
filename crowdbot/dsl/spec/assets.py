"""Files that components read, such as recorded tracks of people.

A document names a file by a path, as in ``extends``. The path from the top-level document and the
SHA-256 of the content are part of the scenario and of its hash; the file's location on this machine
is not.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Annotated, Any

from annotated_types import MinLen
from pydantic import ConfigDict, Field, PrivateAttr, model_validator

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.spec import Spec
from crowdbot.dsl.text.bounded_files import open_file
from crowdbot.errors import InputError

MAX_BYTES = 1 << 30


class Asset(Spec):
    """A file that a component reads. A bare path is its short form."""

    model_config = ConfigDict(json_schema_extra={"short": "path"})

    path: Annotated[str, MinLen(1)] = Field(
        description="Path, relative to the file that names it, or `NAME:path` in a plugin's folder."
    )
    sha256: str | None = default(
        None,
        "Of the content, filled in; written, the file has to have this content.",
        pattern=r"^[0-9a-f]{64}$",
    )
    _file: Path | None = PrivateAttr(default=None)

    @model_validator(mode="before")
    @classmethod
    def _short_form(cls, value: Any) -> Any:
        return {"path": value} if isinstance(value, str | int | float) else value

    def __eq__(self, other: object) -> bool:
        """Return True if the written content is equal; the file's location is ignored."""
        return isinstance(other, Asset) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash((self.path, self.sha256))

    @property
    def is_found(self) -> bool:
        """Return True if the file's location is known."""
        return self._file is not None

    @property
    def file(self) -> Path:
        """Return the file, unchanged since the document was read.

        Without a document the path is relative to the working directory.

        Raises:
            InputError: it cannot be read, or has another content.
        """
        file = self._file or Path(self.path)
        try:
            found = sha256_of(file)
        except OSError as error:
            raise InputError(f"{file}: cannot be read: {error.strerror or error}") from error
        if self.sha256 not in (None, found):
            raise InputError(f"{file}: its content differs from that in the scenario")
        return file

    @classmethod
    def at(cls, file: Path, path: str, sha256: str) -> Asset:
        """Return an asset for a file that was found.

        Args:
            file: its location on this machine.
            path: path in the top-level document.
            sha256: hash of its content.
        """
        found = cls(path=path, sha256=sha256)
        found._file = file
        return found


def sha256_of(file: Path) -> str:
    """Return the SHA-256 of a file's content, in hexadecimal digits.

    Raises:
        OSError: it cannot be read, is not a plain file or larger than 1 GiB.
    """
    with open_file(file) as stream:
        digest, size = hashlib.sha256(), 0
        while block := stream.read(1 << 20):
            digest.update(block)
            size += len(block)
            if size > MAX_BYTES:
                raise OSError(f"larger than {MAX_BYTES >> 30} GiB")
    return digest.hexdigest()
