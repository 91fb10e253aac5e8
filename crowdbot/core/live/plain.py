"""Convert message objects to plain values with ROS 1 or ROS 2 names, for JSON and CBOR."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Ros = Literal[1, 2]
_TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_HEADER = "std_msgs/msg/Header"
#: Bytes of a single-precision number; powers of ten that float64 represents exactly.
_SINGLE, _EXACT = 4, 22


def to_plain(message: Any, ros: Ros, array: Callable[[NDArray[Any]], Any]) -> dict[str, Any]:
    """Return a message as nested dicts.

    Args:
        message: message of rosbags' type store.
        ros: version of the names of times: ``secs``, ``nsecs`` or ``sec``, ``nanosec``.
        array: conversion of an array of numbers.
    """
    kind = type(message)
    if message.__msgtype__ in _TIMES:
        names = ("secs", "nsecs") if ros == 1 else ("sec", "nanosec")
        return dict(zip(names, (message.sec, message.nanosec), strict=True))
    plain: dict[str, Any] = {"seq": 0} if ros == 1 and message.__msgtype__ == _HEADER else {}
    for name in _names(message.__msgtype__, kind):
        plain[name] = _value(getattr(message, name), ros, array)
    return plain


_KNOWN: dict[str, tuple[str, ...]] = {}


def _names(msgtype: str, kind: type[Any]) -> tuple[str, ...]:
    """Return the fields of a type."""
    names = _KNOWN.get(msgtype)
    if names is None:
        names = _KNOWN[msgtype] = tuple(f.name for f in fields(kind) if not f.name.startswith("_"))
    return names


def _value(value: Any, ros: Ros, array: Callable[[NDArray[Any]], Any]) -> Any:
    if isinstance(value, np.ndarray):
        return array(value)
    if isinstance(value, list):
        return [_value(item, ros, array) for item in value]
    if hasattr(value, "__msgtype__"):
        return to_plain(value, ros, array)
    if isinstance(value, float) and not math.isfinite(value):
        return None if array is json_array else value
    return value


def json_array(array: NDArray[Any]) -> list[Any]:
    """Return the numbers of an array; infinity and NaN, which JSON lacks, become None."""
    if array.dtype.kind != "f":
        return list(array.tolist())
    finite = np.isfinite(array).all()
    values: list[Any] = (_short(array) if array.dtype.itemsize == _SINGLE else array).tolist()
    return values if finite else [x if math.isfinite(x) else None for x in values]


def _short(array: NDArray[Any]) -> NDArray[np.float64]:
    """Round single-precision numbers to nine digits, which halves their text.

    An integer divided by a power of ten is rounded once, so its shortest text has no more digits;
    nine digits restore the same single-precision number.
    """
    wide = array.astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        power = 8.0 - np.floor(np.log10(np.abs(wide)))
        scale = np.power(10.0, power)
        short: NDArray[np.float64] = np.rint(wide * scale) / scale
    fits = np.isfinite(short) & (np.abs(power) <= _EXACT)
    return np.where(fits, short, wide)


def ros_type(msgtype: str, ros: Ros) -> str:
    """Return ``package/msg/Name`` in the spelling of ROS 1 or 2."""
    return msgtype.replace("/msg/", "/") if ros == 1 else msgtype
