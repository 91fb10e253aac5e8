"""What the first run compiles: processor time and functions, by file.

Simulates one second of a challenge scenario with ``dwa`` into an empty folder of compiled
functions; what is compiled already stays as it is. Run: ``python benchmarks/compiling.py
[--all] [--again] [--ahead]``: all files instead of the dearest twenty, and each function; a second
run in the same folder, which should compile nothing; with the second process that a first run
starts where it has two cores, which leaves the crowd's functions out of the list.
"""

from __future__ import annotations

import argparse
import importlib
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")

SCENARIO = ("challenge-2020", "counter-d0250-dispersed-c20-r05")


class Compilations:
    """Listens to numba: processor time of each function, without those that it calls."""

    def __init__(self) -> None:
        self.seconds: defaultdict[tuple[str, str], float] = defaultdict(float)
        self.count: Counter[tuple[str, str]] = Counter()
        self._open: list[list[float]] = []  # begin, and seconds of what was compiled within

    def on_start(self, _: Any) -> None:
        """A function is going to be compiled."""
        self._open.append([time.process_time(), 0.0])

    def on_end(self, event: Any) -> None:
        """It is."""
        begin, within = self._open.pop()
        whole = time.process_time() - begin
        if self._open:
            self._open[-1][1] += whole
        function = event.data["dispatcher"].py_func
        key = function.__module__, function.__qualname__
        self.seconds[key] += whole - within
        self.count[key] += 1


def measure(every: bool, ahead: bool) -> None:
    """Simulate in this process and print what was compiled."""
    import crowdbot
    import crowdbot.core  # tells numba where compiled functions go, before it is imported
    from crowdbot.core.support.compiling import compile_ahead

    if not ahead:
        setattr(compile_ahead, "available_cores", lambda: 1)  # noqa: B010

    event = importlib.import_module("numba.core.event")

    heard = Compilations()
    methods = {"on_start": lambda _, e: heard.on_start(e), "on_end": lambda _, e: heard.on_end(e)}
    event.register("numba:compile", type("Listener", (event.Listener,), methods)())
    scenario = crowdbot.load(*SCENARIO, set="robots.robot.task.time_limit=1")
    before, begin = time.process_time(), time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        run = crowdbot.simulate(scenario, planner="dwa", out=folder)
        cpu, wall = time.process_time() - before, time.perf_counter() - begin
        print(f"trajectories {run.record.hashes.trajectory}")
    files: defaultdict[str, float] = defaultdict(float)
    numbers: Counter[str] = Counter()
    for key, seconds in heard.seconds.items():
        files[key[0]] += seconds
        numbers[key[0]] += heard.count[key]
    for module, seconds in _dearest(files)[: None if every else 20]:
        print(f"{seconds:7.2f} s {numbers[module]:4d}  {module}")
    if every:
        for key, seconds in _dearest(heard.seconds):
            print(f"{seconds:7.2f} s {heard.count[key]:4d}  {'.'.join(key)}")
    print(
        f"{sum(files.values()):7.2f} s {sum(numbers.values()):4d}  all; the run with it "
        f"{cpu:.2f} s of processor time, {wall:.2f} s elapsed"
    )
    if ahead:
        other = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"{other.ru_utime + other.ru_stime:7.2f} s       in the second process")


def _dearest(seconds: Mapping[T, float]) -> list[tuple[T, float]]:
    return sorted(seconds.items(), key=lambda item: -item[1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--ahead", action="store_true")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.here:
        measure(asked.all, asked.ahead)
        return
    print(f"load {os.getloadavg()[0]:.1f}", flush=True)
    with tempfile.TemporaryDirectory() as kernels:
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(Path(kernels))}
        for _ in range(1 + asked.again):
            options = [f"--{name}" for name in ("all", "ahead") if getattr(asked, name)]
            command = [sys.executable, __file__, "--here", *options]
            subprocess.run(command, env=environment, check=True)


if __name__ == "__main__":
    main()
