"""How fast is the simulation, and where does the time go?

Runs the challenge's corridor with several numbers of people, without camera, with a depth camera
and, where EGL is there, with colour images, recording on; and, interleaved with it, the multibody
plant alone: the floor that Drake sets. Prints CPU time per simulated second. All is measured as a
campaign does it: in a process with the environment of a worker, that is on one thread and with
its settings of the C library's allocator (``--here`` leaves the environment as it is). What a
camera adds to a run is worked out apart, by runs that take turns (`turns.py`): the last column.

    python benchmarks/simulation.py
    python benchmarks/simulation.py --planner dwa --record used --agents 100
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Literal

from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource
from turns import WARM_UP, in_turns

from crowdbot.api import registry
from crowdbot.core.campaign.worker_process import worker_environment
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.task import robot_task
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.scenarios.lock import population
from crowdbot.core.sim.built_run import build_runs
from crowdbot.core.sim.cameras.rendering import check_egl
from crowdbot.core.sim.control.differential_drive import wheel_gains
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.loggers.metric_logger import MetricLogger
from crowdbot.core.sim.planner_system import PlannerSystem
from crowdbot.core.sim.plant import add_plant, place_robot
from crowdbot.core.sim.record import record_robots
from crowdbot.core.sim.robot_state import RobotStateSystem
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.core.sim.sensor_bank import SensorBank
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import MissingLibraryError

#: What is laid over the robot's camera, by what is to be measured.
CAMERAS = {
    "none": "robots.robot.sensors.camera=null",
    "depth": "robots.robot.sensors.camera.colour=false",
    "colour": "robots.robot.sensors.camera.colour=true",
}
DENSITY = {50: "d0125", 100: "d0250", 200: "d0500"}
#: The blocks, and the methods in which they work.
EVENTS: tuple[tuple[str, type[Any], str], ...] = (
    ("crowd", CrowdSystem, "_update"),
    ("sensors", SensorBank, "_update"),
    ("camera", SensorBank, "_take_frame"),
    ("planner", PlannerSystem, "_update"),
    ("logger", MetricLogger, "_publish"),
    ("recorder", RecordingWriter, "_catch_up"),
    ("recorder", McapFile, "_finish_chunk"),
    ("robot state", RobotStateSystem, "_calc"),
)
BLOCKS = tuple(dict.fromkeys(name for name, _, _ in EVENTS))


@dataclass(frozen=True, slots=True)
class Case:
    """What is run: people, camera, planner, what is recorded, and for how long (s)."""

    agents: int
    camera: str
    planner: str
    record: Literal["all", "used", "none"]
    seconds: float

    def scenario(self) -> Scenario:
        """The cell of the challenge, with or without people."""
        limit = f"robots.robot.task.time_limit={self.seconds}"
        suite = open_spec("challenge-2020", registry(), [limit, CAMERAS[self.camera]])
        found = pick(suite, f"counter-{DENSITY.get(self.agents, 'd0125')}-dispersed-c20-r05")
        return found if self.agents else found.model_copy(update={"crowd": None})


def whole(case: Case) -> float:
    """CPU ms per simulated second of a recorded run."""
    world, choice = case.scenario(), resolve_planner(case.planner, registry())
    with tempfile.TemporaryDirectory() as folder:
        setup = RunSetup(
            scenario=world,
            agents=population(world, registry()).agents,
            registry=registry(),
            choice=choice,
            seed=0,
            recording=Path(folder) / "run.mcap",
            options=RunOptions(record=case.record),
            stage="benchmark",
            progress=None,
            stop=lambda: False,
            on_hang=None,
        )
        builts = build_runs(world, registry(), choice, case.record)
        outcome = record_robots(setup, builts)
    return 1e3 * outcome.cpu_time / outcome.sim_time


def plant_alone(world: Scenario, seconds: float) -> float:
    """CPU ms per simulated second of the robot in its corridor, wheels turning."""
    (robot,) = world.robots.values()
    builder = DiagramBuilder()
    parts = build_environment(registry(), world.environment)
    rig = add_plant(builder, parts, build_model(registry(), robot.model), wheel_gains(6.3, 0.0352))
    wheels = builder.AddSystem(ConstantVectorSource([0.0, 0.0, 10.0, 10.0]))
    desired = rig.plant.get_desired_state_input_port(rig.model)
    builder.Connect(wheels.get_output_port(), desired)
    simulator = Simulator(builder.Build())
    context = rig.plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    place_robot(rig, context, robot_task(robot, parts).start)
    simulator.Initialize()
    begin = time.process_time()
    simulator.AdvanceTo(seconds)
    return 1e3 * (time.process_time() - begin) / seconds


@contextmanager
def profiled(spent: Counter[str]) -> Iterator[None]:
    """Add up the CPU time within each block's event."""
    originals = [getattr(kind, method) for _, kind, method in EVENTS]
    for (name, kind, method), original in zip(EVENTS, originals, strict=True):
        setattr(kind, method, _timed(name, original, spent))
    try:
        yield
    finally:
        for (_, kind, method), original in zip(EVENTS, originals, strict=True):
            setattr(kind, method, original)


def _timed(name: str, event: Callable[..., Any], spent: Counter[str]) -> Callable[..., Any]:
    def timed(*args: Any) -> Any:
        begin, inner = time.process_time_ns(), spent.total()
        answer = event(*args)
        # What another block computed meanwhile is that block's.
        spent[name] += time.process_time_ns() - begin - (spent.total() - inner)
        return answer

    return timed


def parts_of(case: Case) -> list[float]:
    """The plant alone, then each block in another run; CPU ms per simulated second."""
    floor, spent = plant_alone(case.scenario(), case.seconds), Counter[str]()
    with profiled(spent):
        whole(case)
    return [floor, *(spent[name] / 1e6 / case.seconds for name in BLOCKS)]


def measure(cases: Sequence[Case], repeat: int) -> dict[Case, list[float]]:
    """The least that was counted of each case: whole run, plant alone, blocks.

    Cases take turns, for the machine may have other work to do.
    """
    wholes: dict[Case, list[float]] = {case: [] for case in cases}
    parts: dict[Case, list[list[float]]] = {case: [] for case in cases}
    for case in cases:
        whole(replace(case, seconds=1.0))  # compiles
    for _ in range(repeat):
        for case in cases:
            wholes[case].append(whole(case))
            parts[case].append(parts_of(case))
    return {c: [min(wholes[c]), *(min(p) for p in zip(*parts[c], strict=True))] for c in cases}


def row(case: Case, best: Sequence[float]) -> list[float]:
    """What is printed of the best numbers: the last is CPU time per image, ms."""
    total, floor, *parts = best
    camera = case.scenario().robots["robot"].sensors.get("camera")
    rate = 0.0 if camera is None else float(getattr(camera, "rate", 0.0))
    image = parts[BLOCKS.index("camera")] / rate if rate else 0.0
    return [total, 1e3 / total, floor, total / floor, *parts, image]


def cameras() -> list[str]:
    """What can be measured here."""
    try:
        check_egl()
    except MissingLibraryError as error:
        print(f"no colour: {error}", file=sys.stderr)
        return ["none", "depth"]
    return list(CAMERAS)


def become_worker() -> None:
    """Start anew with the environment of a worker, unless this process has it."""
    wanted = worker_environment()
    if not wanted.items() <= os.environ.items():
        os.execve(sys.executable, sys.orig_argv, wanted)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--agents", default="0,50,100,200")
    parser.add_argument("--cameras", help=f"some of {','.join(CAMERAS)}; default: all there are")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--planner", default="goal_seek")
    parser.add_argument("--record", choices=("all", "used", "none"), default="all")
    parser.add_argument("--here", action="store_true", help="in the environment as it is")
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many rounds")
    given = parser.parse_args()
    if not given.here:
        become_worker()
    if given.seconds <= WARM_UP or given.repeat < 1:
        parser.error(f"--seconds: more than {WARM_UP}; --repeat: at least 1")
    counts = [int(n) for n in given.agents.split(",")]
    if not set(counts) <= {0, *DENSITY}:
        parser.error(f"--agents: the challenge has 0, {', '.join(map(str, DENSITY))}")
    kinds = given.cameras.split(",") if given.cameras else cameras()
    if not set(kinds) <= set(CAMERAS):
        parser.error(f"--cameras: {', '.join(CAMERAS)}")

    columns = ("ms/s", "x real time", "plant alone", "ratio", *BLOCKS, "ms/image", f"x {kinds[0]}")
    print(f"{'agents':>6} {'camera':>6}", " ".join(f"{column:>11}" for column in columns))
    for agents in counts:
        cases = [Case(agents, kind, given.planner, given.record, given.seconds) for kind in kinds]
        least = measure(cases, given.repeat)
        spent = in_turns({case.camera: partial(whole, case) for case in cases}, given.repeat)
        for case, best in least.items():
            numbers = [*row(case, best), spent[case.camera] / spent[kinds[0]]]
            shown = " ".join(f"{n:11.2f}" for n in numbers)
            print(f"{agents:6} {case.camera:>6}", shown)


if __name__ == "__main__":
    main()
