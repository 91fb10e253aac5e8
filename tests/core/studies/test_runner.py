"""The runner: whom it answers, and what answers do."""

from __future__ import annotations

import http.client
import json
import threading
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlencode

import pytest

from crowdbot.core.studies.progress import StudyProgress, open_progress
from crowdbot.core.studies.runner.server import RunnerServer
from crowdbot.core.studies.runner.session import RunnerSession
from crowdbot.core.trajectories.questionnaires import TLX_SCALES
from tests.core.studies.study_cases import REGISTRY, STUDY, study_of

FORM = "application/x-www-form-urlencoded"


@pytest.fixture
def progress(tmp_path: Path) -> StudyProgress:
    return open_progress(study_of(tmp_path), tmp_path / "data", "p01")


@pytest.fixture
def server(progress: StudyProgress) -> Iterator[RunnerServer]:
    server = RunnerServer(RunnerSession(progress, REGISTRY, synthetic=True))
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    yield server
    server.session.close()
    server.shutdown()
    server.server_close()


def ask(
    server: RunnerServer, method: str, path: str, fields: dict[str, str] | None = None, **more: str
) -> tuple[int, str]:
    """Status and body of a request; with a form it has the page's origin unless told otherwise."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=10)
    headers = {} if fields is None else {"Content-Type": FORM, "Origin": server.origin}
    headers |= {name.replace("_", "-"): value for name, value in more.items()}
    connection.request(method, path, urlencode(fields or {}), headers)
    answer = connection.getresponse()
    found = answer.status, answer.read().decode()
    connection.close()
    return found


def test_the_page_is_for_its_address_only(server: RunnerServer) -> None:
    home = f"/{server.token}/"
    status, page = ask(server, "GET", home)
    assert (status, "You may stop at any time." in page) == (200, True)
    assert ask(server, "GET", "/")[0] == 403
    assert ask(server, "GET", f"/{server.token[:-1]}x/")[0] == 403
    assert ask(server, "GET", f"{home}other")[0] == 404
    assert ask(server, "GET", home, Host="evil.example")[0] == 403
    assert ask(server, "GET", home, Origin="https://evil.example")[0] == 403
    assert ask(server, "GET", home, Origin="http://127.0.0.1:1")[0] == 403


def test_answers_of_other_pages_are_not_taken(
    server: RunnerServer, progress: StudyProgress
) -> None:
    home, agreed = f"/{server.token}/", {"step": "001-consent", "agree": "yes"}
    assert ask(server, "POST", home, agreed, Origin="https://evil.example")[0] == 403
    assert ask(server, "POST", home, agreed, Origin="http://localhost:1")[0] == 403
    assert ask(server, "POST", home, agreed, Origin="null")[0] == 403
    assert ask(server, "POST", home, agreed, Content_Type="text/plain")[0] == 400
    assert ask(server, "POST", home, agreed | {"x": "y" * 70_000})[0] == 400
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=10)
    connection.request("POST", home, urlencode(agreed), {"Content-Type": FORM})  # no origin
    assert connection.getresponse().status == 403
    connection.close()
    assert progress.done() == {}
    assert ask(server, "POST", home, agreed)[0] == 303
    assert list(progress.done()) == ["001-consent"]


def test_without_agreement_nothing_begins(server: RunnerServer, progress: StudyProgress) -> None:
    home = f"/{server.token}/"
    assert ask(server, "POST", home, {"step": "001-consent"})[0] == 303
    assert "needs your agreement" in ask(server, "GET", home)[1]
    assert progress.done() == {}


def test_a_form_is_taken_when_it_is_complete_and_once(tmp_path: Path) -> None:
    """As a participant sends it: with a hole, whole, and again by reload."""
    text = STUDY.replace("id: help", "id: help\n  forms: [nasa_tlx]")
    progress = open_progress(study_of(tmp_path, text), tmp_path / "data", "p01")
    for step in progress.steps[:2]:
        progress.finish(step, {"driver": "synthetic", "run": "runs/x"})
    session = RunnerSession(progress, REGISTRY, synthetic=False)
    given = dict.fromkeys(TLX_SCALES, "35") | {"step": "003-nasa_tlx-alone"}
    session.answer({k: v for k, v in given.items() if k != "effort"})
    page = session.page()
    assert "One question is still open:" in page
    assert '<a href="#effort">' in page
    assert page.count(" checked>") + page.count(" checked aria") == 5
    session.answer(given)
    session.answer(given | {"effort": "100"})  # the step is over
    kept = json.loads((progress.home / "steps" / "003-nasa_tlx-alone.json").read_text())
    assert kept["answers"] == dict.fromkeys(TLX_SCALES, "35")
    assert "What counted, mode A" in session.page()


def test_a_drive_that_fails_is_said_and_can_be_tried_again(
    progress: StudyProgress, monkeypatch: pytest.MonkeyPatch
) -> None:
    progress.finish(progress.steps[0], {})
    session = RunnerSession(progress, REGISTRY, synthetic=True)
    monkeypatch.setattr(
        "crowdbot.core.studies.runner.session.drive_words",
        lambda *_, **__: ["simulate", "no_such_suite"],
    )
    waiting = session.state()
    assert waiting == "drive:002-trial-alone-1:waiting:False:False"
    session.answer({"step": "002-trial-alone-1"})
    drive = session._drive
    assert drive is not None
    assert drive._process is not None
    drive._process.wait(timeout=120)
    assert drive._reader is not None
    drive._reader.join()
    page = session.page()
    assert "The drive ended before it was complete." in page
    assert "no_such_suite" in page
    assert "Start the drive" in page
