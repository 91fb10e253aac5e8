"""ROS 2 names on zenoh (rmw_zenoh): keys of data, liveliness tokens, attachments.

Source: the design document of rmw_zenoh, https://github.com/ros2/rmw_zenoh.
"""

from __future__ import annotations

import hashlib
import struct
from dataclasses import dataclass
from functools import cache
from typing import Literal

from rosbags.typesys import Stores, get_typestore

from crowdbot.core.recording import messages as ros

Distro = Literal["humble", "jazzy", "kilted", "lyrical"]
#: Kinds of entities in tokens: node, publisher, subscription, service server.
NODE, PUBLISHER, SUBSCRIPTION, SERVER = "NN", "MP", "MS", "SS"
#: Humble has no type hashes.
_NO_HASH = "TypeHashNotSupported"
#: Reliable, keep last; depth 10 and volatile, or depth 1 and transient local.
_QOS, _LATCHED_QOS = "::,10:,:,:,,", ":1:,1:,:,:,,"
_ATTACHMENT = struct.Struct("<qqB16s")


@dataclass(frozen=True, slots=True)
class Ros2Topic:
    """A topic in ROS 2; ``hash`` depends on the distribution."""

    name: str
    msgtype: str
    hash: str
    latched: bool = False

    @property
    def dds_type(self) -> str:
        """Return ``package::msg::dds_::Name_``, or ``package::srv::dds_::Name_`` for a service."""
        package, kind, name = self.msgtype.split("/")
        return f"{package}::{kind}::dds_::{name}_"

    def key(self, domain: int) -> str:
        """Return the zenoh key of the topic's messages."""
        return f"{domain}/{self.name.strip('/')}/{self.dds_type}/{self.hash}"

    def token(self, domain: int, session: str, entity: int, kind: str, node: str) -> str:
        """Return the liveliness token of a publisher or subscriber of the topic."""
        mangled = self.name.replace("/", "%")
        qos = _LATCHED_QOS if self.latched else _QOS
        return (
            f"@ros2_lv/{domain}/{session}/0/{entity}/{kind}/%/%/{node}/"
            f"{mangled}/{self.dds_type}/{self.hash}/{qos}"
        )


def node_token(domain: int, session: str, node: str) -> str:
    """Return the liveliness token of a node."""
    return f"@ros2_lv/{domain}/{session}/0/0/{NODE}/%/%/{node}"


def drivers_of(domain: int, name: str) -> str:
    """Return the pattern of the liveliness tokens of a topic's publishers."""
    return f"@ros2_lv/{domain}/*/*/*/{PUBLISHER}/*/*/*/{name.replace('/', '%')}/**"


def read_attachment(data: bytes) -> tuple[int, bytes] | None:
    """Return number and sender of a request; None if the bytes are not an attachment."""
    if len(data) != _ATTACHMENT.size:
        return None
    sequence, _, size, gid = _ATTACHMENT.unpack(data)
    return (sequence, gid) if size == len(gid) else None


def attachment(sequence: int, time_ns: int, gid: bytes) -> bytes:
    """Return what rmw_zenoh attaches to each message: sequence number, time, sender; 33 bytes."""
    return _ATTACHMENT.pack(sequence, time_ns, len(gid), gid)


def gid_of(token: str) -> bytes:
    """Return 16 bytes that identify a publisher."""
    return hashlib.blake2b(token.encode(), digest_size=16).digest()


def service_hash_in(text: str, distro: Distro) -> str:
    """Return the hash of a service in a distribution."""
    return _NO_HASH if distro == "humble" else text


@cache
def hash_in(msgtype: str, distro: Distro) -> str:
    """Return the hash of a type in a distribution."""
    if distro == "humble":
        return _NO_HASH
    if msgtype in _changed(distro):
        text = get_typestore(Stores(f"ros2_{distro}")).hash_rihs01(msgtype)
        return f"RIHS01_{text.removeprefix('RIHS01_')}"
    return ros.type_hash(msgtype)


def in_distro(data: bytes, msgtype: str, distro: Distro) -> bytes:
    """Return a message's bytes for a ROS distribution, with fields added since Humble as zeros."""
    if distro == "humble" or msgtype not in _changed(distro):
        return data
    store = get_typestore(Stores(f"ros2_{distro}"))
    old = ros.from_cdr(data, msgtype)
    names = [name for name, _ in store.fielddefs[msgtype][1]]
    values = {name: getattr(old, name, 0.0) for name in names}
    return bytes(store.serialize_cdr(store.types[msgtype](**values), msgtype))


@cache
def _changed(distro: Distro) -> frozenset[str]:
    """Return our types whose definition differs from that of Humble, which recordings use."""
    store, mine = get_typestore(Stores(f"ros2_{distro}")), ros.ros2_store()
    known = set(store.types) & set(mine.types)
    return frozenset(t for t in known if store.fielddefs[t][1] != mine.fielddefs[t][1])
