"""The seat: whose hand is on the stick, when the robot stops, and when the run waits."""

from __future__ import annotations

import threading
import time

import pytest

from crowdbot.core.live.person import seat as seats
from crowdbot.core.live.person.seat import Seat
from crowdbot.core.live.person.stick import Stick, command_of, stick_of
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.errors import InputError
from tests.core.live.person.page_cases import seat_of_a_robot, until

LIMITS = RobotLimits(v_min=-0.2, v_max=0.8, w_max=1.5, a_max=1.0, alpha_max=2.0)


def held(stick: Stick) -> Seat:
    seat = seat_of_a_robot()
    assert seat.sit("page")
    seat.attend("page", "")
    assert seat.move("page", stick)
    return seat


@pytest.mark.parametrize(
    ("stick", "command"),
    [
        (Stick(1, 1.0, 0.5), Command(0.8, 0.75)),
        (Stick(1, -0.5, -1.0), Command(-0.1, -1.5)),
        (Stick(1), Command(0.0, 0.0)),
    ],
)
def test_full_deflection_is_the_robots_limit(stick: Stick, command: Command) -> None:
    assert command_of(stick, LIMITS) == pytest.approx(command)


@pytest.mark.parametrize(
    "wrong", [{}, {"n": 0}, {"n": True}, {"n": 1, "ahead": "1"}, {"n": 1, "left": float("nan")}]
)
def test_a_stick_is_numbers(wrong: dict[str, object]) -> None:
    with pytest.raises(InputError):
        stick_of(wrong)


def test_deflections_are_limited() -> None:
    assert stick_of({"n": 3, "ahead": 7, "left": -9.0}) == Stick(3, 1.0, -1.0)


@pytest.mark.parametrize("away", ["not in focus", "hidden"])
def test_a_hand_that_leaves_the_stick_centres_it(away: seats.Away) -> None:
    seat = held(Stick(1, 1.0, 0.2))
    assert seat.take(0.0) == Stick(1, 1.0, 0.2)
    seat.attend("page", away)
    assert seat.take(0.5) == Stick(1)
    assert not seat.move("other", Stick(2, 1.0))
    seat.move("page", Stick(2, 1.0))  # a key that is pressed without the focus
    assert seat.take(0.6) == Stick(1)
    seat.attend("page", "")
    assert seat.take(0.7) == Stick(1)  # it stays centred until the hand moves it
    seat.move("page", Stick(3, 0.5))
    assert seat.take(0.8) == Stick(3, 0.5)
    assert seat.log.stops == [(0.5, away)]
    assert (seat.log.steps, seat.log.centred) == (5, 2)


def test_a_page_that_falls_silent_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(seats, "SILENT", 0.01)
    seat = held(Stick(1, 1.0))
    time.sleep(0.02)
    assert seat.take(1.0) == Stick(1)
    assert seat.log.stops == []  # its hand was never used
    seat.attend("page", "")
    seat.move("page", Stick(2, 1.0))
    assert seat.take(1.1) == Stick(2, 1.0)


def test_an_older_position_does_not_come_back() -> None:
    seat = held(Stick(5, 1.0))
    seat.move("page", Stick(4, -1.0))
    assert seat.take(0.0) == Stick(5, 1.0)


def test_one_page_drives_and_the_seat_can_be_taken_when_free() -> None:
    seat = held(Stick(1, 1.0))
    assert not seat.sit("second")
    seat.leave("page")
    assert seat.take(0.0) == Stick(1)
    assert seat.sit("second")
    assert not seat.move("page", Stick(9, 1.0))
    assert seat.take(0.1) == Stick()


def test_used_positions_are_told_once() -> None:
    entries = []
    seat = held(Stick(1, 1.0))
    seat.on_taken = lambda number, t: entries.append((number, t))
    for k in range(3):
        seat.take(0.1 * k)
    seat.move("page", Stick(4, 0.0))
    seat.take(0.3)
    assert entries == [(1, 0.0), (4, 0.3)]


def test_the_run_begins_when_the_person_says_so_and_waits_while_gone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(seats, "GRACE", 0.02)
    seat, paced = held(Stick(1)), list[float]()

    def simulate() -> None:
        for k in range(4):
            seat.pace(0.01 * k)
            paced.append(0.01 * k)
            if k == 1:
                seat.leave("page")
                time.sleep(0.03)

    thread = threading.Thread(target=simulate, daemon=True)
    thread.start()
    until(lambda: seat.why_waiting == "not begun")
    assert paced == []
    seat.begin("other")  # only the one in the seat
    seat.begin("page")
    until(lambda: seat.why_waiting == "disconnected")
    assert paced == [0.0, 0.01]
    assert seat.sit("reloaded")
    seat.attend("reloaded", "")
    thread.join(10.0)
    ((t, seconds, why),) = seat.log.waits
    assert (len(paced), t, why) == (4, 0.02, "disconnected")
    assert seconds > 0.0


def test_steps_keep_to_real_time_and_nothing_is_hurried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(seats, "LATE", 0.02)
    seat = held(Stick(1))
    seat.why_waiting = "not begun"
    seat.begin("page")
    seat.pace(0.0)
    began = time.monotonic()
    seat.pace(0.05)
    assert time.monotonic() - began >= 0.049
    time.sleep(0.1)  # a computer that is too slow
    seat.pace(0.06)
    since = time.monotonic()
    seat.pace(0.11)
    assert time.monotonic() - since >= 0.049
    assert seat.log.delayed > 0.05


def test_a_program_drives_while_the_seat_is_free() -> None:
    seat = seat_of_a_robot()
    assert seat.session.drive("program")
    assert not seat.sit("page")
    seat.session.command("program", Command(0.3, 0.1))
    assert seat.take(0.0) == Command(0.3, 0.1)
    seat.session.leave("program")
    assert seat.sit("page")
