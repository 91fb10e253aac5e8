"""The second process of a first run: when there is one, and that it never outlives the run."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from crowdbot.core.support.compiling import compile_ahead
from crowdbot.core.support.compiling.compile_ahead import compiled_ahead
from tests.core.planning.process.process_cases import is_alive
from tests.waiting import wait_until

MODULE = """
import os, pathlib, time
def compile_ahead():
    made = pathlib.Path(os.environ["CROWDBOT_TEST_PID"])
    made.with_suffix(".new").write_text(str(os.getpid()))
    made.with_suffix(".new").replace(made)
    {then}
"""
CALLER = """
import time
from crowdbot.core.support.compiling import compile_ahead
compile_ahead.available_cores = lambda: 2
with compile_ahead.compiled_ahead("compiles_slowly"):
    time.sleep(600)
"""


@pytest.fixture
def first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A first run on two cores: the file that will say which process the second one is."""
    (tmp_path / "compiles_slowly.py").write_text(MODULE.format(then="time.sleep(600)"))
    (tmp_path / "fails.py").write_text(MODULE.format(then="raise RuntimeError"))
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))
    monkeypatch.setenv("CROWDBOT_TEST_PID", str(tmp_path / "pid"))
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    monkeypatch.setattr(compile_ahead, "available_cores", lambda: 2)
    return tmp_path / "pid"


def _lives(pid: Path) -> bool:
    return is_alive(int(pid.read_text()))


def test_it_ends_with_the_block(first: Path) -> None:
    with compiled_ahead("compiles_slowly"):
        wait_until(first.exists)
        assert _lives(first)
    assert not _lives(first)


def test_it_ends_with_ctrl_c(first: Path) -> None:
    def run() -> None:
        with compiled_ahead("compiles_slowly"):
            wait_until(first.exists)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run()
    assert not _lives(first)


def test_it_ends_when_the_run_is_killed(first: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(first.parent)}
    run = subprocess.Popen([sys.executable, "-c", CALLER], env=environment)
    try:
        wait_until(first.exists)
    finally:
        run.kill()
        run.wait()
    wait_until(lambda: not _lives(first))


def test_one_that_does_not_listen_is_killed(first: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compile_ahead, "_GRACE", 0.1)
    with compiled_ahead("compiles_slowly"):
        wait_until(first.exists)
        os.kill(int(first.read_text()), signal.SIGSTOP)
    assert not _lives(first)


def test_the_run_goes_on_without_it(first: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with compiled_ahead("fails"):
        wait_until(lambda: first.exists() and not _lives(first))
    monkeypatch.setattr(sys, "executable", str(first.parent / "no_python"))
    with compiled_ahead("compiles_slowly"):
        pass


def test_there_is_none_where_it_is_of_no_use(first: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compile_ahead, "_started", lambda _: pytest.fail("started"))
    with monkeypatch.context() as changed:
        changed.setattr(compile_ahead, "available_cores", lambda: 1)
        with compiled_ahead("fails"):
            pass
    with monkeypatch.context() as changed:
        changed.setenv("NUMBA_DISABLE_JIT", "1")
        with compiled_ahead("fails"):
            pass
    (first.parent / "kernels").mkdir()
    (first.parent / "kernels" / "one.nbi").touch()
    with compiled_ahead("fails"):
        pass
