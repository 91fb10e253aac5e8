"""What a planner in a process of its own can do: nothing but fail, with a reason."""

from __future__ import annotations

import os
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.process.server_handle import POOL
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.errors import PlannerError, hidden_character
from tests.core.planning.process.process_cases import (
    LIMITS,
    below,
    choose,
    descriptors,
    hosted,
    is_alive,
    left,
    observation,
    older_kernel,
    planner_text,
)

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

#: What a step does -> what the reason says.
DEATHS = {
    "leaves": ("os._exit(0)", "its process ended with exit code 0"),
    "leaves with a code": ("os._exit(7)", "its process ended with exit code 7"),
    "kills itself": ("os.kill(os.getpid(), 9)", "signal 9 (SIGKILL)"),
    "kills its group": ("os.killpg(0, 9)", "signal 9 (SIGKILL)"),
    "segfault": ("ctypes.string_at(0)", "signal 11 (SIGSEGV)"),
    "abort": ("os.abort()", "signal 6 (SIGABRT)"),
    "closes all": ("os.closerange(0, 256)", "its process "),
    "closes answers": ("os.close(4)", "its process ended with exit code"),
    "writes rubbish": ("os.write(4, b'\\x05\\0\\0\\0hello'); time.sleep(9)", "is not msgpack"),
    "writes a huge head": ("os.write(4, b'\\xff' * 4); time.sleep(9)", "4294967295 bytes"),
    "answers twice": (
        "os.write(4, b'\\x01\\0\\0\\0\\x80' * 2); time.sleep(9)", "more than one answer"
    ),
    "execs": ("os.execv('/bin/true', ['true'])", "exit code 0"),
}  # fmt: skip
RAISES = {
    "exits": ("sys.exit(3)", "step: SystemExit: 3"),
    "interrupts": ("raise KeyboardInterrupt", "step: KeyboardInterrupt"),
    "recursion": ("return self.step(obs)", "step: RecursionError"),
    "too large": ("return (10**400, 0)", "a command must be finite"),
    "not a number": ("return (float('nan'), 0)", "a command must be finite"),
    "nothing": ("return None", "step returned None (NoneType)"),
    "limits": ("obs.t = 3", "FrozenInstanceError"),
    "no truth": ("return (obs.truth.people[0, 0], 0)", "'NoneType' object has no attribute"),
}
ODD = """
import numbers
class Odd(numbers.Real):
    def __float__(self): raise SystemExit(1)
    def __repr__(self): raise KeyboardInterrupt
Odd.__abstractmethods__ = frozenset()
class Ugly:
    def __repr__(self): raise SystemExit
"""


@pytest.mark.parametrize("case", DEATHS)
def test_a_process_that_dies_or_talks_nonsense(case: str, tmp_path: Path) -> None:
    step, reason = DEATHS[case]
    open_before = descriptors()
    text = planner_text(f"{step}\n        return (0.1, 0.0)")
    with hosted(choose(tmp_path, text)) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    assert str(caught.value).startswith("planner 'Mine' (")
    assert reason in str(caught.value)
    assert caught.value.exit_code == 3
    assert descriptors() <= open_before + 1  # the server's line, where it was the first


def test_a_crash_tells_its_line(tmp_path: Path) -> None:
    text = planner_text("ctypes.string_at(0)")
    with hosted(choose(tmp_path, text)) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    assert "__init__.py:" in str(caught.value)


@pytest.mark.parametrize("case", RAISES)
def test_a_planner_that_raises_says_what_it_would_say_in_process(case: str, tmp_path: Path) -> None:
    step, reason = RAISES[case]
    with hosted(choose(tmp_path, planner_text(step))) as host, pytest.raises(PlannerError) as e:
        host.step(observation())
    assert reason in str(e.value)
    assert "mine.py:" in str(e.value) or "returned" in str(e.value)


def test_a_debugger_says_what_it_needs(tmp_path: Path) -> None:
    choice = choose(tmp_path, planner_text("breakpoint()"))
    with hosted(choice) as host, pytest.raises(PlannerError, match="the planner run --in-process"):
        host.step(observation())


@pytest.mark.parametrize(
    ("step", "reason"),
    [
        ("return (Odd(), 0.0)", "step: SystemExit: 1"),
        ("return Ugly()", "repr raises SystemExit (Ugly)"),
    ],
)
def test_numbers_and_texts_that_run_code(step: str, reason: str, tmp_path: Path) -> None:
    choice = choose(tmp_path, planner_text(step, top=ODD))
    with hosted(choice) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    assert reason in str(caught.value)


@pytest.mark.slow
@pytest.mark.parametrize(
    "step",
    [
        "while True: pass",
        "ctypes.PyDLL(None).sleep(1000)  # keeps the interpreter lock",
        "time.sleep(1000)",
        "signal.signal(signal.SIGABRT, signal.SIG_IGN); time.sleep(1000)",
        "os.kill(os.getpid(), signal.SIGSTOP)",
    ],
)
def test_a_step_that_never_returns(
    step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    choice = choose(tmp_path, planner_text(step))
    with hosted(choice) as host:
        monkeypatch.setattr(Watchdog.__init__, "__defaults__", (0.3, 1.0, None))
        with pytest.raises(PlannerError, match=r"did not return from step within 0\.3 s; its pro"):
            host.step(observation())


def test_a_loop_is_named_with_its_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with hosted(choose(tmp_path, planner_text("while True: pass"))) as host:
        monkeypatch.setattr(Watchdog.__init__, "__defaults__", (0.3, 1.0, None))
        with pytest.raises(PlannerError, match=r"mine\.py:7\)"):
            host.step(observation())


@pytest.mark.slow
def test_memory_is_limited(tmp_path: Path) -> None:
    text = planner_text("self.much = b'x' * (3 << 30); return (0.1, 0.0)")
    small = choose(tmp_path, text, PlannerPlace(memory=1 << 30))
    with hosted(small) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    assert "step: MemoryError" in str(caught.value)
    assert "limit of its memory is 1 GiB" in str(caught.value)


CHILDREN = """
def run_away():
    if os.fork() == 0:
        os.setsid()
        if os.fork():
            os._exit(0)
        open(os.path.expanduser("~/{file}"), "w").write(str(os.getpid()))
        time.sleep(1000)
"""


def test_children_do_not_outlive_it(tmp_path: Path) -> None:
    """One in a session of its own, whose parent is gone, and one that holds all pipes."""
    child = "self.child = subprocess.Popen(['sleep', 'infinity'], close_fds=False)"
    choice = choose(
        tmp_path,
        planner_text(f"run_away(); {child}; return (float(self.child.pid), 0.0)",
                     top=CHILDREN.format(file=tmp_path.name)),
    )  # fmt: skip
    with hosted(choice) as host:
        host.step(observation())
        away = int(left(tmp_path.name).read_text())
        assert is_alive(away)
    assert not is_alive(away)  # it would never end by itself, and nobody waited for it
    assert sum("sleep" in _name(pid) for pid in below(os.getpid())) == 0


def _name(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/comm").read_text()
    except OSError:
        return ""


def test_threads_that_never_end_keep_nobody(tmp_path: Path) -> None:
    spin = "threading.Thread(target=lambda: time.sleep(1000)).start()"
    with hosted(choose(tmp_path, planner_text(f"{spin}; return (0.1, 0.0)"))) as host:
        assert host.step(observation()).command.v == 0.1
    assert not below(os.getpid()) or all("python" not in _name(p) for p in _planners())


def _planners() -> list[int]:
    """All that servers started; a server is below its guard."""
    guards = below(os.getpid())
    return [p for guard in guards for server in below(guard) for p in below(server)]


def _parent(pid: int) -> int:
    try:
        return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


@pytest.mark.slow
def test_the_one_that_started_it_may_be_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a planner that nothing contains."""
    death = "the one that had started it"
    with older_kernel(monkeypatch):
        choice = choose(tmp_path, planner_text("os.kill(os.getppid(), 9); time.sleep(1000)"))
        with hosted(choice) as host, pytest.raises(PlannerError, match=death):
            host.step(observation())
        fine = choose(tmp_path, planner_text())
        with hosted(fine) as host:  # there is another one
            assert host.step(observation()).command.v == 0.3


SIMULATOR = """
HOME = os.path.expanduser("~/")
def parent(pid):
    return int(open(f"/proc/{pid}/stat").read().rpartition(")")[2].split()[1])
def look_into(pid, how):
    if how == "ptrace":  # PTRACE_SEIZE
        return ctypes.CDLL(None).ptrace(0x4206, pid, None, None)
    return open(f"/proc/{pid}/{how}", "r+b" if how == "mem" else "rb").read(0)
def above(levels):
    pid = os.getpid()
    for _ in range(levels):
        pid = parent(pid)
    return pid
"""


@pytest.mark.parametrize("above", [1, 3], ids=["server", "simulator"])
@pytest.mark.parametrize("how", ["mem", "ptrace"])
def test_it_cannot_look_into_others(
    how: str, above: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever can write to the simulator's memory can be as fast as it likes."""
    look = f"print(look_into(above({above}), {how!r}), file=open(HOME + {tmp_path.name!r}, 'w'))"
    with older_kernel(monkeypatch):  # by which it learns its ancestors
        choice = choose(tmp_path, planner_text(f"{look}; return (0.1, 0.0)", top=SIMULATOR))
        with hosted(choice) as host:
            if how == "mem":
                with pytest.raises(PlannerError, match="step: PermissionError"):
                    host.step(observation())
            else:
                host.step(observation())
                assert left(tmp_path.name).read_text() == "-1\n"


def test_nothing_that_it_starts_has_the_right_to(tmp_path: Path) -> None:
    """All capabilities but two, to read files, of whatever set."""
    home = f"os.path.expanduser('~/{tmp_path.name}')"
    keep = f"open({home}, 'w').write(open('/proc/self/status').read())"
    with hosted(choose(tmp_path, planner_text(f"{keep}; return (0.1, 0.0)"))) as host:
        host.step(observation())
        lines = [line.split() for line in left(tmp_path.name).read_text().splitlines()]
    sets = {words[0]: int(words[1], 16) for words in lines if words[0].startswith("Cap")}
    assert {"CapEff:", "CapPrm:", "CapInh:", "CapAmb:"} <= set(sets)
    del sets["CapBnd:"]  # of somebody without privileges it stays as it is
    assert not any(value & ~(1 << 1 | 1 << 2) for value in sets.values())
    assert ["NoNewPrivs:", "1"] in lines


@pytest.mark.parametrize("then", ["return (0.1, 0.0)", "os._exit(0)", "time.sleep(1000)"])
def test_the_one_that_started_it_may_be_stopped(
    then: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The campaign goes on, and the next planner finds the same server."""
    stop = f"os.kill(os.getppid(), signal.SIGSTOP)\n        {then}"
    with older_kernel(monkeypatch):
        with hosted(choose(tmp_path, planner_text(stop))) as host:
            server = next(p for p in below(os.getpid()) if p in map(_parent, _planners()))
            monkeypatch.setattr(Watchdog.__init__, "__defaults__", (0.3, 1.0, None))
            with suppress(PlannerError):
                host.step(observation())
        with hosted(choose(tmp_path, planner_text())) as host:
            assert host.step(observation()).command.v == 0.3
            assert server in map(_parent, _planners())


@pytest.mark.slow
def test_a_server_that_stays_stopped_is_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever goes on stopping it does so until the server is killed, and it with that."""
    monkeypatch.setattr("crowdbot.core.planning.process.server_handle._GOES", 0.5)
    stop = "\n        while True: os.kill(os.getppid(), signal.SIGSTOP)"
    monkeypatch.setattr(Watchdog.__init__, "__defaults__", (0.3, 1.0, None))
    with older_kernel(monkeypatch):
        with hosted(choose(tmp_path, planner_text(stop))) as host, pytest.raises(PlannerError):
            host.step(observation())
        with hosted(choose(tmp_path, planner_text())) as host:
            assert host.step(observation()).command.v == 0.3


@pytest.mark.parametrize(("step", "reason"), [
    (r"raise ValueError('\x1b[2J \x00 \u202e')", r"step: ValueError: \x1b[2J \x00 \u202e ("),
    (r"raise ValueError('\ud800')", r"step: ValueError: \ud800 ("),
    (r"raise type('A\x1b\n', (Exception,), {})('hi')", "step: A\\x1b\n: hi"),
    ("raise ValueError('x' * 10_000_000)", "step: ValueError: xxxx"),
    (r"obs.log('\ud800', 1.0)", "log: the name of a signal is at most 200 characters"),
    (r"obs.log('\x1b[2J', 1.0)", "log: the name of a signal is at most 200 characters"),
    ("obs.log('x' * 201, 1.0)", "log: the name of a signal is at most 200 characters"),
])  # fmt: skip
def test_reasons_can_be_shown_and_written(step: str, reason: str, tmp_path: Path) -> None:
    with hosted(choose(tmp_path, planner_text(step))) as host, pytest.raises(PlannerError) as e:
        host.step(observation())
    text = str(e.value)
    assert reason in text
    assert hidden_character(text, allowed="\n") == ""
    assert len(text) < 3000


def test_a_flood_of_output_is_cut(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = planner_text("print('x' * 5_000_000); print('end'); return (0.1, 0.0)")
    with hosted(choose(tmp_path, text)) as host:
        assert host.step(observation()).command.v == 0.1
    shown = capsys.readouterr()
    assert shown.out == ""
    assert len(shown.err) < 1_100_000
    assert "printed more than 1 MB" in shown.err


def test_what_it_prints_goes_to_stderr(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    say = "print('a'); os.write(1, b'b\\n'); ctypes.CDLL(None).puts(b'c'); os.system('echo d')"
    with hosted(choose(tmp_path, planner_text(f"{say}; return (0.1, 0.0)"))) as host:
        host.step(observation())
    shown = capsys.readouterr()
    assert shown.out == ""
    assert sorted(shown.err.split()) == ["a", "b", "c", "d"]


def test_its_limits_are_not_the_hosts(tmp_path: Path) -> None:
    grab = "object.__setattr__(limits, 'v_max', 50.0)"
    with hosted(choose(tmp_path, planner_text("return (50.0, 0.0)", reset=grab))) as host:
        answer = host.step(observation())
    assert answer.command.v == LIMITS.v_max
    assert answer.clamped


def test_nothing_of_one_is_left_for_the_next(tmp_path: Path) -> None:
    text = planner_text(
        "print(getattr(sys, 'left', 'nothing')); sys.left = 'much'; return (0.1, 0.0)",
        reset="assert not hasattr(sys, 'left')",
    )
    choice = choose(tmp_path, text)
    for _ in range(3):
        with hosted(choice) as host:
            host.step(observation())


@pytest.mark.slow
def test_an_answer_before_the_question(tmp_path: Path) -> None:
    """Who answers in advance would have taken no time."""
    import msgpack

    raw = msgpack.packb({"type": "command", "step": 2, "v": 0.1, "w": 0.0})
    early = f"os.write(4, {len(raw).to_bytes(4, 'little') + raw!r})"
    late = f"threading.Timer(0.2, lambda: {early}).start()"
    with hosted(choose(tmp_path, planner_text(f"{late}; return (0.1, 0.0)"))) as host:
        host.step(observation())
        time.sleep(0.6)
        with pytest.raises(PlannerError, match="answered before it was asked"):
            host.step(observation())


@pytest.mark.parametrize("top", ["os._exit(5)", "ctypes.string_at(0)", "os.kill(os.getpid(), 9)"])
def test_one_that_dies_while_it_is_imported_fails_in_every_run(top: str, tmp_path: Path) -> None:
    choice = choose(tmp_path, planner_text(top=top))
    assert not choice.in_process
    with pytest.raises(PlannerError, match="did not load: its process"):
        choice.build()


def test_an_import_that_raises_is_told_at_once_but_in_a_campaign(tmp_path: Path) -> None:
    text = planner_text(top="import no_such_module")
    with pytest.raises(PlannerError, match="no_such_module"):
        choose(tmp_path, text)
    choice = choose(tmp_path, text, PlannerPlace(lenient=True))
    with pytest.raises(PlannerError, match="no_such_module"):
        choice.build()


def test_servers_are_used_again(tmp_path: Path) -> None:
    choice = choose(tmp_path, planner_text())
    before = [p for p in below(os.getpid()) if "python" in _name(p)]
    for _ in range(5):
        with hosted(choice) as host:
            host.step(observation())
    assert [p for p in below(os.getpid()) if "python" in _name(p)] == before
    assert POOL is not None
