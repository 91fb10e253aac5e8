"""Nothing that a planner started is left, whichever of the processes above it is killed."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import pytest

from crowdbot.errors import PlannerError
from tests.core.planning.process.process_cases import (
    choose,
    hosted,
    is_alive,
    left,
    observation,
    planner_text,
)
from tests.waiting import wait_until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

#: It has a session of its own, no environment, and no living parent, but all of the pipes.
TOP = """
def run_away():
    planner = os.getpid()
    if os.fork() == 0:
        os.setsid()
        if os.fork():
            os._exit(0)
        open(os.path.expanduser("~/{name}"), "w").write(f"{{os.getpid()}} {{planner}}")
        os.execve("/bin/sleep", ["sleep", "999"], {{}})
"""


@pytest.mark.parametrize("killed", [["planner"], ["server"], ["guard"], ["guard", "server"]])
def test_what_is_left(killed: list[str], tmp_path: Path) -> None:
    step = "run_away(); time.sleep(0.5 if obs.t == 0 else 1000); return (0.1, 0.0)"
    with hosted(choose(tmp_path, planner_text(step, top=TOP.format(name=tmp_path.name)))) as host:
        host.step(observation())
        away, planner = map(int, left(tmp_path.name).read_text().split())
        server = _parent(planner)
        guard = _parent(server)
        pids = {"planner": planner, "server": server, "guard": guard}
        for name in killed:
            os.kill(pids[name], signal.SIGKILL)
        with pytest.raises(PlannerError):
            host.step(observation(1.0))
        wait_until(lambda: not is_alive(away), 4.0)
        assert not is_alive(planner)


def _parent(pid: int) -> int:
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
