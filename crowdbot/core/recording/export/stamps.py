"""Shift the times in messages, since tf2 treats a stamp of 0 as "the latest"."""

from __future__ import annotations

from functools import cache

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.template import stamp

_TF, _MARKERS = "tf2_msgs/msg/TFMessage", "visualization_msgs/msg/MarkerArray"
_HEAD = 4  # header bytes of a CDR message


def moved(data: bytes, msgtype: str, by: int) -> bytes:
    """Return a CDR message with stamps shifted by ``by`` ns; unchanged if it has none."""
    if not by:
        return data
    if msgtype in (_TF, _MARKERS):
        message = ros.from_cdr(data, msgtype)
        for item in message.transforms if msgtype == _TF else message.markers:
            now = _begun(item.header.stamp.sec, item.header.stamp.nanosec)
            item.header.stamp.sec, item.header.stamp.nanosec = divmod(now + by, 10**9)
        return ros.to_cdr(message)
    if not _begins_with_time(msgtype):
        return data
    sec = int.from_bytes(data[_HEAD : _HEAD + 4], "little", signed=True)
    rest = int.from_bytes(data[_HEAD + 4 : _HEAD + 8], "little")
    return data[:_HEAD] + stamp(_begun(sec, rest) + by) + data[_HEAD + 8 :]


def _begun(sec: int, rest: int) -> int:
    """Return a time in ns; recordings write one nanosecond instead of 0."""
    ns = sec * 10**9 + rest
    return 0 if ns == 1 else ns


@cache
def _begins_with_time(msgtype: str) -> bool:
    fields = ros.field_types(msgtype)
    first = next(iter(fields.values()), "") if fields else ""
    return first in ("std_msgs/Header", "builtin_interfaces/Time")
