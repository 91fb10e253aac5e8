"""The server of the person's page: who is let in, who drives, and what hostile pages achieve."""

from __future__ import annotations

import http.client
import json

import pytest
from websockets.exceptions import InvalidStatus

from tests.core.live.person.page_cases import hear, opened, paged, say, until

PAGE = "<!doctype html><p>ä page"


def fetched(port: int, path: str, **headers: str) -> tuple[int, str, dict[str, str]]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("GET", path, headers={k.replace("_", "-"): v for k, v in headers.items()})
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    return answer.status, text, {k.lower(): v for k, v in answer.getheaders()}


def test_the_page_is_served_with_its_token_only() -> None:
    with paged(PAGE) as (server, _):
        path = server.url.partition(str(server.port))[2]
        status, text, headers = fetched(server.port, path)
        assert (status, text) == (200, PAGE)
        assert headers["x-frame-options"] == "DENY"
        assert headers["cache-control"] == "no-store"
        for wrong in ("/", "/?token=", "/?token=x", f"/?token={server.token}x"):
            assert fetched(server.port, wrong)[0] == 401
        assert fetched(server.port, f"/other?token={server.token}")[0] == 404


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "evil.example"},
        {"Host": "evil.example:80"},
        {"Origin": "https://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:1"},  # a page of this machine, but not ours
        {"Origin": "http://localhost"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
    ],
)
def test_other_origins_neither_read_nor_connect(headers: dict[str, str]) -> None:
    with paged(PAGE) as (server, seat):
        status, text, _ = fetched(server.port, f"/?token={server.token}", **headers)
        assert status == 403
        assert "ä" not in text
        with pytest.raises(InvalidStatus), opened(server, additional_headers=headers):
            pass
        assert not seat.taken


def test_its_own_page_connects() -> None:
    with paged() as (server, seat), opened(server, origin=f"http://127.0.0.1:{server.port}"):
        until(lambda: seat.taken)


def test_two_pages_one_drives_the_other_watches_until_the_seat_is_free() -> None:
    with paged() as (server, seat):
        with opened(server) as first:
            assert hear(first, "role") == {"op": "role", "drives": True, "taken": True}
            with opened(server) as second:
                assert hear(second, "role")["drives"] is False
                say(second, "stick", n=1, ahead=1.0)
                assert hear(second, "role")["drives"] is False
                say(first, "here", away="")
                say(first, "stick", n=1, ahead=0.5)
                until(lambda: seat.take(0.0).number == 1)  # type: ignore[union-attr]
                assert hear(first, "taken")["n"] == hear(second, "taken")["n"] == 1
                first.close()
                while hear(second, "state")["taken"]:
                    pass
                say(second, "sit")
                assert hear(second, "role")["drives"] is True
        assert seat.session.counts.refused == 1


def test_a_reload_takes_the_seat_again_and_gets_the_picture() -> None:
    with paged() as (server, _):
        server.show_scene({"walls": []})
        server.show_frame({"t": 1.0})
        server.show_frame({"t": 2.0})
        for _ in range(2):
            with opened(server) as page:
                assert hear(page, "role")["drives"] is True
                assert hear(page, "scene")["scene"] == {"walls": []}
                assert hear(page, "frame")["t"] == 2.0
            until(lambda: not server._clients)


@pytest.mark.parametrize(
    "frame",
    [
        "", "[]", "{}", '{"op": []}', '{"op": "stick"}', '{"op": "stick", "n": 1e400}',
        '{"op": "here", "away": "x"}', '{"op": "ping"}', '{"op": "latency", "ms": [1e99]}',
        '{"op": "latency", "ms": 3}', "[" * 9999, b"\xff\xfe",
    ],
)  # fmt: skip
def test_hostile_messages_change_nothing(frame: str | bytes) -> None:
    with paged() as (server, seat), opened(server) as page:
        page.send(frame)
        assert hear(page, "error")["text"]
        say(page, "ping", at=7)
        assert hear(page, "pong")["at"] == 7
        assert (seat.take(0.0).number, seat.log.latencies) == (0, [])  # type: ignore[union-attr]


def test_a_flood_is_dropped() -> None:
    with paged() as (server, seat), opened(server) as page:
        say(page, "here", away="")
        for n in range(1, 3000):
            page.send(json.dumps({"op": "stick", "n": n, "ahead": 1.0}))
        until(lambda: seat.take(0.0).number > 400)  # type: ignore[union-attr]
        assert seat.take(0.0).number < 3000  # type: ignore[union-attr]
