"""Messages of a bag of ROS 1 or ROS 2, decoded."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from crowdbot.errors import InputError, UnknownNameError


class BagMessage(NamedTuple):
    """A message of a topic, and when it was recorded, ns since 1970."""

    topic: str
    log: int
    message: Any


def messages(path: Path, topics: set[str]) -> Iterator[BagMessage]:
    """Yield the messages of some topics in the order of their recording.

    Args:
        path: a bag of ROS 1 (``.bag``), a folder of rosbag2, or its ``.mcap`` or ``.db3`` file.
        topics: the topics' names.

    Raises:
        InputError: it cannot be read, or the layout of a message is unknown.
        UnknownNameError: there is no such topic.
    """
    with _opened(path) as reader:
        known = {c.topic for c in reader.connections}
        for topic in sorted(topics - known):
            raise UnknownNameError("topic", topic, known)
        chosen = [c for c in reader.connections if c.topic in topics]
        for connection in chosen:
            _check_layout(path, reader, connection)
        for connection, log, raw in _raw_messages(path, reader, chosen):
            yield BagMessage(connection.topic, log, _decoded(path, reader, connection, raw))


def topic_fields(path: Path) -> dict[str, set[str]]:
    """Return the topics of a bag -> the fields of their messages; empty where they are unknown.

    Raises:
        InputError: it cannot be read.
    """
    with _opened(path) as reader:
        known = reader.typestore.fielddefs
        layouts = {c.topic: known.get(c.msgtype, ((), ()))[1] for c in reader.connections}
        return {topic: {name for name, _ in layout} for topic, layout in layouts.items()}


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    from rosbags.highlevel import AnyReader

    from crowdbot.core.trajectories.bag.definitions import known_types

    if not path.exists():
        raise InputError(f"{path}: no such file")
    for database in sorted(path.glob("*.db3")) if path.is_dir() else [path]:
        _check_whole(database)
    types, parts = known_types(), _parts(path)
    with ExitStack() as stack:
        try:
            reader = stack.enter_context(AnyReader(parts, default_typestore=types))
        except Exception as error:  # a library on bytes that may be damaged anywhere
            raise _not_readable(path, error) from error
        if reader.is2:  # a bag may have definitions of some of its types
            own = reader.typestore.fielddefs
            reader.typestore.register(
                {name: fields for name, fields in types.fielddefs.items() if name not in own}
            )
        yield reader


def _raw_messages(path: Path, reader: Any, chosen: list[Any]) -> Iterator[tuple[Any, int, bytes]]:
    """Yield connections, times (ns) and bytes; only the library's errors are the bag's."""
    found = reader.messages(connections=chosen)
    while True:
        try:
            message = next(found, None)
        except Exception as error:  # as in `_opened`
            raise _not_readable(path, error) from error
        if message is None:
            return
        yield message


def _not_readable(path: Path, error: Exception) -> Exception:
    """Return the exception to raise for an error of the library."""
    if isinstance(error, MemoryError):
        return error
    text = " ".join((str(error) or type(error).__name__).split())
    return InputError(f"{path}: not a bag that can be read: {text}{_remedy(text)}")


def _parts(path: Path) -> list[Path]:
    """Return what the library opens: the bag, or the files of a folder without ``metadata.yaml``.

    The file is written at the end of a recording, so it is missing after a loss of power.
    """
    packed = path.suffix == ".zstd"
    if path.is_dir() and not (path / "metadata.yaml").exists():
        for suffix in (".mcap", ".db3", ".bag"):
            if found := sorted(path.glob(f"*{suffix}"), key=_in_order):
                return found
        packed = any(path.glob("*.zstd"))
        if not packed:
            raise InputError(f"{path}: a folder without metadata.yaml, .mcap, .db3 and .bag files")
    if packed:
        raise InputError(
            f"{path}: compressed as a whole, without the metadata.yaml that says so; unpack it "
            "with 'zstd -d FILE'"
        )
    return [path]


def _check_whole(part: Path) -> None:
    """Refuse a database that lacks its end: SQLite reads zeros where the last page is cut.

    Source: the database header, https://www.sqlite.org/fileformat.html.
    """
    with part.open("rb") as file:
        header = file.read(100)
    if len(header) < 100 or not header.startswith(b"SQLite format 3\0"):
        return
    size, written, pages, valid = struct.unpack(">16xH6xII60xI4x", header)
    whole = (65536 if size == 1 else size) * (pages if written == valid else 0)
    if (there := part.stat().st_size) < whole:
        raise InputError(
            f"{part}: cut off: {there} of {whole} bytes; 'sqlite3 FILE .recover | sqlite3 OUT' "
            "saves what is left"
        )


def _in_order(part: Path) -> tuple[int, str]:
    """Return the key by which part 10 of a recording comes after part 9."""
    number = re.search(r"(\d+)$", part.stem)
    return (int(number[1]) if number else -1), part.name


def index_hint(path: Path) -> str:
    """Return a hint if no message of a topic is found: MCAP is read by its index."""
    parts = path.glob("*.mcap") if path.is_dir() else [path]
    if not any(part.suffix == ".mcap" for part in parts):
        return ""
    return "; if it should, its index lacks them: 'mcap recover FILE -o OUT' writes a new one"


#: Part of a message -> what helps.
_REMEDIES = {
    "File end magic is invalid": "it was not closed; 'mcap recover FILE -o OUT' mends it",
    "no such column: offered_qos": "it is older than ROS 2 Foxy; 'ros2 bag convert' renews it",
    "image is malformed": "'sqlite3 FILE .recover | sqlite3 OUT' saves what is left",
    "end-of-stream marker": "a file is cut off",
    **dict.fromkeys(("'.zip'", "'.gz'", "'.tgz'", "'.xz'", "'.7z'", "'.tar'"), "unpack it first"),
    "database files are missing": "metadata.yaml names its files: rename them back, or remove it",
    "Profile is not ros2": "its messages are not those of ROS 2, or its writer did not say so: "
    "'ros2 bag convert' writes it again; JSON and Protobuf of Foxglove are not read",
    **dict.fromkeys(
        ("Invalid bag metadata", "Could not load YAML"),
        "without metadata.yaml the folder is read, too: remove it, or 'ros2 bag reindex FOLDER'",
    ),
}


def _remedy(text: str) -> str:
    return next((f" ({remedy})" for part, remedy in _REMEDIES.items() if part in text), "")


def _check_layout(path: Path, reader: Any, connection: Any) -> None:
    """Refuse a topic whose message type has no known definition."""
    if connection.msgtype in reader.typestore.fielddefs:
        return
    package = connection.msgtype.partition("/")[0]
    raise InputError(
        f"{path}: {connection.topic} holds {connection.msgtype}, a type that neither the bag nor "
        "crowdbot describes: sqlite3 bags of ROS 2 Humble and older store no definitions; where "
        f"{package} is installed, 'ros2 bag convert' to storage_id mcap adds them"
    )


def _decoded(path: Path, reader: Any, connection: Any, raw: bytes) -> Any:
    try:
        return reader.deserialize(raw, connection.msgtype)
    except MemoryError:
        raise
    except Exception as error:  # generated code, which may raise anything on bytes of another type
        raise InputError(
            f"{path}: {connection.topic}: a message is not the {connection.msgtype} that the bag "
            f"or crowdbot describes: {error}"
        ) from error
