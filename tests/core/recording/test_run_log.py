"""From states to rows: trips, jumps and contacts, each recorded once."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np
import pytest

from crowdbot.core.crowd import state as s
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.plugin import Array, Command, RobotState


class Rows:
    """Collects what the log writes."""

    def __init__(self) -> None:
        self.states: list[tuple[Any, ...]] = []
        self.wheel_angles: list[tuple[Any, ...]] = []
        self.trips: list[tuple[Any, ...]] = []
        self.contacts: list[dict[str, Any]] = []
        self.commands: list[tuple[Any, ...]] = []
        self.times: list[float] = []

    def wheels(self, *row: Any) -> None:
        self.wheel_angles.append(row)

    def state(self, *row: Any, goals: Array | None) -> None:
        assert (goals is None) == (row[2] is None)
        self.states.append(row)

    def trip(self, *row: Any) -> None:
        self.trips.append(row)

    def contact(self, **row: Any) -> None:
        self.contacts.append(row)

    def command(self, *row: Any) -> None:
        self.commands.append(row)

    def planner_time(self, t: float, seconds: float) -> None:
        assert t >= 0.0
        self.times.append(seconds)


def _log(count: int) -> tuple[RunLog, Rows, Any, Any]:
    rows = Rows()
    flat = s.blank(count)
    _, people = s.view(flat)
    people[:, s.X], people[:, s.ON_TRIP] = np.arange(count), 1.0
    return RunLog(cast(RecordingWriter, rows), np.arange(count) + 10), rows, flat, people


def test_absent_people_are_nan_and_present_ones_copied() -> None:
    log, rows, flat, people = _log(3)
    people[1, s.WAITING] = 1.0
    log.sample(0.0, None, flat)
    people[:, s.X] = 99.0
    _, robot, agents, jump = rows.states[0]
    assert robot is None
    assert agents[0, 0] == 0.0
    assert np.all(np.isnan(agents[:, 1]))
    assert agents[0, 2] == 2.0
    assert list(jump) == [False] * 3


def _arrive(flat: Any, i: int, start: float, end: float, **columns: float) -> None:
    """What the engine writes at an arrival."""
    header, people = s.view(flat)
    header[s.TRIPS] += 1.0
    people[i, s.ARRIVALS] += 1.0
    people[i, [s.LAST_START, s.ARRIVED, s.ON_TRIP]] = start, end, 0.0
    for name, value in columns.items():
        people[i, getattr(s, name)] = value


def test_a_trip_is_recorded_once_when_it_is_over() -> None:
    log, rows, flat, people = _log(2)
    log.sample(0.0, None, flat)
    log.record_events(flat)
    _arrive(flat, 1, 0.0, 0.51, WAITING=s.AT_PORTAL)
    log.record_events(flat)
    log.record_events(flat)
    log.sample(0.5625, None, flat)
    assert rows.trips == [(11, 0.0, 0.51, True)]
    people[1, [s.WAITING, s.JUMPS, s.TRIP_START, s.ON_TRIP]] = s.PRESENT, 1.0, 0.65, 1.0
    for t in (0.6875, 0.75):
        log.record_events(flat)
        log.sample(t, None, flat)
    assert [list(row[3]) for row in rows.states] == [
        [False, False], [False, False], [False, True], [False, False],
    ]  # fmt: skip
    log.finish(1.0, flat)
    assert rows.trips[1:] == [(10, 0.0, 1.0, False), (11, 0.65, 1.0, False)]


def test_leaving_and_coming_back_between_two_samples() -> None:
    log, rows, flat, _people = _log(1)
    log.sample(0.0, None, flat)
    _arrive(flat, 0, 0.0, 0.02, JUMPS=1.0, TRIP_START=0.03, ON_TRIP=1.0)
    log.record_events(flat)
    log.sample(0.0625, None, flat)
    assert rows.trips == [(10, 0.0, 0.02, True)]
    assert list(rows.states[-1][3]) == [True]
    log.finish(0.07, flat)
    assert rows.trips[-1] == (10, 0.03, 0.07, False)


def test_several_waypoints_between_two_samples_are_trips_but_no_jumps() -> None:
    log, rows, flat, _people = _log(1)
    log.sample(0.0, None, flat)
    for start, end in ((0.0, 0.01), (0.01, 0.03), (0.03, 0.04)):
        _arrive(flat, 0, start, end, TRIP_START=end, ON_TRIP=1.0)
        log.record_events(flat)
    log.sample(0.0625, None, flat)
    assert rows.trips == [(10, 0.0, 0.01, True), (10, 0.01, 0.03, True), (10, 0.03, 0.04, True)]
    assert list(rows.states[-1][3]) == [False]


@pytest.mark.parametrize("where", [s.NOT_YET, s.GONE, s.AT_PORTAL])
def test_who_is_outside_at_the_end_is_on_no_trip(where: float) -> None:
    log, rows, flat, people = _log(2)
    people[1, s.WAITING] = where
    log.finish(0.05, flat)
    assert rows.trips == [(10, 0.0, 0.05, False)]


def test_who_rests_at_the_goal_is_on_no_trip() -> None:
    log, rows, flat, _people = _log(1)
    _arrive(flat, 0, 0.0, 0.04)
    log.finish(9.0, flat)
    assert rows.trips == [(10, 0.0, 0.04, True)]


def test_contacts_are_recorded_when_they_end() -> None:
    log, rows, flat, _people = _log(2)
    felt, touches = s.contact_with(flat)
    touches[1, s.TOUCHING] = 1.0
    log.record_events(flat)
    assert rows.contacts == []
    columns = [
        s.TOUCH_START, s.TOUCH_END, s.TOUCH_IMPULSE, s.TOUCH_PEAK, s.TOUCH_SPEED, s.TOUCH_SIDE
    ]  # fmt: skip
    touches[1, columns] = 0.1, 0.2, 3.0, 400.0, 0.7, -1.25
    touches[1, [s.TOUCHING, s.TOUCHES]] = 0.0, 1.0
    felt[s.CONTACTS] = 1.0
    log.record_events(flat)
    log.record_events(flat)
    assert rows.contacts == [
        {"t0": 0.1, "t1": 0.2, "agent": 11, "impulse": 3.0, "peak_force": 400.0,
         "relative_speed": 0.7, "bearing": -1.25}
    ]  # fmt: skip
    touches[0, s.TOUCHING] = 1.0
    log.finish(1.0, flat)
    assert [c["agent"] for c in rows.contacts] == [11, 10]
    assert log.contacts == 2


def test_two_contacts_in_one_tick() -> None:
    log, rows, flat, _people = _log(3)
    felt, touches = s.contact_with(flat)
    touches[[0, 2], s.TOUCHES] = 1.0
    felt[s.CONTACTS] = 2.0
    log.record_events(flat)
    assert [c["agent"] for c in rows.contacts] == [10, 12]


def test_forward_speed_is_signed() -> None:
    log, rows, *_ = _log(0)
    rest = {"tilt": 0.0, "z": 0.0, "left_angle": 0.25, "right_angle": 0.5}
    log.sample(0.0, RobotState(x=1, y=2, yaw=math.pi / 2, vx=0.0, vy=-0.5, w=0.1, **rest), None)
    assert rows.states[0][1] == pytest.approx((1.0, 2.0, math.pi / 2, -0.5, 0.1))
    assert rows.states[0][2] is None
    assert rows.wheel_angles == [(0.0, (0.25, 0.5))]


def test_step_times() -> None:
    log, rows, *_ = _log(0)
    assert log.step_times() == {"mean": 0.0, "max": 0.0}
    for t, seconds, clamped in ((0.0, 0.001, False), (0.1, 0.003, True)):
        log.command(t, Command(0.1, 0.2), seconds, clamped)
    assert log.step_times() == {"mean": 0.002, "max": 0.003}
    assert (log.clamped, rows.times) == (1, [0.001, 0.003])
    assert rows.commands[1] == (0.1, Command(0.1, 0.2))
