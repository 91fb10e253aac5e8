"""The editor's server: this machine, its token, one writer at a time."""

from __future__ import annotations

import http.client
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.editor.desk import ConflictError, Desk
from crowdbot.core.editor.document import NEW
from crowdbot.core.editor.server import TOKEN, Server
from crowdbot.core.registry.registry import discover
from crowdbot.errors import UsageError
from tests.paths import DATA

_ROBOT = (DATA / "short_way.yaml").read_text()


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    found = Server(Desk(tmp_path / "new.yaml", discover()))
    thread = threading.Thread(target=found.run, daemon=True)
    thread.start()
    yield found
    found.close()
    thread.join()


def _ask(
    server: Server, path: str, content: Any = None, **headers: str
) -> tuple[int, dict[str, Any]]:
    link = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    given = {TOKEN: server.token, **{name.replace("_", "-"): v for name, v in headers.items()}}
    body = None if content is None else json.dumps(content)
    link.request("GET" if content is None else "POST", path, body, given)
    reply = link.getresponse()
    text = reply.read().decode()
    link.close()
    return reply.status, json.loads(text) if text.startswith("{") else {"page": text}


def test_the_page_needs_the_token(server: Server) -> None:
    assert _ask(server, "/")[0] == 403
    assert _ask(server, "/?token=guess")[0] == 403
    status, found = _ask(server, f"/?token={server.token}")
    assert (status, "</svg>" in found["page"]) == (200, True)
    assert _ask(server, f"/other?token={server.token}")[0] == 404


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "https://evil.example"},
        {"Host": "evil.example"},
        {TOKEN.replace("-", "_"): "guess"},
        {"Origin": "null"},
    ],
)
def test_other_websites_and_names_are_refused(server: Server, headers: dict[str, str]) -> None:
    status, found = _ask(server, "/open", {}, **headers)
    assert status == 403
    assert found["error"]


def test_own_page_opens_changes_checks_and_saves(server: Server, tmp_path: Path) -> None:
    origin = {"Origin": f"http://127.0.0.1:{server.port}"}
    _, found = _ask(server, "/open", {}, **origin)
    assert (found["hash"], found["errors"]) == ("new", [])
    wall = {"path": ["scenario", "environment", "walls", "a"],
            "value": {"start": [5.0, 0.0], "end": [5.0, 4.0]}}  # fmt: skip
    status, made = _ask(server, "/change", {"text": found["text"], "changes": [wall]}, **origin)
    assert (status, made["errors"]) == (200, [])
    assert len(made["walls"]) > 4
    status, saved = _ask(server, "/save", {"text": made["text"], "hash": "new"}, **origin)
    assert status == 200
    assert (tmp_path / "new.yaml").read_text() == made["text"]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["new.yaml"]
    (tmp_path / "new.yaml").write_text(NEW.format(name="theirs"))
    again = {"text": made["text"], "hash": saved["hash"]}
    assert _ask(server, "/save", again)[0] == 409
    assert "theirs" in (tmp_path / "new.yaml").read_text()
    assert _ask(server, "/save", {**again, "anyway": True})[0] == 200
    assert (tmp_path / "new.yaml").read_text() == made["text"]


@pytest.mark.parametrize(
    ("path", "content"),
    [
        ("/change", {"text": "a: ["}),
        ("/change", {"text": "a: 1", "changes": [{"path": ["a", "b"], "value": 1}]}),
        ("/change", {"text": "a: [", "changes": []}),
        ("/check", []),
        ("/check", {"text": 5}),
        ("/play", {"text": "crowdbot: 1"}),
        ("/save", {}),
    ],
)
def test_bad_requests_are_errors(server: Server, path: str, content: Any) -> None:
    status, found = _ask(server, path, content)
    assert status == 400
    assert found["error"]
    assert _ask(server, "/nothing", {})[0] == 404


def test_messages_are_those_of_the_language(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "new.yaml", discover())
    found = desk.check(NEW.format(name="new").replace("kind: floor", "kind: floorr"))
    (one,) = found["errors"]
    assert (one["line"], one["code"], one["hint"]) == (
        6,
        "E120",
        "did you mean 'floor' or 'floor_plan'?",
    )
    assert found["data"]["id"] == "new"  # what can be drawn stays


def test_suites_are_refused_and_robots_are_drawn(tmp_path: Path) -> None:
    (tmp_path / "suite.yaml").write_text("crowdbot: 1\nsuite: {id: a}\nbase: {}\n")
    with pytest.raises(UsageError, match="is a suite"):
        Desk(tmp_path / "suite.yaml", discover())
    (tmp_path / "short.yaml").write_text(_ROBOT)
    found = Desk(tmp_path / "short.yaml", discover()).opened()
    assert (found["errors"], bool(found["data"]["robots"])) == ([], True)


def test_two_desks_of_one_file_do_not_overwrite_each_other(tmp_path: Path) -> None:
    file = tmp_path / "shared.yaml"
    file.write_text(NEW.format(name="shared"))
    one, other = Desk(file, discover()), Desk(file, discover())
    first, second = one.opened(), other.opened()
    one.save(first["text"] + "# one\n", first["hash"], anyway=False)
    with pytest.raises(ConflictError):
        other.save(second["text"] + "# other\n", second["hash"], anyway=False)
    assert file.read_text().endswith("# one\n")
