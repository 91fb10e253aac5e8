"""Services of ROS 2 over zenoh: keys, type hashes, attachments, answers."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.ros2_keys import SERVER, Ros2Topic, attachment, read_attachment
from crowdbot.core.live.service_types import ServiceType, service_type
from crowdbot.core.live.services import services
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.simulation_interfaces import simulation_services
from crowdbot.core.live.simulation_types import PACKAGE, SERVICES
from crowdbot.errors import InputError
from tests.core.live.test_zenoh_connection import _both

#: As the generators of ROS 2 print them; simulation_interfaces is of 2.1.0.
PUBLISHED = {
    "std_srvs/srv/Trigger": "eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f",
    f"{PACKAGE}/srv/ResetSimulation": (
        "4ce285d7ff9b8ac70dcc95161f32bf54c05a6f4b13427990e41ab40c36c39646"
    ),
    f"{PACKAGE}/srv/StepSimulation": (
        "913fe0653690ce6bf8f09f316e6a626747012e9fca31e26719910d417aa8565c"
    ),
    f"{PACKAGE}/srv/GetEntities": (
        "cb90004c48cd50f37732fb008e22c34c261dd680a723bf0f85d8437ea4498bf7"
    ),
    f"{PACKAGE}/srv/GetAvailableWorlds": (
        "ce5589b5523f2732d1969a3c5a7e6b17a387091df8190c62f78d7fdd1109e3e3"
    ),
    f"{PACKAGE}/srv/LoadWorld": (
        "87d0ded1bfddb40a74d0bedb963fdd592fbedb14d0057d597850404b73c338af"
    ),
    f"{PACKAGE}/srv/SpawnEntity": (
        "66860313e11009faddbfc8568e5d410d1a11607fe75eeb1308671dc0406fe3a7"
    ),
}


def _all(session: LiveSession) -> dict[str, Any]:
    return {**services(session), **simulation_services(session)}


def test_hashes_are_those_that_are_published() -> None:
    found = {s.kind: service_type(s).hash for s in _all(LiveSession()).values()}
    for kind, text in PUBLISHED.items():
        assert found[kind] == f"RIHS01_{text}"


@pytest.mark.parametrize("name", SERVICES)
def test_an_empty_response_is_one(name: str) -> None:
    types = ServiceType(f"{PACKAGE}/srv/{name}", *SERVICES[name])
    assert types.response({})[:4] == b"\0\1\0\0"


@given(st.binary(max_size=64))
def test_any_bytes_are_a_request_or_refused(data: bytes) -> None:
    types = ServiceType(f"{PACKAGE}/srv/GetEntities", *SERVICES["GetEntities"])
    with suppress(InputError):
        assert set(types.request(data)) == {"filters"}


def test_attachments_have_33_bytes() -> None:
    data = attachment(7, 8, bytes(range(16)))
    assert len(data) == 33
    assert read_attachment(data) == (7, bytes(range(16)))
    assert read_attachment(data[:-1]) is None


def _ask(other: Any, service: Any, name: str, data: bytes, attached: bytes | None) -> Any:
    types = service_type(service)
    key = Ros2Topic(name, service.kind, types.hash).key(0)
    (reply,) = list(other.get(key, payload=data, attachment=attached, timeout=60.0))
    return reply


def test_a_client_of_ros_2_gets_its_answer() -> None:
    session = LiveSession(scenarios=["one", "two"], robots={"": LiveRobot("robot")})
    offered = _all(session)
    with _both(services=offered) as (_, _, other):
        who = attachment(41, 5, b"g" * 16)
        empty = b"\0\1\0\0\0"
        reply = _ask(other, offered["/crowdbot/pause"], "/crowdbot/pause", empty, who)
        assert reply.ok.payload.to_bytes()[4] == 1
        assert read_attachment(reply.ok.attachment.to_bytes()) == (41, b"g" * 16)
        assert session.paused
        name = "/get_available_worlds"
        types = service_type(offered[name])
        request = b"\0\1\0\0" + bytes(11)
        reply = _ask(other, offered[name], name, request, who)
        assert b"two\0" in reply.ok.payload.to_bytes()
        assert types.request(request)["offline_only"] is False
        lost = _ask(other, offered[name], name, request, None)
        assert b"33 bytes" in lost.err.payload.to_bytes()
        bad = _ask(other, offered[name], name, b"\0", who)
        assert b"does not fit" in bad.err.payload.to_bytes()
        tokens = [str(r.ok.key_expr) for r in other.liveliness().get("@ros2_lv/**")]
        served = [t for t in tokens if f"/{SERVER}/" in t]
        assert len(served) == len(offered)
        assert any("%load_world/simulation_interfaces::srv::dds_::LoadWorld_" in t for t in served)


def test_humble_has_no_hashes() -> None:
    from crowdbot.core.live.ros2_keys import service_hash_in

    assert service_hash_in("RIHS01_x", "humble") == "TypeHashNotSupported"
    assert service_hash_in("RIHS01_x", "jazzy") == "RIHS01_x"
