"""Planners compile in ``reset``: no step of a run waits for the compiler."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

#: In a process of its own, since elsewhere another test has compiled already.
PROGRAM = """
import gc
import importlib
import math

from numba.core.registry import CPUDispatcher

from crowdbot.core.registry.build_reference import load_build
from tests.plugins.planners.world import World, crowd

def compiled():
    functions = [f for f in gc.get_objects() if isinstance(f, CPUDispatcher)]
    return {f"{f.__module__}.{f.__name__}": list(f.signatures)
            for f in functions if f.__module__.startswith("crowdbot.plugins.planners")}

class Watched:
    def __init__(self, planner):
        self.planner, self.step = planner, planner.step

        self.compiled = {}

    def reset(self, *given):
        assert self.compiled or not any(compiled().values())
        self.planner.reset(*given)
        self.compiled = self.compiled or compiled()

component = importlib.import_module("crowdbot.plugins.planners.KIND.KIND").NAME
planner = Watched(load_build(component)(component.spec()))
around = [[2.5 + 1.2 * math.cos(a), 1.2 * math.sin(a), 0.0, 0.0] for a in range(12)]
World(crowd(1, 50, (0.8, 1.6), (1, -1))).run(planner, time_limit=4.0)
World(around).run(planner, time_limit=12.0)  # nobody lets it out: it looks for a way
assert any(planner.compiled.values())
late = [name for name, ready in planner.compiled.items() if compiled()[name] != ready]
assert not late, late
"""


@pytest.mark.parametrize("kind", ["dwa", "stop_and_go"])
def test_no_step_compiles(kind: str) -> None:
    code = PROGRAM.replace("KIND", kind).replace("NAME", kind.upper())
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
