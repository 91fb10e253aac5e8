"""The record of a verification, signed by the organiser and stored beside the bundle."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, cast

from crowdbot.core.bundle.signature import sign, signature_problem
from crowdbot.core.runs.run_directory import write_json
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.support.text_files import read_text
from crowdbot.dsl.text.bounded_files import open_file, reason_of
from crowdbot.errors import InputError

#: Outcome of a bundle whose runs the organisers made themselves.
JUDGED = "judged"
#: Outcomes with which an entry has no rank.
REFUSED = ("invalid", "suspicious", "nondeterministic")


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
    """Write the record, signed with the user's key; it names the bundle by its hash.

    Raises:
        InputError: it cannot be written, or the key cannot be read.
        MissingLibraryError: the extra ``signing`` is not installed.
    """
    write_json(record_path(bundle), sign(record))


def read_verification(bundle: Path, trusted: Collection[str]) -> tuple[dict[str, Any] | None, str]:
    """Return the record of this bundle, and why it is not trusted.

    Both are empty if no record lies beside the bundle, or it is of another bundle.

    Args:
        bundle: the archive.
        trusted: public keys of organisers.
    """
    path = record_path(bundle)
    if not path.exists():
        return None, ""
    try:
        record = parse_json(read_text(path))
    except (OSError, ValueError) as error:
        return None, f"{path.name} is not believed: {error}"
    if not isinstance(record, dict) or record.get("sha256") != content_hash(bundle):
        return None, ""
    if problem := signature_problem(record, trusted):
        return None, f"{path.name} is not believed: {problem}"
    return record, ""
