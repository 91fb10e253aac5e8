"""Hidden draws: an organiser commits to a seed, and reveals it once tuning is impossible.

Works on a suite's file: lines are added at its end, and written only if the resulting file is
correct. Seed and salt are in a separate file that only its owner can read.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import secrets
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Le
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import OpenDocument, check_writable, open_document
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.dsl.scenario.field_hashes import changes, flatten
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.suite.asset_files import asset_hashes
from crowdbot.dsl.suite.commitment import (
    COMMITMENT,
    SALT,
    commitment_of,
    committed_content,
    is_random,
)
from crowdbot.dsl.suite.expand import expand_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.suite import ParsedSuite
from crowdbot.dsl.text.bounded_files import read_bytes
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError, SpecError

#: Ending of a temporary copy of a document.
_COPY = ".try.yaml"
#: Bytes of a salt.
SALT_BYTES = 32
_SEEDS = 2**63
_LONGEST = 1 << 20
_SHOWN = 3


class Secret(BaseModel):
    """The content of ``NAME.secret.json``, which reveals a commitment."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    secret: Annotated[int, Ge(1), Le(1)] = 1
    suite: str
    commitment: Annotated[str, Field(pattern=COMMITMENT)]
    seed: Annotated[int, Ge(0), Le(_SEEDS - 1)]
    salt: Annotated[str, Field(pattern=SALT)]
    document: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Change:
    """Lines to add to a suite's file.

    Attributes:
        path: the file's path.
        lines: lines to add at its end.
        text: the file's text with the lines.
    """

    path: Path
    lines: tuple[str, ...]
    text: str


def secret_path(document: Path) -> Path:
    """Return the default path of a suite's secret."""
    return document.with_suffix(".secret.json")


def commit(spec: str, registry: Registry, seed: int | None = None) -> tuple[Secret, Change]:
    """Choose seed and salt of a suite, and the lines to add to it, without writing.

    Args:
        spec: the suite.
        registry: the installed components.
        seed: default: from the system's entropy, as the salt is always.

    Raises:
        InputError: it is not a suite, is committed already, has a seed in the open, or samples no
            people from its seed.
    """
    document = open_document(spec, registry)
    _check_open(document)
    content = committed_content(document.suite.tree)
    files = asset_hashes(expanded(document, registry).scenarios)
    rows = [{"path": path, "sha256": digest} for path, digest in files.items()]
    if rows:
        content["suite"] = {**content["suite"], "files": rows}
    lines = [f"suite.files: {json.dumps(rows)}"] if rows and document.suite.files != files else []
    seed = secrets.randbelow(_SEEDS) if seed is None else seed
    salt = _new_salt()
    secret = Secret(
        suite=document.suite.id,
        commitment=commitment_of(content, seed, salt),
        seed=seed,
        salt=salt,
        document=content,
    )
    lines.append(f"suite.commitment: {secret.commitment}")
    return secret, _change(document, lines, registry)


def expanded(document: OpenDocument, registry: Registry) -> Expansion:
    """Return the scenarios of a document, after checking its files against the commitment.

    Raises:
        SpecError: a scenario is invalid, or a file is missing or was changed.
    """
    return expand_document(document.suite, registry.scenario_model)


def reveal(spec: str, registry: Registry, secret_file: Path) -> tuple[Secret, Change]:
    """Return the lines to add to a suite to reveal its seed.

    Raises:
        InputError: the secret belongs to another suite, or suite or commitment were changed since.
    """
    secret = read_secret(secret_file)
    document = open_document(spec, registry)
    suite = document.suite
    if not suite.commitment:
        raise InputError(f"{document.name} has no commitment: there is nothing to reveal")
    if not suite.hidden:
        raise InputError(f"{document.name}: its seed has been revealed already")
    if secret.suite != suite.id:
        raise InputError(f"{secret_file} is the secret of '{secret.suite}', not of '{suite.id}'")
    expanded(document, registry)
    content = committed_content(suite.tree)
    found = commitment_of(content, secret.seed, secret.salt)
    if found != suite.commitment:
        raise InputError(f"{document.name}: {_why(secret, content)}")
    lines = [f"suite.seed: {secret.seed}", f'suite.salt: "{secret.salt}"']
    return secret, _change(document, lines, registry)


def write_change(change: Change) -> None:
    """Write the suite's file atomically.

    Raises:
        InputError: it cannot be written.
    """
    atomic_write(change.path, change.text)


def write_secret(path: Path, secret: Secret) -> None:
    """Write seed and salt to a new file that only its owner can ever read.

    Raises:
        InputError: the file exists already, or it cannot be written.
    """
    text = secret.model_dump_json(indent=1) + "\n"
    try:
        number = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise InputError(
            f"{path} is there already: a secret that is lost cannot be revealed; move it, or name "
            "another file with --secret"
        ) from None
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        with os.fdopen(number, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        with contextlib.suppress(OSError):
            path.unlink()
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def read_secret(path: Path) -> Secret:
    """Read a secret from its file.

    Raises:
        InputError: it cannot be read, or is not one.
    """
    try:
        text = read_bytes(path, _LONGEST).decode()
        return Secret.model_validate_json(text)
    except OSError as error:
        raise InputError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is not UTF-8 text") from None
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(map(str, first["loc"]))
        where = f"{place}: " if place else ""
        raise InputError(f"{path} is not a secret of hidden draws: {where}{first['msg']}") from None


def read_seed(path: Path) -> int:
    """Read a seed from a file with nothing else, such as the outcome of a public lottery.

    Raises:
        InputError: it cannot be read, or contains something else.
    """
    try:
        text = read_bytes(path, _LONGEST).decode("ascii", errors="replace").strip()
    except OSError as error:
        raise InputError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    if not re.fullmatch(r"[0-9]{1,19}", text) or int(text) >= _SEEDS:
        raise InputError(f"{path}: a seed is a whole number from 0 to {_SEEDS - 1}, nothing else")
    return int(text)


# ---------------------------------------------------------------------- committing
def _check_open(document: OpenDocument) -> None:
    suite, name = document.suite, document.name
    if suite.seed is None:
        raise InputError(f"{name} is a single scenario; draws of suites can be hidden")
    if suite.commitment:
        state = "hidden" if suite.hidden else "revealed"
        raise InputError(
            f"{name} is committed already, its seed is {state}; for new draws remove "
            "suite.commitment, suite.seed and suite.salt"
        )
    head = suite.tree.child("suite")
    seed = head.child("seed") if head else None
    if seed is not None and seed.mark.source.included_from is None:
        text = "the seed is in the open: everyone can draw these people"
        raise SpecError([Diagnostic("E215", text, seed.mark, "remove it; another one is chosen")])


def _new_salt() -> str:
    while True:
        salt = secrets.token_hex(SALT_BYTES)
        if is_random(salt):
            return salt


# ----------------------------------------------------------------------- changing
def _change(document: OpenDocument, lines: Sequence[str], registry: Registry) -> Change:
    """Return the file with added lines, checked by reading it once.

    Raises:
        InputError: nothing can be added to it, or no people are sampled from its seed.
    """
    check_writable(LockFiles(document.path, document.name))
    before = document.path.read_bytes().decode()
    end = "" if before.endswith("\n") else "\n"
    text = before + end + "".join(f"{line}\n" for line in lines)
    with _copy(document.path, text) as copy:
        try:
            after = open_document(str(copy), registry).suite
        except SpecError:
            block = "\n".join(f"  {line}" for line in lines)
            raise InputError(
                f"{document.name}: nothing can be added at its end; write this into it:\n{block}"
            ) from None
        if after.hidden:
            _check_drawn(document, after, registry)
    return Change(document.path, tuple(lines), text)


def _check_drawn(document: OpenDocument, after: ParsedSuite, registry: Registry) -> None:
    try:
        expansion = expand_document(after, registry.scenario_model)
    except SpecError as error:
        raise SpecError([_named(d, document.name) for d in error.diagnostics]) from None
    if not any(scenario.hidden for scenario in expansion.scenarios):
        raise InputError(f"{document.name}: no people are drawn from suite.seed: nothing to hide")


def _named(diagnostic: Diagnostic, name: str) -> Diagnostic:
    """Return an error of a copy under the name of its original."""
    source = diagnostic.mark.source
    if not source.name.endswith(_COPY):
        return diagnostic  # in a file that the document includes
    return replace(diagnostic, mark=replace(diagnostic.mark, source=replace(source, name=name)))


@contextlib.contextmanager
def _copy(path: Path, text: str) -> Iterator[Path]:
    """Yield a temporary file with a text, beside another one so that its includes resolve."""
    copy = path.with_name(f".{path.stem}.{os.getpid()}{_COPY}")
    try:
        copy.write_bytes(text.encode())
        yield copy
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        with contextlib.suppress(OSError):
            copy.unlink()


def _why(secret: Secret, content: dict[str, Any]) -> str:
    """Return the reason why secret, commitment or document do not fit."""
    if commitment_of(secret.document, secret.seed, secret.salt) != secret.commitment:
        return "seed, salt or document in the secret are not those of its commitment"
    changed = list(changes(flatten(secret.document), flatten(content)))
    if changed:
        some = "; ".join(changed[:_SHOWN]) + ("; …" if len(changed) > _SHOWN else "")
        return f"the document was changed after the commitment ({some})"
    return f"its commitment is not that of the secret, {secret.commitment}"
