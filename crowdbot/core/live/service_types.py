"""Service types: their hashes in ROS 2, and requests and responses as CDR.

Source of hashes: REP-2016; a service type consists of request, response and event.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from crowdbot.core.live.plain import json_array, to_plain
from crowdbot.core.live.services import Fields, Service, Values
from crowdbot.core.live.simulation_types import MESSAGES, PACKAGE
from crowdbot.errors import InputError

_EVENT = "service_msgs/msg/ServiceEventInfo"
_EVENT_TEXT = (
    "uint8 event_type\nbuiltin_interfaces/Time stamp\nuint8[16] client_gid\nint64 sequence_number"
)
_ZERO: dict[str, Any] = {"string": "", "wstring": "", "bool": False}


@cache
def _store() -> Any:
    """Return a separate store of Jazzy types, since services are registered in it."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types: dict[str, Any] = {}
    for name, text in MESSAGES.items():
        types.update(get_types_from_msg(text, f"{PACKAGE}/msg/{name}"))
    store.register(types)
    # A char is uint8 in the descriptions for hashes; rosbags treats it differently.
    store.fielddefs = {**store.fielddefs, **get_types_from_msg(_EVENT_TEXT, _EVENT)}
    return store


class ServiceType:
    """Message types of one service: request, response and event."""

    def __init__(self, kind: str, request: Fields, response: Fields) -> None:
        """Build the types. ``kind``: ``package/srv/Name``."""
        self.kind = kind
        store = _store()
        self._request, self._response = f"{kind}_Request", f"{kind}_Response"
        if kind in store.fielddefs:
            return
        for name, fields in ((self._request, request), (self._response, response)):
            text = "\n".join(f"{field_type} {field}" for field, field_type in fields.items())
            plain = name.replace("/srv/", "/msg/")
            store.register({name: get_types_from_msg(text, plain)[plain]})
        parts = {p: ((), [*_parts(kind, p)]) for p in (f"{kind}_Event", kind)}
        store.register(parts)

    @property
    def hash(self) -> str:
        """Return the hash with which ROS 2 identifies its version."""
        return f"RIHS01_{_store().hash_rihs01(self.kind).removeprefix('RIHS01_')}"

    def request(self, data: bytes) -> Values:
        """Return a request as plain values.

        Raises:
            InputError: it is not one.
        """
        try:
            message = _store().deserialize_cdr(data, self._request)
        except Exception as error:  # generated code with untrusted input
            raise InputError(f"the request does not fit the service {self.kind}") from error
        return to_plain(message, 2, json_array)

    def response(self, values: Mapping[str, Any]) -> bytes:
        """Encode plain values as a response; missing ones are 0 or empty."""
        return bytes(_store().serialize_cdr(_made(self._response, values), self._response))


def service_type(service: Service) -> ServiceType:
    """Return the message types of a service."""
    return ServiceType(service.kind, service.request, service.response)


def _parts(kind: str, which: str) -> Any:
    """Return the fields of the type for the service, or its event."""
    names = (f"{kind}_Request", f"{kind}_Response", f"{kind}_Event")
    if which == kind:
        fields = ("request_message", "response_message", "event_message")
        return [(f, (Nodetype.NAME, n)) for f, n in zip(fields, names, strict=True)]
    parts: list[Any] = [("info", (Nodetype.NAME, _EVENT))]
    for field, name in zip(("request", "response"), names, strict=False):
        parts.append((field, (Nodetype.SEQUENCE, ((Nodetype.NAME, name), 1))))
    return parts


def _made(msgtype: str, values: object) -> Any:
    """Return a message of a type from plain values."""
    given = values if isinstance(values, Mapping) else {}
    fields = {n: _value(d, given.get(n)) for n, d in _store().fielddefs[msgtype][1]}
    return _store().types[msgtype](**fields)


def _value(desc: Any, value: Any) -> Any:
    node, details = desc
    if node == Nodetype.NAME:
        return _made(details, value)
    if node == Nodetype.BASE:
        return _ZERO.get(details[0], 0) if value is None else value
    (inner, rest), size = details
    items = list(value or ())
    if inner == Nodetype.BASE and rest[0] not in ("string", "wstring"):
        kind = {"bool": "bool", "char": "uint8", "byte": "uint8", "octet": "uint8"}
        empty = [0] * size if node == Nodetype.ARRAY else []
        return np.array(items or empty, kind.get(rest[0], rest[0]))
    return [_value((inner, rest), item) for item in items]
