"""How many steps of an environment a second does one thread make, beside peers?

A step is one period of the planner (1/16 s) of one world: decisions, contacts and motion of people,
the robot, a scan. Steps are counted per second of the process's own time, best of several rounds,
so that other programs disturb little. ``--ceiling`` adds as many processes as threads that know
nothing of each other: what the machine gives. Peers come with ``pip install ir-sim navground``;
those that are not installed are named. Each runs with its own model of people: what is compared is
the cost of a step.

    python benchmarks/rl_steps.py --people 20,100 --beams 0,180 --worlds 64
    python benchmarks/rl_steps.py --threads 1,2 --ceiling
    python benchmarks/rl_steps.py --growth
    python benchmarks/rl_steps.py --memory 1000000
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import math
import multiprocessing
import os
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

import crowdbot
from crowdbot.api import registry
from crowdbot.core.batch.array_tables import ScratchPool
from crowdbot.core.batch.blueprint import blueprint
from crowdbot.core.batch.parallel import Batches, parts_of
from crowdbot.core.batch.world import BatchWorld

#: Steps per second of the process's time, and of the clock.
Rate = tuple[float, float]

SUITE, SCENARIO, AREA = "challenge-2020", "counter-d0500-dispersed-c20-r05", 400.0
ROUNDS, ROUND = 12, 0.15  # number, s


def fields(people: int, beams: int) -> list[str]:
    """Changes to the scenario."""
    found = [f"crowd.flow.density={people / AREA}", "robots.robot.sensors.camera=null"]
    if beams:
        found.append(f"robots.robot.sensors.front_lidar.angle_step={240 / beams}deg")
    return found


def best(step: Callable[[], object], steps: int) -> Rate:
    """Steps per second of the process's time, and of the clock."""
    step()
    found = [0.0, 0.0]
    for _ in range(ROUNDS):
        own, clock, count = time.process_time(), time.perf_counter(), 0
        while time.perf_counter() - clock < ROUND:
            step()
            count += steps
        found[0] = max(found[0], count / (time.process_time() - own))
        found[1] = max(found[1], count / (time.perf_counter() - clock))
    return found[0], found[1]


def commands(worlds: int) -> Any:
    """One command (W, 1, 3) for each world."""
    rng = np.random.default_rng(1)
    found = rng.uniform([0.0, -0.3, 0.0], [0.65, 0.3, 1e-9], (worlds, 1, 3))
    return found * [1.0, 1.0, 0.0]


def longer(people: int) -> list[str]:
    """Changes to the scenario: a floor that grows with its people, at 0.05 per m^2."""
    end = 5 + 2 * people
    return [
        f"crowd.flow.density={20 / AREA}", "robots.robot.sensors.camera=null",
        f"environment.length={end + 5} m",
        f"environment.zones.crowd.x=[5 m, {end} m]",
        f"environment.zones.robot_goal.x=[{end} m, {end + 5} m]",
        f"environment.portals.b.x=[{end + 5} m, {end + 6} m]",
    ]  # fmt: skip


def kernels(people: int, beams: int, worlds: int, threads: int, *, same_room: bool = True) -> Rate:
    """The batch alone, without observation and reward; people may have a longer floor each."""
    changes = fields(people, beams) if same_room else longer(people)
    scenario = crowdbot.load(SUITE, SCENARIO, set=changes)
    plan = blueprint(scenario, registry(), ["front_lidar"] if beams else [])
    parts, made = parts_of(worlds, threads, people), []
    for begin, end in parts:
        pool = ScratchPool()
        made += [BatchWorld(plan, w + 1, pool) for w in range(begin, end)]
    batches, given = Batches(made, list(range(worlds)), parts), commands(worlds)
    return best(lambda: batches.step(given, np.arange(worlds)), worlds)


def environment(people: int, beams: int, worlds: int, threads: int) -> Rate | None:
    """The Gymnasium vector environment, with observation and reward."""
    if importlib.util.find_spec("gymnasium") is None:
        return None
    from crowdbot.rl import NavVectorEnv

    seen = {"kind": "lidar_stack", "sensor": "front_lidar", "sectors": 36} if beams else "tracks"
    env = NavVectorEnv(
        worlds, suite=SUITE, scenario=SCENARIO, set=fields(people, beams), observation=seen,
        draws=worlds, threads=threads,
    )  # fmt: skip
    env.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-1.0, 1.0, env.action_space.shape)
    return best(lambda: env.step(actions), worlds)


def apart(people: int, beams: int, worlds: int, start: float) -> float:
    """Steps per second of one batch in a process of its own, from a moment on."""
    time.sleep(max(0.0, start - time.time()))
    return kernels(people, beams, worlds, 1)[1]


def ceiling(people: int, beams: int, worlds: int, number: int) -> Rate:
    """Steps per second of several processes at once, each with its share of the worlds."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(number, mp_context=context) as pool:
        sizes = [(people, beams, worlds // number)] * number
        list(pool.map(kernels, *zip(*sizes, strict=True), [1] * number))  # compiles
        start = time.time() + 0.2
        found = sum(pool.map(apart, *zip(*sizes, strict=True), [start] * number))
    return math.nan, found  # their processor time is not this process's


def session(people: int, beams: int) -> Rate:
    """A whole simulation, stepped from outside."""
    scenario = crowdbot.load(SUITE, SCENARIO, set=fields(people, beams))
    with crowdbot.Session(scenario, sensors=["front_lidar"] if beams else []) as run:
        run.reset()
        return best(lambda: run.step((0.1, 0.0)), 1)


def irsim(people: int, beams: int) -> Rate | None:
    """IR-SIM with as many agents that avoid each other, without drawing."""
    if importlib.util.find_spec("irsim") is None:
        return None
    os.environ.setdefault("MPLBACKEND", "Agg")
    import irsim as peer

    lidar = (
        f"    sensors: [{{name: lidar2d, range_max: 10, number: {beams}, angle_range: 4.19}}]\n"
        if beams
        else ""
    )
    text = (
        "world: {height: 10, width: 50, step_time: 0.0625, sample_time: 0.0625,"
        " collision_mode: unobstructed}\n"
        "robot:\n  - kinematics: {name: diff}\n    shape: {name: circle, radius: 0.2}\n"
        f"    state: [2, 5, 0]\n    goal: [45, 5, 0]\n{lidar}"
        f"obstacle:\n  - number: {people}\n    distribution: {{name: random,"
        " range_low: [5, 0, -3.14], range_high: [45, 10, 3.14]}\n"
        "    kinematics: {name: omni}\n    behavior: {name: rvo, wander: True,"
        " range_low: [5, 0, 0], range_high: [45, 10, 0], vxmax: 1.3, vymax: 1.3}\n"
        "    shape: {name: circle, radius: 0.33}\n"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "world.yaml"
        path.write_text(text)
        env = peer.make(str(path), display=False, disable_all_plot=True, log_level="ERROR")
        return best(lambda: env.step(np.array([[0.1], [0.0]])), 1)


def navground(people: int, beams: int) -> Rate | None:
    """Navground with as many agents that avoid each other by ORCA, in compiled code."""
    if importlib.util.find_spec("navground") is None:
        return None
    sim: Any = importlib.import_module("navground.sim")

    lidar = f"      - {{type: Lidar, range: 10, resolution: {beams}}}\n" if beams else ""
    agent = (
        "    radius: 0.33\n    control_period: 0.0625\n"
        "    kinematics: {type: Omni, max_speed: 1.3}\n"
        "    behavior: {type: ORCA, optimal_speed: 1.0}\n"
        "    state_estimations:\n      - {type: Bounded, range: 5.0}\n"
    )
    text = (
        "type: Corridor\nwidth: 10\nlength: 40\nagent_margin: 0.05\ngroups:\n"
        f"  - type: person\n    number: {people}\n{agent}"
        f"  - type: robot\n    number: 1\n{agent}{lidar}"
    )
    world = sim.load_scenario(text).make_world(1)
    return best(lambda: world.update(0.0625), 1)


def growth() -> None:
    """Print how the cost of a step grows with people and worlds, on a floor that grows too."""
    print(f"{'people':>8}{'worlds':>8}{'per CPU s':>12}{'us per person':>15}")
    for people in (20, 40, 80, 160):
        for worlds in (16, 64, 128):
            own, _ = kernels(people, 0, worlds, 1, same_room=False)
            print(f"{people:8}{worlds:8}{own:12.0f}{1e6 / own / people:15.2f}", flush=True)


def resident() -> int:
    """Return the resident memory of this process, bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE")


def memory(steps: int, worlds: int) -> None:
    """Print how much memory the environment takes, at ten moments of many steps."""
    from crowdbot.rl import NavVectorEnv

    seen = {"kind": "lidar_stack", "sensor": "front_lidar", "sectors": 36}
    env = NavVectorEnv(
        worlds, suite=SUITE, scenario=SCENARIO, set=fields(20, 180), observation=seen,
        max_episode_steps=200,
    )  # fmt: skip
    env.reset(seed=1)
    rng = np.random.default_rng(1)
    marks = set(np.linspace(0, steps, 11).astype(int)[1:].tolist())
    done, episodes = 0, 0
    print(f"{'steps':>12}{'episodes':>10}{'MB':>8}")
    while done < steps:
        *_, ended, late, _ = env.step(rng.uniform(-1.0, 1.0, env.action_space.shape))
        episodes += int((ended | late).sum())
        reached = {mark for mark in marks if mark <= done + worlds}
        done, marks = done + worlds, marks - reached
        if reached:
            print(f"{done:12}{episodes:10}{resident() / 1e6:8.0f}", flush=True)


def main(arguments: list[str]) -> None:
    """Print a row for each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", default="20,100")
    parser.add_argument("--beams", default="0,180")
    parser.add_argument("--worlds", type=int, default=64)
    parser.add_argument("--threads", default="1")
    parser.add_argument("--peers", action="store_true", help="crowdbot.Session, IR-SIM, navground")
    parser.add_argument("--ceiling", action="store_true", help="as many processes as threads")
    parser.add_argument("--memory", type=int, metavar="STEPS", help="memory over many steps")
    parser.add_argument("--growth", action="store_true", help="cost by people and worlds")
    given = parser.parse_args(arguments)
    if given.growth:
        growth()
        return
    if given.memory:
        memory(given.memory, given.worlds)
        return
    print(f"{'':24}{'people':>8}{'beams':>7}{'threads':>9}{'per CPU s':>12}{'per s':>10}")
    for people in map(int, given.people.split(",")):
        for beams in map(int, given.beams.split(",")):
            for threads in map(int, given.threads.split(",")):
                size = people, beams, given.worlds, threads
                show("batch", people, beams, threads, kernels(*size))
                show("environment", people, beams, threads, environment(*size))
                if given.ceiling and threads > 1:
                    show("batch, processes", people, beams, threads, ceiling(*size))
            if given.peers:
                show("crowdbot.Session", people, beams, 1, session(people, beams))
                show("IR-SIM", people, beams, 1, irsim(people, beams))
                show("navground", people, beams, 1, navground(people, beams))


def show(name: str, people: int, beams: int, threads: int, found: Rate | None) -> None:
    """Print one row."""
    numbers = f"{found[0]:12.0f}{found[1]:10.0f}" if found else f"{'not installed':>22}"
    print(f"{name:24}{people:8}{beams:7}{threads:9}{numbers}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
