"""A second process compiles what a run needs: the same functions for the same types."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

#: In a process of its own, since elsewhere other tests have compiled other types already.
PROGRAM = """
import gc
import crowdbot
from crowdbot.core.crowd.compile_ahead import compile_ahead
from numba.core.registry import CPUDispatcher

DEAR = {"step.ticks_without_robots", "step.tick", "velocity_search.sampling.choose_velocities",
        "velocity_search.surroundings.sort_surroundings",
        "response.evasion.evade_robots"}

def compiled():
    functions = [f for f in gc.get_objects() if isinstance(f, CPUDispatcher)]
    named = {f"{f.__module__}.{f.__name__}".removeprefix("crowdbot.core.crowd."): f
             for f in functions}
    return {name: list(named[name].overloads) for name in sorted(DEAR)}

compile_ahead()
ahead = compiled()
assert all(ahead.values()), ahead
scenario = crowdbot.load("challenge-2020", "counter-d0250-dispersed-c20-r05",
                         set="robots.robot.task.time_limit=0.25")
crowdbot.simulate(scenario, planner="goal_seek")
more = {name: types for name, types in compiled().items() if types != ahead[name]}
assert not more, more
"""


def test_it_is_what_a_run_needs() -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
