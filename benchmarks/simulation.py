"""How fast is the simulation, and where does the time go?

Runs the challenge's corridor with several numbers of people, recording on, and, interleaved with
it, the multibody plant alone: the floor that Drake sets. Prints CPU time per simulated second.

    python benchmarks/simulation.py --agents 0,50,100,200 --seconds 20 --planner dwa
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from crowdbot.api import registry
from crowdbot.core.library import open_spec, pick
from crowdbot.core.lock import population
from crowdbot.core.planner_source import resolve_planner
from crowdbot.core.sim.control.differential_drive import WHEEL_GAINS
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.diagram import robot_task
from crowdbot.core.sim.metric_logger import MetricLogger
from crowdbot.core.sim.planner_system import PlannerSystem
from crowdbot.core.sim.plant import add_plant, place_robot
from crowdbot.core.sim.record import record_robot
from crowdbot.core.sim.record_crowd import RunSetup
from crowdbot.core.sim.recorder import Recorder
from crowdbot.core.sim.robot_state import RobotStateSystem
from crowdbot.core.sim.sensor_bank import SensorBank
from crowdbot.dsl.scenario import Scenario

DENSITY = {50: "d0125", 100: "d0250", 200: "d0500"}
#: Each block's event. Writing a row to the recording counts for the block that hands it over.
EVENTS: dict[str, tuple[type[Any], str]] = {
    "crowd": (CrowdSystem, "_update"),
    "sensors": (SensorBank, "_update"),
    "planner": (PlannerSystem, "_update"),
    "logger": (MetricLogger, "_publish"),
    "recorder": (Recorder, "_publish"),
    "robot state": (RobotStateSystem, "_calc"),
}


def scenario(agents: int, seconds: float) -> Scenario:
    name = f"counter-{DENSITY.get(agents, 'd0125')}-dispersed-c20-r05"
    suite = open_spec("challenge-2020", registry(), [f"robots.robot.task.time_limit={seconds}"])
    found = pick(suite, name)
    return found if agents else found.model_copy(update={"crowd": None})


def whole(world: Scenario, planner: str) -> float:
    """CPU ms per simulated second of a recorded run."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = record_robot(
            RunSetup(
                scenario=world,
                agents=population(world, registry()).agents,
                registry=registry(),
                choice=resolve_planner(planner, registry()),
                seed=0,
                recording=Path(folder) / "run.mcap",
                record="all",
                stage="benchmark",
                progress=None,
                stop=lambda: False,
                on_hang=None,
            )
        )
    return 1e3 * outcome.cpu_time / outcome.sim_time


def plant_alone(world: Scenario, seconds: float) -> float:
    """CPU ms per simulated second of the robot in its corridor, wheels turning."""
    (robot,) = world.robots.values()
    builder = DiagramBuilder()
    parts = registry().build(world.environment)
    rig = add_plant(builder, parts, registry().build(robot.model), WHEEL_GAINS)
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
    originals = {name: getattr(kind, method) for name, (kind, method) in EVENTS.items()}
    for name, (kind, method) in EVENTS.items():
        setattr(kind, method, _timed(name, originals[name], spent))
    try:
        yield
    finally:
        for name, (kind, method) in EVENTS.items():
            setattr(kind, method, originals[name])


def _timed(name: str, event: Callable[..., Any], spent: Counter[str]) -> Callable[..., Any]:
    def timed(*args: Any) -> Any:
        begin, inner = time.thread_time_ns(), spent.total()
        answer = event(*args)
        # What another block computed meanwhile is that block's.
        spent[name] += time.thread_time_ns() - begin - (spent.total() - inner)
        return answer

    return timed


def measure(world: Scenario, planner: str, seconds: float) -> list[float]:
    """The run, the plant alone, then each block in another run; CPU ms per simulated second."""
    total, floor = whole(world, planner), plant_alone(world, seconds)
    spent: Counter[str] = Counter()
    with profiled(spent):
        whole(world, planner)
    return [total, floor, *(spent[name] / 1e6 / seconds for name in EVENTS)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--agents", default="0,50,100,200")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--planner", default="dwa")
    parser.add_argument("--repeat", type=int, default=3, help="the best of so many counts")
    given = parser.parse_args()
    counts = [int(n) for n in given.agents.split(",")]
    if not set(counts) <= {0, *DENSITY}:
        parser.error(f"--agents: the challenge has 0, {', '.join(map(str, DENSITY))}")

    columns = ("agents", "ms/s", "x real time", "plant alone", "ratio", *EVENTS)
    print(" ".join(f"{column:>11}" for column in columns))
    for agents in counts:
        world = scenario(agents, given.seconds)
        whole(scenario(agents, 1.0), given.planner)  # compiles
        runs = [measure(world, given.planner, given.seconds) for _ in range(given.repeat)]
        total, floor, *parts = (min(column) for column in zip(*runs, strict=True))
        row = (total, 1e3 / total, floor, total / floor, *parts)
        print(f"{agents:11}", " ".join(f"{number:11.1f}" for number in row), flush=True)


if __name__ == "__main__":
    main()
