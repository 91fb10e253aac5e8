"""Sealed submissions: a planner's files in one archive, named by its SHA-256.

A submission holds code, unlike a bundle; reading one runs nothing.
"""

from __future__ import annotations

import hashlib
import re
import stat
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import metadata
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal
from zlib import error as ZlibError  # noqa: N812 - not one of ours

from annotated_types import Ge
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from crowdbot.core.bundle.archive import open_zip
from crowdbot.core.bundle.manifest import Name
from crowdbot.core.bundle.verification import content_hash
from crowdbot.core.support.atomic_write import atomic_path
from crowdbot.core.support.strict_json import parse_json
from crowdbot.dsl.text.bounded_files import open_file, reason_of
from crowdbot.errors import InputError

#: Ending of a submission's name, and the member that describes it.
SUFFIX, ABOUT = ".cbs", "submission.json"
_MOST, _LARGEST, _ABOUT_BYTES = 10_000, 32 * 10**9, 4_000_000
_NAME = re.compile(
    r"(?:[A-Za-z0-9_+@~=,-][A-Za-z0-9_+.@~=,-]*/)*[A-Za-z0-9_+@~=,-][A-Za-z0-9_+.@~=,-]*"
)
_LONGEST_NAME = 200
_EPOCH, _CHUNK = (1980, 1, 1, 0, 0, 0), 1 << 20


class SealedFile(BaseModel):
    """Hash, size and mode of one file in a planner's archive."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    size: Annotated[int, Ge(0)]
    executable: bool = False


class About(BaseModel):
    """The description of a submission.

    Attributes:
        team, contact: texts for the leaderboard; may be empty.
        planner: ``FILE.py:CLASS`` or ``FILE.yaml``, relative to the archive.
        settings: ``key=value`` texts.
        digest: SHA-256 of the planner as `run.json` has it.
        environment: file that lists the libraries it needs; empty: none.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    submission: Literal[1] = 1
    team: Name = ""
    contact: Name = ""
    planner: Annotated[
        str, Field(pattern=r"^[A-Za-z0-9_+.@~=,-]+(\.yaml|\.yml|\.py:[A-Za-z0-9_]+)$")
    ]
    settings: list[str] = Field(default_factory=list)
    digest: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    environment: str = ""
    crowdbot: str = ""
    files: dict[str, SealedFile]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sealed:
    """A submission on disk; ``sha256`` of the archive."""

    path: Path
    sha256: str
    about: About


def write_submission(out: Path, about: About, files: Mapping[str, Path]) -> Sealed:
    """Write a submission atomically; equal planners give equal bytes.

    Args:
        out: the archive.
        about: description; its ``files`` are filled in.
        files: name in the archive -> file.

    Raises:
        InputError: a file cannot be read, has an unusual name, or the archive cannot be written.
    """
    listed = {name: _described(name, file) for name, file in sorted(files.items())}
    about = about.model_copy(update={"files": listed, "crowdbot": metadata.version("crowdbot")})
    with atomic_path(out) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(_info(ABOUT), about.model_dump_json(indent=1) + "\n")
        for name, file in sorted(files.items()):
            info = _info(name, executable=listed[name].executable)
            with archive.open(info, "w", force_zip64=True) as target, open_file(file) as source:
                while chunk := source.read(_CHUNK):
                    target.write(chunk)
    return Sealed(path=out, sha256=content_hash(out), about=about)


def read_submission(path: Path) -> Sealed:
    """Read a submission without unpacking it.

    Raises:
        InputError: it cannot be read, is not one, or could fill a disk.
    """
    with _opened(path) as archive:
        return Sealed(path=path, sha256=content_hash(path), about=_about(path, archive))


def unpack_submission(sealed: Sealed, folder: Path) -> Path:
    """Write the files of a submission into an empty folder, checked against their hashes.

    Returns:
        The planner's file; a class is named by ``about.planner``.

    Raises:
        InputError: a file is missing, damaged, or not the one that the description names.
        OSError: a file cannot be written.
    """
    with _opened(sealed.path) as archive:
        for name, sealed_file in sealed.about.files.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            _unpack(sealed.path, archive, name, sealed_file, target)
    return folder / sealed.about.planner.partition(":")[0]


def _unpack(
    path: Path, archive: zipfile.ZipFile, name: str, expected: SealedFile, target: Path
) -> None:
    digest, size = hashlib.sha256(), 0
    try:
        with archive.open(name) as source, target.open("xb") as out:
            while chunk := source.read(_CHUNK):
                digest.update(chunk)
                size += len(chunk)
                out.write(chunk)
    except (KeyError, zipfile.BadZipFile, NotImplementedError, EOFError, ZlibError) as error:
        raise InputError(f"{path}: {name} is damaged or missing: {error}") from None
    if (digest.hexdigest(), size) != (expected.sha256, expected.size):
        raise InputError(f"{path}: {name} is not what {ABOUT} says; it was changed")
    target.chmod(0o755 if expected.executable else 0o644)


@contextmanager
def _opened(path: Path) -> Iterator[zipfile.ZipFile]:
    with open_zip(path, "a sealed submission") as file:
        infos = file.infolist()
        if problem := _listing_problem(infos):
            raise InputError(f"{path}: {problem}")
        yield file


def _listing_problem(infos: list[zipfile.ZipInfo]) -> str:
    names = [i.filename for i in infos]
    if len(names) > _MOST or sum(i.file_size for i in infos) > _LARGEST:
        return f"more than {_MOST} files or {_LARGEST // 10**9} GB"
    if len({n.casefold() for n in names}) < len(names):
        return "two files have one name"
    if any(f"{n}/".startswith(f"{m}/") for m, n in pairwise(sorted(names, key=_parts))):
        return "a file has the name of a folder"
    for info in infos:
        kind = stat.S_IFMT(info.external_attr >> 16)
        if not _is_name(info.filename) or kind not in (0, stat.S_IFREG):
            return f"{info.filename[:100]!a} is not allowed in a submission"
        if info.flag_bits & 0x1:
            return f"{info.filename[:100]!a} is encrypted"
    return "" if ABOUT in names else f"it is not a sealed submission: {ABOUT} is missing"


def _is_name(text: str) -> bool:
    """Return True for a relative path that is valid on every file system."""
    return len(text) <= _LONGEST_NAME and _NAME.fullmatch(text) is not None


def _parts(name: str) -> list[str]:
    return name.split("/")


def _about(path: Path, archive: zipfile.ZipFile) -> About:
    if archive.getinfo(ABOUT).file_size > _ABOUT_BYTES:
        raise InputError(f"{path}: {ABOUT} is larger than {_ABOUT_BYTES // 10**6} MB")
    try:
        about = About.model_validate(parse_json(archive.read(ABOUT).decode()))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise InputError(f"{path}: {ABOUT}: {place}: {first['msg']}") from None
    except (ValueError, zipfile.BadZipFile, EOFError, ZlibError) as error:
        raise InputError(f"{path}: {ABOUT} is damaged: {error}") from None
    there = {i.filename for i in archive.infolist()} - {ABOUT}
    if there != set(about.files):
        raise InputError(f"{path}: the files are not those that {ABOUT} names")
    if about.planner.partition(":")[0] not in about.files:
        raise InputError(f"{path}: the planner {about.planner} is not in it")
    return about


def _info(name: str, *, executable: bool = False) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name, _EPOCH)
    mode = 0o755 if executable else 0o644
    info.create_system, info.external_attr = 3, (stat.S_IFREG | mode) << 16
    info.compress_type = zipfile.ZIP_DEFLATED
    return info


def _described(name: str, file: Path) -> SealedFile:
    if not _is_name(name) or name == ABOUT:
        raise InputError(
            f"{name[:100]!a} cannot be sealed: letters, digits and _ + - . @ ~ = , only"
        )
    try:
        with open_file(file) as source:
            digest = hashlib.sha256()
            while chunk := source.read(_CHUNK):
                digest.update(chunk)
            mode = stat.S_IMODE(Path(file).stat().st_mode)
            return SealedFile(
                sha256=digest.hexdigest(), size=source.tell(),
                executable=bool(mode & 0o100),
            )  # fmt: skip
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {reason_of(error)}") from None
