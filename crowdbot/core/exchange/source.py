"""Read files of other programs, limited in size, with positions for messages."""

from __future__ import annotations

import re
from pathlib import Path

from crowdbot.core.support.text_files import suggest_files
from crowdbot.dsl.text.bounded_files import read_bytes, reason_of
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.errors import SpecError

#: Largest file, bytes: a trial of 10 000 people has 13 MB.
LARGEST = 32_000_000
#: Endings of images of maps.
IMAGES = (".pgm", ".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")
IS_IMAGE = (
    "is an image: a scenario reads it with the map.yaml that names it, with "
    "environment: {kind: floor_plan, file: map.yaml}"
)
_DECLARED = re.compile(rb"<\?xml[^>]{0,200}encoding=[\"']([A-Za-z0-9._-]{1,40})[\"']")
_ENCODINGS = {"utf-8": "utf-8", "utf8": "utf-8", "us-ascii": "utf-8", "ascii": "utf-8",
              "iso-8859-1": "latin-1", "latin1": "latin-1", "windows-1252": "cp1252"}  # fmt: skip


def source_of(path: Path) -> tuple[Source, str]:
    """Return a file as source of positions, and its text with line feeds.

    Raises:
        SpecError: E401, it cannot be read, is too large, or is not a text.
    """
    try:
        raw = read_bytes(path, LARGEST)
    except (OSError, ValueError) as error:
        near = suggest_files(path) if isinstance(error, FileNotFoundError) else ""
        raise _unreadable(path, reason_of(error) + near) from None
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" in raw[:1000]:
        image = path.suffix.lower() in IMAGES
        raise _unreadable(
            path, IS_IMAGE if image else "is UTF-16 or a binary file; save it as UTF-8"
        )
    text = _decoded(path, raw.removeprefix(b"\xef\xbb\xbf"))
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Source(str(path), text.split("\n"), file=path), text


def _decoded(path: Path, raw: bytes) -> str:
    declared = _DECLARED.match(raw.lstrip())
    name = declared[1].decode().lower() if declared else "utf-8"
    if name not in _ENCODINGS:
        raise _unreadable(path, f"is in the encoding {name}, which is not read; save it as UTF-8")
    try:
        return raw.decode(_ENCODINGS[name])
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start)
        column = error.start - raw.rfind(b"\n", 0, error.start) - 1
        mark = Mark(Source(str(path)), line, column)
        raise SpecError([Diagnostic("E401", f"not {name.upper()} text", mark)]) from None


def _unreadable(path: Path, why: str) -> SpecError:
    return SpecError([Diagnostic("E401", why, Mark(Source(str(path))))])
