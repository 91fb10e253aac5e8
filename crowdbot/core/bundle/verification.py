"""The record of a verification, stored beside the bundle for the leaderboard."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from crowdbot.core.runs.run_directory import write_json
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.support.text_files import read_text
from crowdbot.dsl.text.bounded_files import open_file, reason_of
from crowdbot.errors import InputError


def content_hash(bundle: Path) -> str:
    """Return the SHA-256 of an archive.

    Raises:
        InputError: it cannot be read.
    """
    try:
        with open_file(bundle) as file:
            return hashlib.file_digest(cast(Any, file), "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{bundle}: cannot be read: {reason_of(error)}") from None


def record_path(bundle: Path) -> Path:
    """Return the path of a bundle's verification record."""
    return bundle.with_suffix(".verified.json")


def save_verification(bundle: Path, record: Mapping[str, Any]) -> None:
    """Write the record; it names the bundle by its hash.

    Raises:
        InputError: it cannot be written.
    """
    write_json(record_path(bundle), record)


def read_verification(bundle: Path) -> dict[str, Any] | None:
    """Return the record of this bundle; None if there is none, or it is of another bundle."""
    try:
        record = parse_json(read_text(record_path(bundle)))
    except (OSError, ValueError):
        return None
    if not isinstance(record, dict) or record.get("sha256") != content_hash(bundle):
        return None
    return record
