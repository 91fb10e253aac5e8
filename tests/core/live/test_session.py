"""What simulation and connections share."""

from __future__ import annotations

import math
import threading

import pytest

from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.session import LiveSession
from crowdbot.core.types.motion import Command

GO = Command(0.5, 0.1)


def _nobody() -> None:
    raise AssertionError("nobody began to listen")


def test_the_first_command_after_the_question_answers_it() -> None:
    session = LiveSession()
    session.ask(5)
    assert session.command("a", GO) == ""
    assert session.command("a", Command(0.0, 0.0)) == ""
    assert session.answer(1.0, _nobody) == GO


def test_a_command_before_the_question_does_not_answer_it() -> None:
    session = LiveSession()
    session.command("a", GO)
    session.ask(5)
    assert session.answer(0.01, _nobody) is None


def test_a_command_with_an_old_stamp_does_not_answer() -> None:
    session = LiveSession()
    session.ask(2_000_000_000)
    assert "older" in session.command("a", GO, 1_000_000_000)
    assert session.answer(0.01, _nobody) is None
    assert session.counts.refused == 1
    session.ask(2_000_000_000)
    assert session.command("a", GO, 2_000_000_000) == ""
    assert session.answer(1.0, _nobody) == GO


def test_a_stamp_of_0_is_none() -> None:
    session = LiveSession()
    session.ask(2_000_000_000)
    session.command("a", GO, 0)
    assert session.answer(1.0, _nobody) == GO


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_command_must_be_finite(bad: float) -> None:
    session = LiveSession()
    session.ask(0)
    assert "finite" in session.command("a", Command(0.0, bad))
    assert session.answer(0.01, _nobody) is None


def test_the_first_who_drives_drives_until_he_leaves() -> None:
    session = LiveSession()
    session.ask(0)
    assert session.drive("a")
    assert not session.drive("b")
    assert "another" in session.command("b", Command(0.1, 0.0))
    session.leave("b")
    assert "another" in session.command("b", Command(0.1, 0.0))
    session.leave("a")
    assert session.command("b", GO) == ""
    assert session.answer(1.0, _nobody) == GO


def _two() -> LiveSession:
    session = LiveSession(robots={"": LiveRobot(), "a": LiveRobot(), "b": LiveRobot()})
    session.begin("hall", 0, ["a", "b"])
    return session


def test_each_robot_has_its_driver_and_its_commands() -> None:
    session = _two()
    assert session.commands == {"/cmd_vel": "", "/a/cmd_vel": "a", "/b/cmd_vel": "b"}
    session.ask(0, ["a", "b"])
    assert session.command("one", GO, robot="a") == ""
    assert not session.driven
    assert "another" in session.command("two", GO, robot="a")
    assert session.command("two", Command(0.1, 0.0), robot="b") == ""
    assert session.driven
    assert session.answer(1.0, _nobody, "b") == Command(0.1, 0.0)
    assert session.answer(1.0, _nobody, "a") == GO
    assert session.newest("a") == (GO, True)
    assert "no robot" in session.command("one", GO)
    session.leave("one")
    assert (session.is_driven("a"), session.is_driven("b")) == (False, True)


def test_a_run_begins_when_all_its_robots_have_drivers() -> None:
    session = _two()
    session.drive("one", "a")
    assert not session.wait_for_driver(0.01)
    session.drive("one", "b")
    assert session.wait_for_driver(60.0)


def test_who_begins_to_listen_is_told_while_a_step_waits() -> None:
    session = LiveSession()
    session.ask(0)
    session.listened()
    calls: list[int] = []

    def tell() -> None:
        calls.append(1)
        session.command("a", GO)

    assert session.answer(10.0, tell) == GO
    assert calls == [1]


def test_the_clock_outside_never_goes_back() -> None:
    session = LiveSession()
    for t in (0.1, 0.1, 0.05, math.nan, 0.2, -1.0):
        session.clock(t, 1)
    session.wait_for_clock(0.2)
    waiting = threading.Thread(target=session.wait_for_clock, args=(0.3,))
    waiting.start()
    session.clock(0.1, 1)
    waiting.join(0.2)
    assert waiting.is_alive()
    session.clock(0.3, 1)
    waiting.join(30.0)
    assert not waiting.is_alive()


def test_a_paused_run_takes_as_many_steps_as_it_is_told() -> None:
    session = LiveSession()
    session.pause(True)
    taken: list[int] = []
    stopped = False

    def run() -> None:
        while not stopped:
            session.wait_while_paused()
            if not stopped:
                taken.append(1)

    thread = threading.Thread(target=run)
    thread.start()
    session.step(3)
    thread.join(0.3)
    assert len(taken) == 3
    stopped = True
    session.pause(False)
    thread.join(30.0)
    assert not thread.is_alive()


def test_a_request_ends_every_wait() -> None:
    session = LiveSession()
    session.ask(0)
    session.ask_for("next", seed=7)
    assert session.answer(1e6, _nobody) is None
    assert not session.wait_for_driver(1e6)
    session.pause(True)
    session.wait_while_paused()
    session.wait_for_clock(1e9)
    assert session.take_request() == "next"
    assert session.seed == 7
    assert not session.must_stop


def test_the_first_client_keeps_the_clock_until_it_leaves() -> None:
    session = LiveSession()
    assert session.clock(0.1, "a")
    assert not session.clock(1e9, "b")
    session.wait_for_clock(0.1)
    assert session.drives("a")
    session.leave("b")
    assert not session.clock(1e9, "b")
    session.leave("a")
    assert session.clock(0.2, "b")
