r"""What a step of each planner costs among 200 people, and if its memory grows.

Drives a robot through the densest crowd of the 2020 challenge by each planner in turn, and
prints the processor time of one step, and the growth of memory after the first fifth:

    python benchmarks/planner_steps.py --steps 1000
    python benchmarks/planner_steps.py --planner orca --planner crowd_prediction

Times are of the calling thread, so that other processes hardly count; what a planner starts in
other threads is not in them. The last column is the median over that of the first planner.
"""

from __future__ import annotations

import argparse
import gc
import os
import time
from pathlib import Path
from typing import Any

import numpy as np

import crowdbot
from crowdbot.core.registry.build_reference import load_build
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.errors import PluginError
from crowdbot.plugin import NoValidCommand

SPEC = ("challenge-2020", "in-d0500-dispersed-c20-r05")
PLANNERS = (
    "dwa", "stop_and_go", "rpp", "follow_the_gap", "vfh_plus", "social_force", "social_momentum",
    "orca", "rds", "people_mpc", "crowd_prediction", "mppi", "mpc", "navground", "crowd_model",
    "oracle",
)  # fmt: skip


def measure(registry: Registry, kind: str, steps: int) -> tuple[np.ndarray, float]:
    """Return the time of each step, s; growth of memory, bytes."""
    component = registry.find("planner", kind)
    spec = component.spec()
    planner: Any = load_build(component)(spec)
    scenario = crowdbot.load(*SPEC, set=["robots.robot.task.time_limit=600 s"])
    times: list[float] = []
    kept = 0
    with crowdbot.Session(
        scenario, sensors=tuple(spec.needs), privileged=getattr(spec, "privileged", False)
    ) as session:
        obs = session.reset()
        robot = next(iter(session.robots.values()))
        planner.reset(robot.task, robot.limits, robot.sensors, robot.planner_seed)
        while not session.done and len(times) < steps:
            begin = time.thread_time()
            try:
                command = planner.step(obs)
            except NoValidCommand:
                command = crowdbot.Command(0.0, 0.0)
            times.append(time.thread_time() - begin)
            obs = session.step(command)
            if len(times) == steps // 5:
                kept = resident()
    return np.array(times), float(resident() - kept)


def resident() -> int:
    """Return the memory of this process, bytes."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--planner", action="append", help="kind; repeatable")
    given = parser.parse_args()
    registry, first = discover(), 0.0
    print(f"{'planner':18}{'steps':>7}{'median ms':>11}{'p99 ms':>9}{'growth MB':>11}{'ratio':>8}")
    for kind in given.planner or PLANNERS:
        try:
            times, growth = measure(registry, kind, given.steps)
        except PluginError as error:
            print(error, flush=True)
            continue
        median, high = 1e3 * np.median(times), 1e3 * np.percentile(times[1:], 99)
        first = first or median
        print(
            f"{kind:18}{len(times):7}{median:11.2f}{high:9.2f}{growth / 1e6:11.1f}"
            f"{median / first:8.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
