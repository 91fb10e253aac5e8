"""The bundle's archive: equal content gives equal bytes; untrusted archives are checked."""

from __future__ import annotations

import hashlib
import os
import re
import stat
import struct
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from crowdbot.core.bundle.manifest import MANIFEST, Manifest, Member, parse_manifest
from crowdbot.core.support.atomic_write import atomic_path
from crowdbot.dsl.text.bounded_files import open_file, reason_of
from crowdbot.errors import InputError

#: Allowed files in a bundle: suffix -> largest size, bytes.
LIMITS: Mapping[str, int] = {
    ".json": 64 << 20,
    ".yaml": 4 << 20,
    ".csv": 64 << 20,
    ".mcap": 4 << 30,
    ".weights": 1 << 30,
}
_ALL_TEXTS = 2 << 30  # all members except recordings, which are stored uncompressed
_MOST = 100_000
_NAME = re.compile(r"(?:[A-Za-z0-9_+.:@~=,-]+/)*[A-Za-z0-9_+.:@~=,-]+")
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time in the format
_CHUNK = 1 << 20
#: End of an archive: a marker, 16 bytes of numbers, the length of a comment.
_END, _END_MARK = struct.Struct("<4s16xH"), b"PK\5\6"


# ------------------------------------------------------------------------- writing
def members_of(files: Mapping[str, Path | bytes]) -> dict[str, Member]:
    """Return hashes and sizes, by name.

    Raises:
        InputError: a file cannot be read, or is not allowed in a bundle.
    """
    return {name: _member(name, content) for name, content in sorted(files.items())}


def write_archive(path: Path, manifest: Manifest, files: Mapping[str, Path | bytes]) -> None:
    """Write an archive atomically; members are sorted and have no time stamps.

    Raises:
        InputError: the path cannot be written, or a file cannot be read.
    """
    with atomic_path(path) as part, zipfile.ZipFile(part, "w", strict_timestamps=True) as archive:
        _add(archive, MANIFEST, manifest.text().encode())
        for name in sorted(files):
            _add(archive, name, files[name])


def _add(archive: zipfile.ZipFile, name: str, content: Path | bytes) -> None:
    info = zipfile.ZipInfo(name, _EPOCH)
    info.create_system, info.external_attr = 3, 0o644 << 16
    recording = name.endswith(".mcap")
    info.compress_type = zipfile.ZIP_STORED if recording else zipfile.ZIP_DEFLATED
    with archive.open(info, "w", force_zip64=recording) as target:
        if isinstance(content, bytes):
            target.write(content)
            return
        with content.open("rb") as source:
            while chunk := source.read(_CHUNK):
                target.write(chunk)


def _member(name: str, content: Path | bytes) -> Member:
    problem = _name_problem(name)
    if problem:
        raise InputError(f"'{name}' cannot be bundled: {problem}")
    if isinstance(content, bytes):
        return Member(sha256=hashlib.sha256(content).hexdigest(), size=len(content))
    try:
        with content.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
            return Member(sha256=digest, size=file.tell())
    except OSError as error:
        raise InputError(f"{content}: cannot be read: {error.strerror}") from error


# ------------------------------------------------------------------------- reading
class Archive:
    """A bundle open for reading; members are unpacked on demand."""

    def __init__(self, path: Path, file: zipfile.ZipFile, manifest: Manifest) -> None:
        self.path, self.manifest, self._file = path, manifest, file
        self._infos = {i.filename: i for i in file.infolist()}

    @property
    def names(self) -> set[str]:
        """Return all members except the manifest."""
        return set(self._infos) - {MANIFEST}

    def read(self, name: str) -> bytes:
        """Return one member, checked against its hash.

        Raises:
            InputError: it is missing, damaged, or does not match the manifest.
        """
        with self._open(name) as file:
            return _checked(self.path, name, self.manifest, iter([file.read()]))

    def text(self, name: str) -> str:
        """Return one member as text.

        Raises:
            InputError: as `read`, or it is not UTF-8.
        """
        try:
            return self.read(name).decode()
        except UnicodeDecodeError:
            raise InputError(f"{self.path}: {name} is not UTF-8 text") from None

    def check(self, name: str) -> None:
        """Check one member against its hash, without holding it in memory.

        Raises:
            InputError: as `read`.
        """
        with self._open(name) as file:
            _checked(
                self.path, name, self.manifest, iter(lambda: file.read(_CHUNK), b""), keep=False
            )

    def unpack(self, name: str, target: Path) -> None:
        """Write one member to a file.

        Raises:
            InputError: as `read`.
        """
        self.check(name)
        with self._open(name) as file, target.open("wb") as out:
            while chunk := file.read(_CHUNK):
                out.write(chunk)

    @contextmanager
    def _open(self, name: str) -> Iterator[IO[bytes]]:
        if name not in self._infos:
            raise InputError(f"{self.path}: {name} is missing")
        try:
            with self._file.open(self._infos[name]) as file:
                yield file
        except (zipfile.BadZipFile, NotImplementedError, EOFError, _zlib_error()) as error:
            raise InputError(f"{self.path}: {name} is damaged: {error}") from None


def open_zip(path: Path, description: str) -> zipfile.ZipFile:
    """Open a zip file; error messages name it ``description``.

    Raises:
        InputError: missing file, or not a zip file.
    """
    try:
        open_file(path).close()
        return zipfile.ZipFile(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {reason_of(error)}") from None
    except (zipfile.BadZipFile, NotImplementedError, ValueError) as error:
        raise InputError(f"{path} is not {description}: {error}") from None


@contextmanager
def open_archive(path: Path) -> Iterator[Archive]:
    """Open a bundle; names, sizes and the manifest are checked before anything else.

    Raises:
        InputError: missing file, not a bundle, or not written by crowdbot.
    """
    with open_zip(path, "a bundle") as file:
        _check_bounds(path, file)
        _check_listing(path, file)
        try:
            text = file.read(MANIFEST).decode()
        except (zipfile.BadZipFile, UnicodeDecodeError, EOFError, _zlib_error()) as error:
            raise InputError(f"{path}: {MANIFEST} is damaged: {error}") from None
        try:
            yield Archive(path, file, parse_manifest(text))
        except InputError as error:
            if str(path) in str(error):
                raise
            raise InputError(f"{path}: {error}") from None


def _check_bounds(path: Path, file: zipfile.ZipFile) -> None:
    """Refuse bytes before and after the archive, in which other programs may see another file."""
    first = min((i.header_offset for i in file.infolist()), default=0)
    with path.open("rb") as content:
        content.seek(-_END.size, os.SEEK_END)
        mark, comment = _END.unpack(content.read(_END.size))
    if first > 0:
        raise InputError(f"{path}: {first} bytes stand before the archive; a bundle has none")
    if mark != _END_MARK or comment:
        raise InputError(f"{path}: there is something after the archive; a bundle ends with it")


def _check_listing(path: Path, file: zipfile.ZipFile) -> None:
    """Refuse members that could fill a disk or memory, or lead out of a folder."""
    infos = file.infolist()
    if len(infos) > _MOST:
        raise InputError(f"{path}: {len(infos)} members; a bundle has at most {_MOST}")
    seen: set[str] = set()
    for info in infos:
        problem = _name_problem(info.filename) or _info_problem(info)
        if info.filename in seen:
            problem = "there twice"
        if problem:
            raise InputError(f"{path}: member '{info.filename}' is not allowed: {problem}")
        seen.add(info.filename)
    if sum(i.file_size for i in infos if not i.filename.endswith(".mcap")) > _ALL_TEXTS:
        raise InputError(f"{path}: more than {_ALL_TEXTS >> 20} MB when unpacked")
    if MANIFEST not in seen:
        raise InputError(f"{path} is not a bundle: {MANIFEST} is missing")


def _name_problem(name: str) -> str:
    if name.startswith("/") or "\\" in name or ".." in name.split("/") or "." in name.split("/"):
        return "it leads out of the folder"
    if not _NAME.fullmatch(name):
        return "its name has other characters than letters, digits and _ + - . : @ ~ = ,"
    if Path(name).suffix not in LIMITS:
        return f"only {', '.join(LIMITS)} belong into a bundle"
    return ""


def _info_problem(info: zipfile.ZipInfo) -> str:
    kind = stat.S_IFMT(info.external_attr >> 16)
    suffix = Path(info.filename).suffix
    if kind not in (0, stat.S_IFREG):
        return "it is not a plain file"
    if info.flag_bits & 0x1:
        return "it is encrypted"
    if info.file_size > LIMITS[suffix]:
        return f"{info.file_size} bytes; {suffix} may have {LIMITS[suffix]}"
    if suffix == ".mcap" and info.compress_type != zipfile.ZIP_STORED:
        return "recordings are stored, not compressed again"
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        return "its compression is not deflate"
    return ""


def _checked(
    path: Path, name: str, manifest: Manifest, chunks: Iterator[bytes], *, keep: bool = True
) -> bytes:
    digest, parts, size = hashlib.sha256(), [], 0
    for chunk in chunks:
        digest.update(chunk)
        size += len(chunk)
        parts += [chunk] * keep
    expected = manifest.members.get(name)
    if expected is None:
        raise InputError(f"{path}: {name} is not in the manifest")
    if (digest.hexdigest(), size) != (expected.sha256, expected.size):
        raise InputError(f"{path}: {name} is not what the manifest says; it was changed")
    return b"".join(parts)


def _zlib_error() -> type[Exception]:
    import zlib

    return zlib.error
