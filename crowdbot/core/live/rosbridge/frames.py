"""Frames of the rosbridge protocol: limits for incoming frames, formats of outgoing ones."""

from __future__ import annotations

import json
import sys
from typing import Any, Literal

from numpy.typing import NDArray

from crowdbot.core.live.message import LiveMessage
from crowdbot.core.live.plain import Ros, json_array, to_plain
from crowdbot.core.live.rosbridge.bad_frame import BadFrame
from crowdbot.core.live.rosbridge.cbor_frames import read_cbor

Form = Literal["none", "cbor", "cbor-raw"]
Frame = str | bytes
#: Tags of typed arrays in CBOR (RFC 8746), little-endian, by numpy's kind and size.
_TAGS = {"u1": 64, "i1": 72, "u2": 69, "u4": 70, "u8": 71, "i2": 77, "i4": 78, "i8": 79,
         "f4": 85, "f8": 86}  # fmt: skip


def parse(frame: Frame) -> dict[str, Any]:
    """Parse an external message.

    Raises:
        BadFrame: it is not one: neither JSON (text) nor CBOR (binary), or without ``op``.
    """
    try:
        message = json.loads(frame) if isinstance(frame, str) else read_cbor(frame)
    except BadFrame:
        raise
    except Exception as error:  # third-party decoders with untrusted input
        raise BadFrame(f"not a message: {type(error).__name__}") from None
    if not isinstance(message, dict) or not isinstance(message.get("op"), str):
        raise BadFrame("a message is an object with 'op'")
    return message


def encoded(message: LiveMessage, form: Form, ros: Ros) -> Frame:
    """Return ``publish`` of a message as one frame."""
    if form == "none":
        plain = to_plain(message.fields, ros, json_array)
        head = json.dumps(message.topic)
        return f'{{"op": "publish", "topic": {head}, "msg": {json.dumps(plain, allow_nan=False)}}}'
    import cbor2

    data: bytes
    if form == "cbor-raw":
        time = dict(zip(("secs", "nsecs"), divmod(message.ns, 10**9), strict=True))
        body: Any = {**time, "bytes": message.data if ros == 2 else _ros1_bytes(message)}
    else:
        body = to_plain(message.fields, ros, _typed_array)
    data = cbor2.dumps({"op": "publish", "topic": message.topic, "msg": body})
    return data


def _typed_array(array: NDArray[Any]) -> Any:
    import cbor2

    if array.dtype.kind == "b":
        return array.tolist()
    kind = f"{array.dtype.kind}{array.dtype.itemsize}"
    data = array.tobytes() if sys.byteorder == "little" else array.byteswap().tobytes()
    return data if kind == "u1" else cbor2.CBORTag(_TAGS[kind], data)


def _ros1_bytes(message: LiveMessage) -> bytes:
    from crowdbot.core.recording.messages import to_ros1

    return to_ros1(message.data, message.msgtype)
