"""Encode readings of sensors that declare their own ROS message type."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import PluginError

_HEADER = "std_msgs/Header"
_WHOLE = ("int", "uint", "byte", "char")


def declared_encoder(info: SensorInfo, _: str) -> Callable[[int, Array], bytes]:
    """Return the encoder of a sensor that declares its message; its types are registered.

    Raises:
        PluginError: a definition is not one, or contradicts a type that is known.
    """
    declared = info.message
    assert declared is not None
    kind = info.ros_type
    try:
        ros.declare(declared.definitions)
    except ValueError as error:
        raise PluginError(f"the messages of sensor '{info.frame}': {error}") from error
    fields = ros.field_types(kind)
    if fields is None:
        raise PluginError(f"sensor '{info.frame}': there is no definition of {kind}")
    stamped = "header" if fields.get("header") == _HEADER else ""

    def message(ns: int, values: Array) -> bytes:
        # tf2 takes a stamp of 0 for "the latest".
        head = {stamped: ros.header(ns or 1, info.frame)} if stamped else {}
        found = {**head, **declared.fields(values)}
        try:
            return ros.to_cdr(message_from(kind, found))
        except (TypeError, ValueError, OverflowError, AttributeError) as error:
            raise PluginError(f"the message {kind} of sensor '{info.frame}': {error}") from error

    return message


def message_from(kind: str, found: Mapping[str, Any]) -> Any:
    """Return a message object.

    Args:
        kind: ROS type.
        found: every field by name; of nested messages mappings, or message objects.

    Raises:
        ValueError: fields are missing or unknown, or a value does not fit its field.
    """
    fields = ros.field_types(kind)
    if fields is None:
        raise ValueError(f"there is no definition of {kind}")
    if odd := [*(fields.keys() - found.keys()), *(found.keys() - fields.keys())]:
        raise ValueError(f"its fields are {', '.join(fields)}; missing or unknown: {sorted(odd)}")
    values = {name: _value(type_, found[name]) for name, type_ in fields.items()}
    return ros.message_type(kind)(**values)


def _value(kind: str, value: Any) -> Any:
    """Return a value as the type store wants it for a field of some type."""
    item, bracket, size = kind.partition("[")
    if not bracket:
        return _single(item, value)
    if item == "string" or "/" in item:
        return [_single(item, each) for each in value]
    array = np.ascontiguousarray(value, np.dtype(_NUMPY.get(item, item)))
    if size != "]" and array.size != int(size[:-1]):
        raise ValueError(f"{array.size} numbers where {kind} is wanted")
    return array.ravel()


#: Names of ROS that numpy has not.
_NUMPY = {"byte": "uint8", "char": "uint8", "bool": "bool"}


def _single(kind: str, value: Any) -> Any:
    if "/" in kind:
        return message_from(kind, value) if isinstance(value, Mapping) else value
    if kind.startswith(_WHOLE):
        return int(value)
    return {"bool": bool, "string": str}.get(kind, float)(value)
