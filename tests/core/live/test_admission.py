"""Who may connect to a live server: programs, pages of this machine, and named websites."""

from __future__ import annotations

import pytest

from crowdbot.core.live.admission import Admission, is_loopback


@pytest.mark.parametrize(
    "host", ["localhost", "LOCALHOST", "127.0.0.1", "127.9.8.7", "::1", "[::1]", "::ffff:127.0.0.1"]
)
def test_this_machine_has_these_names(host: str) -> None:
    assert is_loopback(host)


@pytest.mark.parametrize(
    "host",
    ["", "127.evil.test", "127.0.0.1.evil.test", "localhost.evil.test", "10.0.0.1", "::", "0.0.0.0",  # noqa: S104
     "::ffff:10.0.0.1", "127.1", "evil-127.0.0.1"],
)  # fmt: skip
def test_other_names_are_not_of_this_machine(host: str) -> None:
    assert not is_loopback(host)


@pytest.mark.parametrize(
    ("headers", "admitted"),
    [
        ({}, True),
        ({"host": ["127.0.0.1:8765"]}, True),
        ({"host": ["localhost:8765"], "origin": ["http://localhost:3000"]}, True),
        ({"host": ["127.0.0.1:8765"], "origin": ["https://app.test"]}, True),
        ({"host": ["127.0.0.1:8765"], "origin": ["http://app.test"]}, False),
        ({"host": ["127.0.0.1:8765"], "origin": ["https://app.test.evil.test"]}, False),
        ({"host": ["127.0.0.1:8765"], "origin": ["null"]}, False),
        ({"host": ["127.0.0.1:8765"], "origin": [""]}, False),
        ({"host": ["127.0.0.1:8765"], "origin": ["http://["]}, False),
        ({"origin": ["http://[::1]:3000"]}, True),
        ({"origin": ["http://[::1].evil.test"]}, False),
        ({"origin": ["http://evil.test\\@localhost"]}, False),
        ({"host": ["evil.test@localhost"]}, False),
        ({"host": ["localhost:80:evil.test"]}, False),
        ({"host": ["localhost#evil.test"]}, False),
        ({"host": ["evil.test:8765"]}, False),
        ({"host": ["evil.test:8765"], "origin": ["http://localhost"]}, False),
        ({"host": ["localhost", "localhost"]}, False),
        ({"origin": ["http://localhost", "http://evil.test"]}, False),
    ],
)
def test_foreign_pages_and_names_are_refused(headers: dict[str, list[str]], admitted: bool) -> None:
    admission = Admission(server="test", origins=("https://app.test/",))
    assert (admission.problem(headers) == "") is admitted


def test_a_refused_website_is_named_once(capsys: pytest.CaptureFixture[str]) -> None:
    admission = Admission(server="test")
    for _ in range(3):
        admission.problem({"origin": ["http://evil.test\x1b[31m"]})
    output = capsys.readouterr().err
    assert output.count("--allow-origin") == 1
    assert "\x1b" not in output
    for number in range(100):
        admission.problem({"origin": [f"http://{number}.test"]})
    assert capsys.readouterr().err.count("\n") < 25
