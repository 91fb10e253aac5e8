"""Message types of a recording: rosbags' types for ROS 2 Humble, and crowdbot's own.

rosbags serialises. Messages are plain objects of its type store; `new` builds one by name.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

from crowdbot.core.recording.definitions import DEFINITIONS, LIVE_DEFINITIONS


@cache
def _store() -> Any:
    store = get_typestore(Stores.ROS2_HUMBLE)
    types: dict[str, Any] = {}
    for name, text in {**DEFINITIONS, **LIVE_DEFINITIONS}.items():
        types.update(get_types_from_msg(text, f"crowdbot_msgs/msg/{name}"))
    store.register(types)
    return store


def ros2_store() -> Any:
    """Return the types of a recording, for rosbags."""
    return _store()


@cache
def ros1_store() -> Any:
    """Return the types of ROS 1 noetic, and crowdbot's."""
    store = get_typestore(Stores.ROS1_NOETIC)
    types: dict[str, Any] = {}
    for name, text in DEFINITIONS.items():
        types.update(get_types_from_msg(text, f"crowdbot_msgs/msg/{name}"))
    store.register(types)
    return store


def declare(definitions: Mapping[str, str]) -> None:
    """Add types that no ROS distribution has, such as those of a plugin's sensor.

    Args:
        definitions: ``package/msg/Name`` -> text as in a .msg file, perhaps with the types that it
            is made of below it, as MCAP's ``ros2msg`` encoding has them.

    Raises:
        ValueError: a text is not a definition, names a type that nothing defines, or contradicts
            what is known of its type.
    """
    name = ""
    try:
        for name, text in definitions.items():
            types = get_types_from_msg(text, name)
            _store().register(types)
            known = ros1_store().fielddefs  # a header of ROS 1 has one field more
            ros1_store().register({n: t for n, t in types.items() if n not in known})
        for name in definitions:
            _store().generate_msgdef(name, ros_version=2)
    except TypesysError as error:
        raise ValueError(f"the definition of {name}: {error}") from error


def new(kind: str, **fields: Any) -> Any:
    """Return a message of type ``package/Name``."""
    return message_class(kind)(**fields)


@cache
def message_class(kind: str) -> Any:
    """Return the class of messages of type ``package/Name``."""
    package, _, name = kind.partition("/")
    return _store().types[f"{package}/msg/{name}"]


def definition(msgtype: str) -> bytes:
    """Return the definition of a type and its parts, for MCAP's ``ros2msg`` encoding."""
    return str(_store().generate_msgdef(msgtype, ros_version=2)[0]).encode()


def message_type(msgtype: str) -> Any:
    """Return the class of a type, given as ``package/Name`` or ``package/msg/Name``.

    Raises:
        KeyError: there is no such type.
    """
    package, _, name = msgtype.replace("/msg/", "/").partition("/")
    return _store().types[f"{package}/msg/{name}"]


def field_types(msgtype: str) -> dict[str, str] | None:
    """Return field -> type, such as ``float32[]`` or ``std_msgs/Header``; None if unknown."""
    package, _, name = msgtype.replace("/msg/", "/").partition("/")
    found = _store().fielddefs.get(f"{package}/msg/{name}")
    if found is None:
        return None
    return {field: _field_type(*kind) for field, kind in found[1]}


def _field_type(node: Any, details: Any) -> str:
    if node.name == "NAME":
        return str(details).replace("/msg/", "/")
    if node.name == "BASE":
        return str(details[0])
    (inner, size) = details
    return f"{_field_type(*inner)}[{size if node.name == 'ARRAY' else ''}]"


def definition_text(msgtype: str, ros_version: int) -> str:
    """Return the definition of a type and its parts for ROS 1 or ROS 2."""
    package, _, name = msgtype.replace("/msg/", "/").partition("/")
    full = f"{package}/msg/{name}"
    return str(_store().generate_msgdef(full, ros_version=ros_version)[0])


def type_hash(msgtype: str) -> str:
    """Return the ROS 2 hash of a type's version: ``RIHS01_`` and 64 hex digits."""
    return f"RIHS01_{_store().hash_rihs01(msgtype).removeprefix('RIHS01_')}"


def to_cdr(message: Any) -> bytes:
    """Serialise as little-endian CDR with its four byte header."""
    return bytes(_store().serialize_cdr(message, message.__msgtype__))


def to_ros1(data: bytes, msgtype: str) -> bytes:
    """Convert CDR to the same message in ROS 1, also for ``crowdbot_msgs``."""
    return bytes(_store().cdr_to_ros1(data, msgtype))


def from_cdr(data: bytes, msgtype: str) -> Any:
    """Deserialise; any exception of the decoder is passed on."""
    return _store().deserialize_cdr(data, msgtype)
