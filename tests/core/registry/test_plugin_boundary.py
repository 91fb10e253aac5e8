"""The boundary to plugins: what passes, what becomes an error that says who it was."""

from __future__ import annotations

import signal
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.planning.planner import NoValidCommand
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.errors import (
    CrowdbotError,
    InputError,
    Interrupted,
    PlannerError,
    PlannerHungError,
    PluginError,
    UnknownNameError,
)

WHO = "sensor 'acme.radar' (acme 1.0)"


class UnspeakableError(Exception):
    """Its text cannot be had."""

    def __str__(self) -> str:
        raise SystemExit(7)


class OwnWayOut(BaseException):
    """Not an Exception."""


@pytest.fixture
def handled() -> Iterator[None]:
    """As in a command: Ctrl-C raises something else, so KeyboardInterrupt is a plugin's."""
    before = signal.signal(signal.SIGINT, lambda *_: None)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("handled")
@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (ValueError("fog"), "ValueError: fog"),
        (SystemExit(3), "SystemExit: 3"),
        (KeyboardInterrupt(), "KeyboardInterrupt"),
        (GeneratorExit(), "GeneratorExit"),
        (OwnWayOut("bye"), "OwnWayOut: bye"),
        (UnspeakableError(), "UnspeakableError: (its text raises SystemExit)"),
        (NoValidCommand("here"), "NoValidCommand: here"),
    ],
    ids=lambda e: type(e).__name__ if isinstance(e, BaseException) else "",
)
def test_whatever_else_becomes_an_error(error: BaseException, expected: str) -> None:
    with pytest.raises(PluginError) as caught, PluginCall(WHO)("read", 0.5):
        raise error
    text = str(caught.value)
    assert text.startswith(f"{WHO}: read at t = 0.5 s: {expected} ({__file__}:")
    line = int(text.rpartition(":")[2].rstrip(")"))
    assert Path(__file__).read_text().splitlines()[line - 1].strip() == "raise error"
    assert caught.value.__cause__ is error


@pytest.mark.parametrize(
    "error", [KeyboardInterrupt(), Interrupted("stop"), PlannerHungError("hung")]
)
def test_the_users_interrupt_passes(error: BaseException) -> None:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(type(error)) as caught, PluginCall(WHO)("read"):
            raise error
    finally:
        signal.signal(signal.SIGINT, before)
    assert caught.value is error
    assert WHO not in str(error)


@pytest.mark.parametrize(
    "error", [InputError("no such file"), PluginError("odd"), UnknownNameError("thing", "x", "y")]
)
def test_errors_of_crowdbot_keep_their_class_and_say_who_it_was(error: CrowdbotError) -> None:
    text = str(error)
    call = PluginCall(WHO)
    for _ in range(2):  # said once, however many boundaries it passes
        with pytest.raises(type(error)) as caught, call("cannot be built"):
            raise error
        assert caught.value is error
        assert str(error) == f"{WHO}: {text}"


def test_who_is_not_repeated() -> None:
    error = PluginError("sensor 'acme.radar' is broken")
    with pytest.raises(PluginError), PluginCall(WHO)("read"):
        raise error
    assert str(error) == "sensor 'acme.radar' is broken"


def test_another_class_and_what_passes_can_be_chosen() -> None:
    call = PluginCall("planner 'p'", error=PlannerError, passes=(PlannerError, NoValidCommand))
    with pytest.raises(NoValidCommand), call("step"):
        raise NoValidCommand("boxed in")
    with pytest.raises(PlannerError, match=r"^planner 'p': step: InputError: odd \("), call("step"):
        raise InputError("odd")
    with pytest.raises(PlannerError, match=r"^planner 'p': step returned 3$"):
        call.fail("step returned 3")


def test_prints_go_to_stderr_also_of_what_fails(capsys: pytest.CaptureFixture[str]) -> None:
    class ChattyError(Exception):
        def __str__(self) -> str:
            print("why")
            return "because"

    call = PluginCall(WHO)
    print("before")
    with call("read"):
        print("one")
        with call("read"):  # a policy that asks another one
            print("two")
        print("three")
    with pytest.raises(PluginError, match="because"), call("read"):
        raise ChattyError
    print("after")
    assert capsys.readouterr() == ("before\nafter\n", "one\ntwo\nthree\nwhy\n")
    assert sys.stdout is not sys.stderr


def test_frames_of_the_plugins_files_are_preferred(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of an installed package, too, all of whose files lie among libraries."""
    monkeypatch.setattr(sysconfig, "get_path", lambda _: "/")
    sources = {
        "acme/plugin.py": "def read(call):\n    # the plugin's line\n    return call()\n",
        "library/call.py": "def call():\n    return 1 / 0\n",
    }
    names: dict[str, Any] = {}
    for name, text in sources.items():
        exec(compile(text, str(tmp_path / name), "exec"), names)
    own = str(tmp_path / "acme" / "plugin.py")
    for files, place in ((set(), "library/call.py:2"), ({own}, "acme/plugin.py:3")):
        call = PluginCall(WHO, sources=lambda files=files: files)  # type: ignore[misc]
        with pytest.raises(PluginError) as caught, call("read"):
            names["read"](names["call"])
        assert str(caught.value).endswith(f"division by zero ({tmp_path}/{place})")
