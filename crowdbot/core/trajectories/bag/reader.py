"""Messages of a bag of ROS 1 or ROS 2, decoded."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
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
        for connection, log, raw in reader.messages(connections=chosen):
            yield BagMessage(connection.topic, log, _decoded(path, reader, connection, raw))


def topic_fields(path: Path) -> dict[str, set[str]]:
    """Return the topics of a bag -> the fields of their messages; empty where nothing says them.

    Raises:
        InputError: it cannot be read.
    """
    with _opened(path) as reader:
        known = reader.typestore.fielddefs
        layouts = {c.topic: known.get(c.msgtype, ((), ()))[1] for c in reader.connections}
        return {topic: {name for name, _ in layout} for topic, layout in layouts.items()}


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    from rosbags.highlevel import AnyReader, AnyReaderError

    from crowdbot.core.trajectories.bag.definitions import known_types

    if not path.exists():
        raise InputError(f"{path}: no such file")
    types = known_types()
    try:
        with AnyReader([path], default_typestore=types) as reader:
            if reader.is2:  # a bag may have definitions of some of its types
                own = reader.typestore.fielddefs
                reader.typestore.register(
                    {name: fields for name, fields in types.fielddefs.items() if name not in own}
                )
            yield reader
    except (AnyReaderError, FileNotFoundError) as error:
        raise InputError(f"{path}: not a bag that can be read: {error}") from error


def _check_layout(path: Path, reader: Any, connection: Any) -> None:
    """Refuse a topic whose messages nothing describes."""
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
    except Exception as error:  # generated code, which may raise anything on bytes of another type
        raise InputError(
            f"{path}: {connection.topic}: a message is not the {connection.msgtype} that the bag "
            f"or crowdbot describes: {error}"
        ) from error
