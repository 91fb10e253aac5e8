"""A campaign on a real Dask scheduler with two workers, one of which is killed."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.campaign_cases import outcome, run, start
from tests.waiting import AT_MOST, wait_until

pytestmark = pytest.mark.slow


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _listens(address: str) -> bool:
    host, _, port = address.removeprefix("tcp://").partition(":")
    with socket.socket() as probe:
        return probe.connect_ex((host, int(port))) == 0


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    dask = str(Path(sys.executable).with_name("dask"))
    address = f"tcp://127.0.0.1:{_free_port()}"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    scheduler = subprocess.Popen(
        [dask, "scheduler", "--host", address, "--no-dashboard"], **quiet  # type: ignore[call-overload]
    )  # fmt: skip
    command = [dask, "worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    workers = [
        subprocess.Popen([*command, "--local-directory", str(tmp_path / str(i))], **quiet)  # type: ignore[call-overload]
        for i in range(2)
    ]
    try:
        wait_until(lambda: _listens(address))
        yield address, workers
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()


def test_a_killed_worker_changes_nothing(
    cluster: tuple[str, list[subprocess.Popen[bytes]]], tmp_path: Path
) -> None:
    address, workers = cluster
    out = tmp_path / "runs"
    running = start(out, "--planner", "goal_seek", "--cluster", address)
    wait_until(lambda: running.poll() is not None or list(out.rglob("*.partial")))
    os.kill(workers[0].pid, signal.SIGKILL)
    output, err = running.communicate(timeout=AT_MOST)
    assert running.returncode == 0, output + err
    local = tmp_path / "local"
    assert run(local, "--planner", "goal_seek")[0] == 0
    assert len(outcome(out)) == 3
    assert outcome(out) == outcome(local)
