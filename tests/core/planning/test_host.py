"""The planner host trusts nothing; the watchdog ends what never returns."""

import math
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.errors import Interrupted, PlannerError, PlannerHungError
from crowdbot.plugin import (
    Command,
    NoValidCommand,
    Observation,
    Pose,
    Reading,
    RobotLimits,
    SensorInfo,
    Task,
)
from tests.waiting import AT_MOST

LIMITS = RobotLimits(v_min=-0.2, v_max=0.65, w_max=3.14, a_max=1.0, alpha_max=2.0)
ZONE = np.array([[45.0, -5.0], [50.0, -5.0], [50.0, 5.0], [45.0, 5.0]])
TASK = Task(start=Pose(2.5, 0, 0), goal=(47.5, 0.0), goal_zone=ZONE, time_limit=180.0)


def observation(values: Any = None) -> Observation:
    readings = {} if values is None else {"front": Reading(0.0, values)}
    return Observation(
        t=0.0, pose=TASK.start, twist=(0.0, 0.0), goal=TASK.goal, goal_zone=ZONE, readings=readings
    )


class Answers:
    """Returns, or raises, what it was given."""

    def __init__(self, answer: Any) -> None:
        self.answer = answer
        self.seen: list[Observation] = []

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        self.given = (task, limits, sensors, seed)

    def step(self, obs: Observation) -> Any:
        self.seen.append(obs)
        if isinstance(self.answer, BaseException):
            raise self.answer
        return self.answer


def host_of(answer: Any, **kw: Any) -> PlannerHost:
    return PlannerHost(Answers(answer), "mine", LIMITS, **kw)


# --------------------------------------------------------------------------- answers
@pytest.mark.parametrize(
    "answer",
    [Command(0.5, -1.0), (0.5, -1.0), (0.5, -1.0, 0.0), (np.float32(0.5), -1), (0.5, np.int64(-1))],
)
def test_commands_that_are_fine(answer: Any) -> None:
    hosted = host_of(answer).step(observation())
    assert hosted.command == Command(0.5, -1.0)
    assert not hosted.clamped
    assert all(type(x) is float for x in hosted.command)
    assert hosted.seconds > 0.0


@pytest.mark.parametrize(
    ("answer", "shown"),
    [
        (None, "None (NoneType)"),
        ((), "() (tuple)"),
        ((0.5,), "(0.5,) (tuple)"),
        ((0, 0, 0, 0), "(0, 0, 0, 0) (tuple)"),
        ([0.5, 0.0], "[0.5, 0.0] (list)"),
        ("go", "'go' (str)"),
        (("0.5", 0.0), "('0.5', 0.0) (tuple)"),
        ((True, 0.0), "(True, 0.0) (tuple)"),
        ((1j, 0.0), "(1j, 0.0) (tuple)"),
        (0.5, "0.5 (float)"),
        ((0.5, math.nan), "(0.5, nan) (tuple)"),
        (Command(math.inf, 0.0), "Command(v=inf, w=0.0, vy=0.0) (Command)"),
        ((0.0, 0.0, -math.inf), "(0.0, 0.0, -inf) (tuple)"),
    ],
)
def test_answers_that_are_no_command(answer: Any, shown: str) -> None:
    with pytest.raises(PlannerError) as caught:
        host_of(answer).step(observation())
    assert str(caught.value).startswith("planner 'mine': step returned ")
    assert shown in str(caught.value)


def test_a_repr_that_raises_or_never_ends() -> None:
    class Nasty:
        def __repr__(self) -> str:
            raise RuntimeError("no")

    with pytest.raises(PlannerError, match=r"repr raises RuntimeError \(Nasty\)"):
        host_of(Nasty()).step(observation())
    with pytest.raises(PlannerError) as caught:
        host_of("x" * 10_000).step(observation())
    assert len(str(caught.value)) < 250


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_clamped_to_the_limits(v: float, w: float, vy: float) -> None:
    host = host_of((v, w, vy))
    hosted = host.step(observation())
    assert LIMITS.v_min <= hosted.command.v <= LIMITS.v_max
    assert abs(hosted.command.w) <= LIMITS.w_max
    assert hosted.command.vy == 0.0
    within = LIMITS.v_min <= v <= LIMITS.v_max and abs(w) <= LIMITS.w_max and vy == 0.0
    if within:
        assert hosted == (Command(v, w), False, hosted.seconds)
    assert host.clamped == hosted.clamped


def test_clamping_is_counted_but_rounding_is_not() -> None:
    host = host_of((0.65 + 1e-12, -3.14))
    assert not host.step(observation()).clamped
    host = host_of((0.66, 0.0))
    for _ in range(3):
        assert host.step(observation())[:2] == (Command(0.65, 0.0), True)
    assert (host.steps, host.clamped) == (3, 3)
    host.reset(TASK, {}, 0)
    assert (host.steps, host.clamped) == (0, 0)


def test_no_valid_command_stops_the_robot() -> None:
    host = host_of(NoValidCommand("boxed in"))
    assert host.step(observation())[:2] == (Command(0.0, 0.0), False)
    assert host.stops == 1


# ------------------------------------------------------------------------ exceptions
@pytest.mark.parametrize(
    "error",
    [ValueError("bad"), SystemExit(3), AssertionError(), GeneratorExit(), MemoryError("much")],
)
def test_whatever_a_planner_raises(error: BaseException) -> None:
    with pytest.raises(PlannerError) as caught:
        host_of(error).step(observation())
    text = str(caught.value)
    assert text.startswith(f"planner 'mine': step: {type(error).__name__}")
    assert str(error) in text
    assert Path(__file__).name in text
    assert "raise self.answer" in Path(__file__).read_text().splitlines()[_line(text) - 1]
    assert caught.value.exit_code == 3


def _line(text: str) -> int:
    return int(text.rpartition(":")[2].rstrip(")"))


@pytest.mark.parametrize("error", [KeyboardInterrupt(), Interrupted("stop")])
def test_the_users_interrupt_passes(error: BaseException) -> None:
    with pytest.raises(type(error)):
        host_of(error).step(observation())


def test_the_innermost_line_of_the_users_code_is_named() -> None:
    class Deep(Answers):
        def step(self, obs: Observation) -> Any:
            return np.linalg.inv(np.zeros((2, 2)) * obs.t)  # the marked line

    with pytest.raises(PlannerError) as caught:
        PlannerHost(Deep(0), "deep", LIMITS).step(observation())
    text = str(caught.value)
    assert "LinAlgError: Singular matrix" in text
    assert "the marked line" in Path(__file__).read_text().splitlines()[_line(text) - 1]


def test_reset_is_guarded_as_well() -> None:
    class Broken(Answers):
        def reset(self, *_: Any, **__: Any) -> None:
            raise NoValidCommand("not here")

    with pytest.raises(PlannerError, match="'broken': reset: NoValidCommand: not here"):
        PlannerHost(Broken(0), "broken", LIMITS).reset(TASK, {}, 0)


def test_budget() -> None:
    class Slow(Answers):
        def step(self, obs: Observation) -> Any:
            time.sleep(0.05 + obs.t)
            return (0.0, 0.0)

    assert PlannerHost(Slow(0), "slow", LIMITS).step(observation()).seconds >= 0.05
    with pytest.raises(PlannerError, match=r"'slow': step took \d+\.\d+ s; the budget is 0.01 s"):
        PlannerHost(Slow(0), "slow", LIMITS, budget=0.01).step(observation())


# ---------------------------------------------------------------------- what it sees
def test_prints_go_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    class Chatty(Answers):
        def reset(self, *_: Any, **__: Any) -> None:
            print("hello")

        def step(self, obs: Observation) -> Any:
            print("step", obs.t)
            return (0.0, 0.0)

    host = PlannerHost(Chatty(0), "chatty", LIMITS)
    host.reset(TASK, {}, 0)
    host.step(observation())
    print("ours")
    assert capsys.readouterr() == ("ours\n", "hello\nstep 0.0\n")


def test_observations_are_read_only_copies() -> None:
    values = np.ones(4)
    planner = Answers((0.0, 0.0))
    host = PlannerHost(planner, "mine", LIMITS)
    host.reset(TASK, {}, 5)
    host.step(observation(values))
    values[:] = 7.0  # the simulation goes on in place
    seen = planner.seen[0]
    np.testing.assert_array_equal(seen.readings["front"].values, 1.0)
    for array in (seen.readings["front"].values, seen.goal_zone, planner.given[0].goal_zone):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 3.0
    with pytest.raises(TypeError):
        seen.readings["front"] = Reading(0.0, values)  # type: ignore[index]
    assert ZONE.flags.writeable
    assert planner.given[3] == 5


def test_signals_are_passed_on() -> None:
    class Logs(Answers):
        def step(self, obs: Observation) -> Any:
            obs.log("mine/x", 2.0)
            return (0.0, 0.0)

    seen: list[tuple[str, float]] = []
    obs = Observation(
        t=0.0,
        pose=TASK.start,
        twist=(0.0, 0.0),
        goal=TASK.goal,
        goal_zone=ZONE,
        log=lambda n, v: seen.append((n, v)),
    )
    PlannerHost(Logs(0), "logs", LIMITS).step(obs)
    assert seen == [("mine/x", 2.0)]


# -------------------------------------------------------------------------- watchdog
PROGRAM = """
import os, sys, threading, time
import numpy as np
from crowdbot.plugin import *
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.errors import PlannerHungError

class P:
    def reset(self, *a): {reset}
    def step(self, obs):
{body}

def gone():
    print("gone", flush=True)
    os._exit(3)

limits = RobotLimits(v_min=0.0, v_max=1.0, w_max=1.0, a_max=1.0, alpha_max=1.0)
obs = Observation(t=0.0, pose=Pose(0, 0, 0), twist=(0, 0), goal=(1, 0), goal_zone=np.zeros((4, 2)))
host = PlannerHost(P(), "p", limits, watchdog=Watchdog(limit=0.4, grace=0.6, on_hang=gone))
def main():
    try:
        {call}
    except PlannerHungError as error:
        print("hung:", error, flush=True)
        time.sleep(1.5)   # nothing more happens to a main thread that has been freed
        print("alive", flush=True)
{start}
"""
SPIN = "        while True: pass"
SLEEP = "        time.sleep(100)"
STUBBORN = """
        while True:
            try:
                n = 0
                while True: n += 1
            except BaseException: pass
"""
LATE = """
        try: time.sleep(100)
        except BaseException: pass
        return (0.0, 0.0)
"""
IN_THREAD = "t = threading.Thread(target=main); t.start(); t.join()"
HUNG = "hung: planner 'p' did not return from step within 0.4 s\nalive\n"


def run(
    body: str,
    start: str = "main()",
    call: str = "host.step(obs)",
    words: Sequence[str] = (),
) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of the program, which reads the words from stdin."""
    text = PROGRAM.format(body=body, start=start, call=call, reset="pass")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", text],
        input="\n".join([*words, ""]), capture_output=True, text=True, timeout=AT_MOST, check=False,
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("body", [SPIN, SLEEP, LATE], ids=["spin", "sleep", "swallowed once"])
def test_a_hanging_step_is_interrupted(body: str) -> None:
    assert run(body) == (0, HUNG, "")


@pytest.mark.slow
def test_a_stubborn_step_ends_the_process() -> None:
    assert run(STUBBORN) == (3, "", "gone\n")  # stdout is still the planner's


@pytest.mark.slow
def test_in_another_thread_python_code_is_interrupted() -> None:
    assert run(SPIN, IN_THREAD) == (0, HUNG, "")


@pytest.mark.slow
def test_in_another_thread_a_sleep_ends_the_process() -> None:
    assert run(SLEEP, IN_THREAD) == (3, "", "gone\n")


@pytest.mark.slow
def test_a_step_under_the_debugger_may_take_its_time() -> None:
    stops = "        breakpoint()\n        return (0.0, 0.0)"
    words = ["import time", "time.sleep(2.0)", "p obs.t", "c"]
    code, out, err = run(stops, call="host.step(obs); print('went on')", words=words)
    assert code == 0, err
    assert out.endswith("went on\n")
    assert "(Pdb) 0.0\n" in out + err


@pytest.mark.slow
def test_the_watchdog_leaves_quick_steps_alone() -> None:
    quick = "        return (0.0, 0.0)"
    many = "[(host.step(obs), time.sleep(0.15)) for _ in range(8)]; print('fine')"
    assert run(quick, call=many) == (0, "fine\n", "")


def test_watchdog_uses_one_thread_for_all_steps() -> None:
    watchdog = Watchdog(limit=5.0)
    before = threading.active_count()
    try:
        for _ in range(1000):
            with watchdog:
                pass
        assert threading.active_count() == before + 1
    finally:
        watchdog.close()
    assert threading.active_count() == before


def test_watchdog_gives_the_signal_back_and_starts_again() -> None:
    import signal

    before = signal.getsignal(signal.SIGUSR2)
    watchdog = Watchdog(limit=0.2, grace=5.0)
    for _ in range(2):
        with pytest.raises(PlannerHungError, match=r"within 0.2 s"), watchdog:
            time.sleep(20)
        assert signal.getsignal(signal.SIGUSR2) != before
        watchdog.close()
        assert signal.getsignal(signal.SIGUSR2) == before


def test_a_stray_signal_between_steps_does_nothing() -> None:
    import signal

    watchdog = Watchdog(limit=5.0)
    watchdog.start()
    try:
        signal.raise_signal(signal.SIGUSR2)
        with watchdog:
            signal.raise_signal(signal.SIGUSR2)
    finally:
        watchdog.close()


@pytest.mark.slow
def test_patience_holds_inside_only() -> None:
    watchdog = Watchdog(limit=0.2, grace=5.0)
    try:
        with watchdog.patience(5.0), watchdog:
            time.sleep(0.5)
        with pytest.raises(PlannerHungError), watchdog:
            time.sleep(20)
    finally:
        watchdog.close()


@pytest.mark.slow
def test_patience_lasts_while_something_is_done() -> None:
    watchdog = Watchdog(limit=0.2, grace=5.0)
    done: list[int] = []
    try:
        with watchdog.patience(0.4, lambda: len(done)), watchdog:
            for _ in range(10):  # one piece of work in each 0.1 s
                time.sleep(0.1)
                done.append(1)
        with pytest.raises(PlannerHungError), watchdog.patience(0.4, lambda: len(done)), watchdog:
            time.sleep(20)
    finally:
        watchdog.close()
