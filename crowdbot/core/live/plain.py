"""Message objects as plain values, in the words of ROS 1 or ROS 2, for JSON and CBOR."""

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
#: Bytes of a number of single precision; powers of ten up to which float64 has them exactly.
_SINGLE, _EXACT = 4, 22


def to_plain(message: Any, ros: Ros, array: Callable[[NDArray[Any]], Any]) -> dict[str, Any]:
    """A message as nested dicts.

    Args:
        message: of rosbags' type store.
        ros: whose names times have: ``secs``, ``nsecs`` or ``sec``, ``nanosec``.
        array: what becomes of an array of numbers.
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
    """The fields of a type."""
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
    """Numbers of an array; JSON has no infinity and no NaN, which become None."""
    if array.dtype.kind != "f":
        return list(array.tolist())
    finite = np.isfinite(array).all()
    values: list[Any] = (_short(array) if array.dtype.itemsize == _SINGLE else array).tolist()
    return values if finite else [x if math.isfinite(x) else None for x in values]


def _short(array: NDArray[Any]) -> NDArray[np.float64]:
    """Single precision as the numbers of nine digits that stand for it: half as long as text.

    A whole number over a power of ten is rounded once, so that its shortest text has no more
    digits; nine of them are enough to get the same number of single precision back.
    """
    wide = array.astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        power = 8.0 - np.floor(np.log10(np.abs(wide)))
        scale = np.power(10.0, power)
        short: NDArray[np.float64] = np.rint(wide * scale) / scale
    fits = np.isfinite(short) & (np.abs(power) <= _EXACT)
    return np.where(fits, short, wide)


def ros_type(msgtype: str, ros: Ros) -> str:
    """``package/msg/Name`` as ROS 1 or 2 spell it."""
    return msgtype.replace("/msg/", "/") if ros == 1 else msgtype
